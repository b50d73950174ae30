//! Heat that is added to a supersonic stream in a duct of constant area without friction: Rayleigh's line.

use ahv_core::Real;

/// What heat makes of a stream; ratios are behind over ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatAddition<R> {
    /// Mach number behind.
    pub mach: R,
    /// Ratio of the static pressures.
    pub pressure: R,
    /// Ratio of the static temperatures.
    pub temperature: R,
    /// Below 0 the stream is choked, or has less heat than is taken from it, and the rest means nothing; 0 is sonic.
    pub margin: R,
}

/// Heat that multiplies the total temperature of a stream of Mach number `mach` > 1 by `total_temperature`.
///
/// With s = (M² − 1)/(1 + γM²) the total temperature is 1 − s² of that of the sonic state, so that s behind follows in closed form, and
/// M² = (1 + s)/(1 − γs).
pub fn heat_addition<R: Real>(gamma: R, mach: R, total_temperature: R) -> HeatAddition<R> {
    let mach_2 = mach * mach;
    let ahead = (mach_2 - R::ONE) / (R::ONE + gamma * mach_2);
    let margin = R::ONE - total_temperature * (R::ONE - ahead * ahead);
    let behind = margin.max(R::ZERO).sqrt();
    let behind_2 = (R::ONE + behind) / (R::ONE - gamma * behind);
    let pressure = (R::ONE + gamma * mach_2) / (R::ONE + gamma * behind_2);
    HeatAddition {
        mach: behind_2.sqrt(),
        pressure,
        temperature: pressure * pressure * behind_2 / mach_2,
        margin: margin.min(R::ONE - gamma * behind),
    }
}

/// The ratio of total temperatures that chokes a stream of Mach number `mach`.
pub fn choking_ratio<R: Real>(gamma: R, mach: R) -> R {
    let mach_2 = mach * mach;
    let s = (mach_2 - R::ONE) / (R::ONE + gamma * mach_2);
    (R::ONE - s * s).recip()
}
