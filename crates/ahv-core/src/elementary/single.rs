//! Sine, cosine and exponential of single precision.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_4, LOG2_E};

use super::tangent;
use crate::Lane;

/// (sin x − x)/x³ as a polynomial in x² for |x| ≤ π/4; relative error of sin x 2⁻²⁷.
const SIN: [f32; 3] = [-0.166_666_55, 0.008_332_101, -0.000_195_039_29];

/// (cos x − 1 + x²/2)/x⁴ as a polynomial in x² for |x| ≤ π/4; relative error of cos x 2⁻³¹.
const COS: [f32; 3] = [0.041_666_653, -0.001_388_765_4, 2.446_380_3e-5];

/// (eʳ − 1 − r)/r² as a polynomial in r for |r| ≤ ln 2/2; relative error of eʳ 2⁻²⁸.
const EXP: [f32; 5] = [
    0.499_999_94,
    0.166_665_21,
    0.041_668_39,
    0.008_368_717,
    0.001_381_460_1,
];

/// π/2 in doubles, the first of 33 bits, so that a whole multiple of it is exact.
const HALF_PI: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];

/// ln 2 in parts of 12 bits and the rest.
const LN_2: [f32; 2] = [0.693_115_23, 3.194_618_3e-5];

/// Adding 1.5·2²³ rounds to a whole number and leaves it in the low bits.
const ROUNDER: f32 = 12_582_912.0;

/// Larger angles take `libm`'s reduction.
const LARGEST_ANGLE: f32 = 1e4;

/// Larger exponents leave the normal numbers and take `libm`'s path.
const LARGEST_EXPONENT: f32 = 87.0;

impl Lane for f32 {
    const NAN: Self = f32::NAN;

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

    /// The reduction is one of doubles.
    #[inline(always)]
    fn moderate_sin_cos(self) -> (Self, Self) {
        let shifted = self * FRAC_2_PI + ROUNDER;
        let turns = f64::from(shifted - ROUNDER);
        let exact = (f64::from(self) - turns * HALF_PI[0]) - turns * HALF_PI[1];
        let rest = exact as f32;
        let low = (exact - f64::from(rest)) as f32;
        let (sin, cos) = kernel(rest, low);
        // A quarter turn swaps the two and turns the sign of the new cosine; a half turn turns both signs.
        let quarter = shifted.to_bits();
        let swapped = (quarter & 1).wrapping_neg();
        let (s, c) = (sin.to_bits(), cos.to_bits());
        let exchange = (s ^ c) & swapped;
        let sign_sin = (quarter & 2) << 30;
        let sign_cos = (quarter.wrapping_add(1) & 2) << 30;
        (
            f32::from_bits((s ^ exchange) ^ sign_sin),
            f32::from_bits((c ^ exchange) ^ sign_cos),
        )
    }

    #[inline(always)]
    fn is_moderate_exponent(self) -> bool {
        self.abs() <= LARGEST_EXPONENT
    }

    #[inline(always)]
    fn moderate_exp(self) -> Self {
        let shifted = self * LOG2_E + ROUNDER;
        let doublings = shifted - ROUNDER;
        let high = self - doublings * LN_2[0];
        let step = doublings * LN_2[1];
        let r = high - step;
        let low = (high - r) - step;
        let r_2 = r * r;
        let c = &EXP;
        let p = (c[0] + c[1] * r) + r_2 * ((c[2] + c[3] * r) + r_2 * c[4]);
        let fraction = 1.0 + (r + (low + r_2 * p));
        // The low bits hold the exponent; those above them fall off.
        fraction * f32::from_bits(shifted.to_bits().wrapping_add(127) << 23)
    }

    #[inline(always)]
    fn moderate_tan(self) -> Self {
        tangent::moderate_tan(f64::from(self)) as f32
    }
}

/// Sine and cosine of an angle in rad; the sine of −0 is +0.
#[inline]
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    if x.is_small_angle() {
        x.small_sin_cos()
    } else if x.is_moderate_angle() {
        x.moderate_sin_cos()
    } else {
        libm::sincosf(x)
    }
}

/// e to the power x.
#[inline]
pub(crate) fn exp(x: f32) -> f32 {
    if x.is_moderate_exponent() {
        x.moderate_exp()
    } else {
        libm::expf(x)
    }
}

/// Sine and cosine of x + low for |x| ≤ π/4 and a low far smaller than x.
#[inline(always)]
fn kernel(x: f32, low: f32) -> (f32, f32) {
    let x_2 = x * x;
    let sin = SIN[0] + x_2 * (SIN[1] + x_2 * SIN[2]);
    let cos = COS[0] + x_2 * (COS[1] + x_2 * COS[2]);
    // What 1 − x²/2 loses by rounding joins the small terms.
    let half = 0.5 * x_2;
    let main = 1.0 - half;
    (
        x + ((x * x_2) * sin + low),
        main + (((1.0 - main) - half) + ((x_2 * x_2) * cos - x * low)),
    )
}
