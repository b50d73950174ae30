//! How long the next step is.

use ahv_core::{Model, Real, Vector};

use crate::{InputSource, Start};

/// The part of the step that the error estimate allows which is taken.
const SAFETY: f64 = 0.9;
/// Gustafsson's stabilisation: the weight of the error of the step before.
const BETA: f64 = 0.04;
/// A step becomes at most so many times as long,
const GROWTH: f64 = 5.0;
/// and after a refusal at least this part as long.
const SHRINK: f64 = 0.2;
/// After a step that is not finite.
const RETREAT: f64 = 0.1;
/// Smaller errors are taken for this one.
const LEAST_ERROR: f64 = 1e-4;

/// PI control of the step size (Gustafsson 1991), with the constants of Hairer, Nørsett and Wanner's DOPRI5.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller {
    exponent: f64,
    previous: f64,
    refused: bool,
}

impl Controller {
    /// A controller for an error that falls with this power of the step.
    pub(crate) fn new(error_order: u8) -> Self {
        Self {
            exponent: 1.0 / f64::from(error_order),
            previous: LEAST_ERROR,
            refused: false,
        }
    }

    /// What the step is multiplied with after an error of `norm` ≤ 1.
    pub(crate) fn accept(&mut self, norm: f64) -> f64 {
        let norm = norm.max(LEAST_ERROR * LEAST_ERROR);
        let proportional = power(norm, 0.75 * BETA - self.exponent);
        let factor = SAFETY * proportional * power(self.previous, BETA);
        // A step does not grow right after a refusal.
        let most = if self.refused { 1.0 } else { GROWTH };
        self.previous = norm.max(LEAST_ERROR);
        self.refused = false;
        factor.min(most)
    }

    /// What the step is multiplied with after an error of `norm` > 1, or one that is not finite.
    pub(crate) fn refuse(&mut self, norm: f64) -> f64 {
        self.refused = true;
        if norm.is_finite() {
            (SAFETY * power(norm, -self.exponent)).clamp(SHRINK, SAFETY)
        } else {
            RETREAT
        }
    }
}

/// What a component's error is measured in: `absolute` + `relative` times its greater value at the two ends.
#[inline]
pub(crate) fn units<R, X>(ends: [&X; 2], relative: f64, absolute: &X) -> X
where
    R: Real + Into<f64>,
    X: Vector<R>,
{
    let relative = R::from_f64(relative);
    let [first, last] = ends;
    first
        .zip_with(*last, |a, b| {
            let (a, b) = (a.abs(), b.abs());
            if a.into() > b.into() { a } else { b }
        })
        .zip_with(*absolute, |greater, absolute| absolute + relative * greater)
}

/// Root mean square of the error in `units`.
#[inline]
pub(crate) fn error_norm<R, X>(error: &X, units: &X) -> f64
where
    R: Real + Into<f64>,
    X: Vector<R>,
{
    let mut sum = 0.0;
    error.zip_with(*units, |error, unit| {
        let part: f64 = (error / unit).into();
        sum += part * part;
        error
    });
    Real::sqrt(sum / X::LEN as f64)
}

/// The component whose error in `units` is greatest, of equal ones the first.
#[cold]
pub(crate) fn farthest<R, X>(error: &X, units: &X) -> Option<usize>
where
    R: Real + Into<f64>,
    X: Vector<R>,
{
    let (mut worst, mut greatest) = (None, 0.0);
    for index in 0..X::LEN {
        let part = error.get(index).zip(units.get(index));
        let part: f64 = part.map_or(f64::NAN, |(error, unit)| (error / unit).abs().into());
        if worst.is_none() || part > greatest {
            (worst, greatest) = (Some(index), part);
        }
    }
    worst
}

/// A first step, by Hairer, Nørsett and Wanner's rule: an explicit Euler step shows how fast the slope changes.
pub(crate) fn first_step<M, I>(
    model: &M,
    input: &I,
    start: &Start<M::State>,
    slope: &M::State,
    relative: f64,
    absolute: &M::State,
    error_order: u8,
) -> f64
where
    M: Model,
    M::Scalar: Into<f64>,
    I: InputSource<M>,
{
    let x = start.state;
    let units = units::<M::Scalar, _>([&x, &x], relative, absolute);
    let norm = |v: &M::State| error_norm::<M::Scalar, _>(v, &units);
    let (size, speed) = (norm(&x), norm(slope));
    let quotient = 0.01 * size / speed;
    // A norm that overflows leaves no quotient.
    let guess = if size < 1e-5 || speed < 1e-5 || !quotient.is_normal() {
        1e-6
    } else {
        quotient
    };
    let h = M::Scalar::from_f64(guess);
    let euler = x.zip_with(*slope, |x, k| x + h * k);
    let time = start.time + guess;
    let later = model.drift(&euler, &input.at(start.time, time, &euler));
    let bend = norm(&later.zip_with(*slope, |a, b| a - b)) / guess;
    let steepest = speed.max(bend);
    // Nothing moves, or a norm overflows.
    if steepest <= 1e-15 || steepest.is_infinite() {
        return guess;
    }
    power(0.01 / steepest, 1.0 / f64::from(error_order)).min(100.0 * guess)
}

/// `x` to the power `exponent` for positive, normal `x`: to seven digits, which is more than a step size needs.
fn power(x: f64, exponent: f64) -> f64 {
    Real::exp(exponent * logarithm(x))
}

/// Natural logarithm of a positive, normal number to seven digits: `core` has none.
fn logarithm(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as f64 - 1023.0;
    let mantissa = f64::from_bits((bits & MANTISSA) | 1.0_f64.to_bits());
    // ln m = ln √2 + 2 artanh((m − √2)/(m + √2)), where the argument is below 0.172.
    let s = (mantissa - core::f64::consts::SQRT_2) / (mantissa + core::f64::consts::SQRT_2);
    let s_2 = s * s;
    let artanh = s * (1.0 + s_2 * (1.0 / 3.0 + s_2 * (0.2 + s_2 / 7.0)));
    core::f64::consts::LN_2 * (exponent + 0.5) + 2.0 * artanh
}

#[cfg(test)]
mod tests;
