//! Isentropic flow through a duct whose area changes.

use ahv_core::Real;

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

/// What counts as sonic: there Newton's steps have no slope.
const LEAST: f64 = 1e-12;

/// Newton's steps from a start that is within 0.6 of ln M: to rounding.
const STEPS: usize = 5;

/// The logarithm of A/A* at a Mach number: NACA report 1135, (80).
pub fn log_area_ratio<R: Real>(gamma: R, mach: R) -> R {
    let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
    let stagnation = (R::ONE + down * mach * mach) / up;
    up / (gamma - R::ONE) * stagnation.ln() - mach.ln()
}

/// The supersonic stream of Mach number `mach` behind a duct that ends with `ratio` times the area that it starts with.
pub fn area_change<R: Real>(gamma: R, mach: R, ratio: R) -> AreaChange<R> {
    let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
    let exponent = up / (gamma - R::ONE);
    let wanted = log_area_ratio(gamma, mach) + ratio.ln();
    let aim = wanted.max(R::from_f64(LEAST));
    // u = ln M. Both starts are above the root, one nearer at M = 1 and one far from it, and the function is convex.
    let near = (up * aim).sqrt();
    let far = (aim - exponent * (down / up).ln()) / (R::TWO * exponent - R::ONE);
    let mut u = near.min(far);
    for _ in 0..STEPS {
        let mach_2 = (u + u).exp();
        let stagnation = R::ONE + down * mach_2;
        let error = exponent * (stagnation / up).ln() - u - aim;
        u = u - error * stagnation / (mach_2 - R::ONE);
    }
    let mach_2 = (u + u).exp();
    let temperature = (R::ONE + down * mach * mach) / (R::ONE + down * mach_2);
    AreaChange {
        mach: u.exp(),
        pressure: temperature.powr(gamma / (gamma - R::ONE)),
        temperature,
        margin: wanted,
    }
}
