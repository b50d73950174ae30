//! Sine, cosine, tangent and exponential of doubles.

use core::f64::consts::FRAC_PI_4;

use super::reduction::{COS, SIN, cubic_pairs, power_of_two, reduced, reduced_exponent};
use super::{pair::Pair, tangent};
use crate::Lane;

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
