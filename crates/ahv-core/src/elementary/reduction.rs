//! What sines, tangents and exponentials of doubles share: the reductions of their arguments, and their polynomials.

use core::f64::consts::{FRAC_2_PI, LOG2_E};

/// (sin x − x)/x³ as a polynomial in x² for |x| ≤ π/4; relative error of sin x 2⁻⁵⁷.
pub(super) const SIN: [f64; 6] = [
    -0.16666666666666644,
    0.008333333333324425,
    -0.00019841269831056066,
    2.755731404725958e-06,
    -2.505080550019054e-08,
    1.5899196851420854e-10,
];

/// (cos x − 1 + x²/2)/x⁴ as a polynomial in x² for |x| ≤ π/4; relative error of cos x 2⁻⁶³.
pub(super) const COS: [f64; 6] = [
    0.04166666666666665,
    -0.0013888888888881452,
    2.480158729341395e-05,
    -2.7557315352291386e-07,
    2.0875845106254155e-09,
    -1.1365380407353296e-11,
];

/// π/2 in parts of 33 bits and the rest, so that a whole multiple of a part below 2²⁰ is exact.
const HALF_PI: [f64; 4] = [
    1.5707963267341256,
    6.077100506303966e-11,
    2.0222662487111665e-21,
    8.4784276603689e-32,
];

/// ln 2 in parts of 33 bits and the rest.
pub(super) const LN_2: [f64; 2] = [0.6931471804855391, 7.440617110012397e-11];

/// Adding 1.5·2⁵² rounds to a whole number and leaves it in the low bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// A moderate angle less a number of quarter turns, as a sum of two doubles, and that number in the low bits.
#[inline(always)]
pub(super) fn reduced(x: f64) -> (f64, f64, u64) {
    let shifted = x * FRAC_2_PI + ROUNDER;
    let turns = shifted - ROUNDER;
    let coarse = x - turns * HALF_PI[0];
    let step = turns * HALF_PI[1];
    let middle = coarse - step;
    let low_step = turns * HALF_PI[2];
    // Next to a multiple of π/2 both differences are exact, else what they lose joins the small terms.
    let high = middle - low_step;
    let lost = ((coarse - middle) - step) + ((middle - high) - low_step);
    let low = lost - turns * HALF_PI[3];
    let rest = high + low;
    (rest, (high - rest) + low, shifted.to_bits())
}

/// A polynomial of six coefficients by Estrin's scheme: three short chains instead of a long one.
#[inline(always)]
pub(super) fn cubic_pairs(c: &[f64; 6], z: f64, z_2: f64) -> f64 {
    (c[0] + c[1] * z) + z_2 * ((c[2] + c[3] * z) + z_2 * (c[4] + c[5] * z))
}

/// A moderate exponent less a number of ln 2, as a sum of two doubles, and that number in the low bits.
#[inline(always)]
pub(super) fn reduced_exponent(x: f64) -> (f64, f64, u64) {
    let shifted = x * LOG2_E + ROUNDER;
    let doublings = shifted - ROUNDER;
    let high = x - doublings * LN_2[0];
    let step = doublings * LN_2[1];
    let r = high - step;
    (r, (high - r) - step, shifted.to_bits())
}

/// 2 to the power of what the low bits hold; those above them fall off.
#[inline(always)]
pub(super) fn power_of_two(doublings: u64) -> f64 {
    f64::from_bits(doublings.wrapping_add(1023) << 52)
}
