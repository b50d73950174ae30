//! Sine, cosine and exponential of doubles, and the reductions of their arguments.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_4, LOG2_E};

use super::{pair::Pair, tangent};
use crate::Lane;

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

/// (eʳ − 1 − r)/r² as a polynomial in r for |r| ≤ ln 2/2; relative error of eʳ 2⁻⁵⁶.
const EXP: [f64; 10] = [
    0.5000000000000011,
    0.16666666666666413,
    0.041666666666530155,
    0.008333333333494465,
    0.0013888888943630188,
    0.00019841269506571267,
    2.4801493098816138e-05,
    2.75575863808365e-06,
    2.763024841408471e-07,
    2.500005928835836e-08,
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

/// Larger angles take `libm`'s reduction.
const LARGEST_ANGLE: f64 = 1e6;

/// Larger exponents leave the normal numbers and take `libm`'s path.
const LARGEST_EXPONENT: f64 = 708.0;

/// The exponential of larger exponents is infinite or 0.
const BEYOND: f64 = 800.0;

impl Lane for f64 {
    const NAN: Self = f64::NAN;

    #[inline(always)]
    fn is_small_angle(self) -> bool {
        self.abs() <= FRAC_PI_4
    }

    #[inline(always)]
    fn small_sin_cos(self) -> (Self, Self) {
        kernel(self, 0.0)
    }

    #[inline(always)]
    fn is_moderate_angle(self) -> bool {
        self.abs() <= LARGEST_ANGLE
    }

    #[inline(always)]
    fn moderate_sin_cos(self) -> (Self, Self) {
        reduced_sin_cos(self)
    }

    #[inline(always)]
    fn is_moderate_exponent(self) -> bool {
        self.abs() <= LARGEST_EXPONENT
    }

    #[inline(always)]
    fn moderate_exp(self) -> Self {
        normal_exp(self)
    }

    #[inline(always)]
    fn moderate_tan(self) -> Self {
        tangent::moderate_tan(self)
    }
}

/// Sine and cosine of an angle in rad; the sine of −0 is +0.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= FRAC_PI_4 {
        return kernel(x, 0.0);
    }
    // NaN and infinity end in `libm` too.
    if x.is_moderate_angle() {
        reduced_sin_cos(x)
    } else {
        libm::sincos(x)
    }
}

/// Sine and cosine of a moderate angle; for one below π/4 the bits of `kernel` without reduction.
#[inline(always)]
fn reduced_sin_cos(x: f64) -> (f64, f64) {
    let (rest, low, quarter) = reduced(x);
    let (sin, cos) = kernel(rest, low);
    // A quarter turn swaps the two and turns the sign of the new cosine; a half turn turns both signs.
    let swapped = (quarter & 1).wrapping_neg();
    let (s, c) = (sin.to_bits(), cos.to_bits());
    let exchange = (s ^ c) & swapped;
    let sign_sin = (quarter & 2) << 62;
    let sign_cos = (quarter.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits((s ^ exchange) ^ sign_sin),
        f64::from_bits((c ^ exchange) ^ sign_cos),
    )
}

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

/// Sine and cosine of x + low for |x| ≤ π/4 and a low far smaller than x.
#[inline(always)]
fn kernel(x: f64, low: f64) -> (f64, f64) {
    let x_2 = x * x;
    let x_4 = x_2 * x_2;
    let sin = cubic_pairs(&SIN, x_2, x_4);
    let cos = cubic_pairs(&COS, x_2, x_4);
    // What 1 − x²/2 loses by rounding joins the small terms.
    let half = 0.5 * x_2;
    let main = 1.0 - half;
    (
        x + ((x * x_2) * sin + low),
        main + (((1.0 - main) - half) + (x_4 * cos - x * low)),
    )
}

/// A polynomial of six coefficients by Estrin's scheme: three short chains instead of a long one.
#[inline(always)]
pub(super) fn cubic_pairs(c: &[f64; 6], z: f64, z_2: f64) -> f64 {
    (c[0] + c[1] * z) + z_2 * ((c[2] + c[3] * z) + z_2 * (c[4] + c[5] * z))
}

/// Tangent of an angle in rad.
#[inline]
pub(crate) fn tan(x: f64) -> f64 {
    if x.is_moderate_angle() {
        return x.moderate_tan();
    }
    let (sin, cos) = libm::sincos(x);
    sin / cos
}

/// e to the power x.
#[inline]
pub(crate) fn exp(x: f64) -> f64 {
    // NaN compares false and takes the other way.
    if x.is_moderate_exponent() {
        return normal_exp(x);
    }
    libm::exp(x)
}

#[inline(always)]
fn normal_exp(x: f64) -> f64 {
    let (r, low, doublings) = reduced_exponent(x);
    let fraction = 1.0 + (r + (low + exp_tail(r)));
    fraction * power_of_two(doublings)
}

/// e to the power high + low, also where it leaves the normal numbers; what 1 + r loses by rounding joins the small terms.
#[inline(always)]
pub(super) fn exp_of_sum(high: f64, low: f64) -> f64 {
    let below = if high > BEYOND { BEYOND } else { high };
    let moderate = if below < -BEYOND { -BEYOND } else { below };
    let (r, lost, doublings) = reduced_exponent(moderate);
    // The low part may be as large as the last bit of `high`.
    let rest = Pair::ordered_sum(r, lost + low);
    let main = Pair::ordered_sum(1.0, rest.high);
    let fraction = main.high + (main.low + (exp_tail(rest.high) + rest.low));
    // In two steps, of which only the second can round.
    let half = ((doublings.wrapping_add(2048) & 0xfff) >> 1).wrapping_sub(1024);
    (fraction * power_of_two(half)) * power_of_two(doublings.wrapping_sub(half))
}

/// eʳ − 1 − r
#[inline(always)]
fn exp_tail(r: f64) -> f64 {
    let (r_2, c) = (r * r, &EXP);
    let r_4 = r_2 * r_2;
    let p = ((c[0] + c[1] * r) + r_2 * (c[2] + c[3] * r))
        + r_4 * (((c[4] + c[5] * r) + r_2 * (c[6] + c[7] * r)) + r_4 * (c[8] + c[9] * r));
    r_2 * p
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
