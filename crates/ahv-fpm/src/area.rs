//! Isentropic flow through a duct whose area changes.

use ahv_core::Real;

use crate::surfaces::none_below;

/// A supersonic stream at the other end of a duct; ratios are that end over this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaChange<R> {
    /// Mach number there.
    pub mach: R,
    /// Ratio of the static pressures.
    pub pressure: R,
    /// Ratio of the static temperatures.
    pub temperature: R,
    /// Below 0 the duct is too narrow for the stream, and the rest means nothing; 0 is sonic.
    pub margin: R,
}

/// What counts as sonic: there a step has no slope.
const LEAST: f64 = 1e-12;

/// Halley's steps at most, from a start that is within 0.6 of ln M: to rounding.
const STEPS: usize = 3;

/// A step below this is the last: the error that it leaves is of the order of its cube.
const LAST_STEP: f64 = 1e-7;

/// The logarithm of A/A* at a Mach number: NACA report 1135, (80).
pub fn log_area_ratio<R: Real>(gamma: R, mach: R) -> R {
    let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
    let stagnation = (R::ONE + down * mach * mach) / up;
    up / (gamma - R::ONE) * stagnation.ln() - mach.ln()
}

/// A duct; what depends on its shape alone is computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Duct<R> {
    gamma: R,
    ratio: R,
    log_ratio: R,
    /// What a start far from Mach 1 adds to the logarithm of A/A*.
    far: R,
}

impl<R: Real> Duct<R> {
    /// The duct that ends with `ratio` times the area that it starts with.
    pub fn new(gamma: R, ratio: R) -> Self {
        let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
        Self {
            gamma,
            ratio,
            log_ratio: ratio.ln(),
            far: up / (gamma - R::ONE) * (up / down).ln(),
        }
    }

    /// The supersonic stream of Mach number `mach` at its end.
    pub fn change(&self, mach: R) -> AreaChange<R> {
        let gamma = self.gamma;
        let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
        let exponent = up / (gamma - R::ONE);
        let wanted = log_area_ratio(gamma, mach) + self.log_ratio;
        let sonic = R::from_f64(LEAST);
        let ahead = R::ONE + down * mach * mach;
        let aim = wanted.max(sonic);
        // u = ln M. One start is near at M = 1 and one far from it; both are above the root.
        let near = (up * aim).sqrt();
        let far = (aim + self.far) / (R::TWO * exponent - R::ONE);
        // A third is along the tangent at this end of the duct, which lies above the curve where the duct widens.
        let rise = (mach * mach - R::ONE).max(sonic) / ahead;
        let along = mach.ln() + self.log_ratio / rise;
        let along = self.log_ratio.select(R::ZERO, near, along);
        let mut u = near.min(far).min(along);
        for _ in 0..STEPS {
            let mach_2 = (u + u).exp();
            let stagnation = R::ONE + down * mach_2;
            let error = exponent * (stagnation / up).ln() - u - aim;
            let step = error * stagnation / (mach_2 - R::ONE);
            // Half the second derivative over the first.
            let bend = mach_2 * up / (stagnation * (mach_2 - R::ONE));
            u = u - step / (R::ONE - step * bend);
            if is_below(step, LAST_STEP) {
                break;
            }
        }
        let end = u.exp();
        let temperature = ahead / (R::ONE + down * end * end);
        AreaChange {
            mach: end,
            // The mass that enters leaves.
            pressure: mach / (self.ratio * end) * temperature.sqrt(),
            temperature,
            margin: wanted,
        }
    }
}

/// Whether the magnitudes of all lanes are below a bound.
pub(crate) fn is_below<R: Real>(value: R, bound: f64) -> bool {
    let bound = R::from_f64(bound);
    none_below(bound - value) && none_below(bound + value)
}

impl<R> Duct<R> {
    pub(crate) fn map_ref<U>(&self, f: &mut impl FnMut(&R) -> U) -> Duct<U> {
        Duct {
            gamma: f(&self.gamma),
            ratio: f(&self.ratio),
            log_ratio: f(&self.log_ratio),
            far: f(&self.far),
        }
    }
}
