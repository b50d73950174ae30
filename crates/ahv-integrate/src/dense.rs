//! The state between the ends of a step.

use core::array::from_fn;

use ahv_core::{Real, Vector};

/// Most coefficients of a polynomial: of degree 7.
const MOST_COEFFICIENTS: usize = 8;

/// The state over one step as a polynomial in time, of degree 7 at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dense<X> {
    start: f64,
    step: f64,
    end: f64,
    /// The first `count` are the polynomial's.
    coefficients: [X; MOST_COEFFICIENTS],
    count: usize,
}

impl<X: Copy> Dense<X> {
    /// The polynomial Σ `coefficients[i]` θⁱ with θ = (time − `start`)/`step`; 1 to 8 coefficients, or it does not compile.
    #[inline]
    pub fn new<const N: usize>(start: f64, step: f64, coefficients: [X; N]) -> Self {
        const { assert!(N > 0 && N <= MOST_COEFFICIENTS, "1 to 8 coefficients") };
        let mut places = coefficients.into_iter();
        let last = coefficients[N - 1];
        Self {
            start,
            step,
            end: start + step,
            coefficients: from_fn(|_| places.next().unwrap_or(last)),
            count: N,
        }
    }
}

impl<X> Dense<X> {
    /// Where the step begins, in s.
    pub const fn start(&self) -> f64 {
        self.start
    }

    /// Where the step ends, in s; an event that ends the run also ends its step.
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// The same polynomial, good up to `end`.
    #[must_use]
    pub(crate) fn until(mut self, end: f64) -> Self {
        self.end = end;
        self
    }

    /// The state at `time`, in s; outside the step it is an extrapolation.
    #[inline]
    pub fn at<R: Real>(&self, time: f64) -> X
    where
        X: Vector<R>,
    {
        let part = R::from_f64((time - self.start) / self.step);
        self.coefficients
            .iter()
            .take(self.count)
            .rev()
            .fold(X::splat(R::ZERO), |sum, &coefficient| {
                coefficient.zip_with(sum, |c, s| c + part * s)
            })
    }
}

/// Σ `weights[i]` `slopes[i]`; a weight of 0 costs nothing.
#[inline]
pub(crate) fn weighted<R: Real, X: Vector<R>>(weights: &[f64], slopes: &[X]) -> X {
    weights
        .iter()
        .zip(slopes)
        .filter(|&(&weight, _)| weight != 0.0)
        .fold(X::splat(R::ZERO), |sum, (&weight, &slope)| {
            let weight = R::from_f64(weight);
            sum.zip_with(slope, |s, k| s + weight * k)
        })
}

/// `x` + `scale` `slope`.
#[inline]
pub(crate) fn add_scaled<R: Real, X: Vector<R>>(x: X, scale: R, slope: X) -> X {
    x.zip_with(slope, |x, k| x + scale * k)
}
