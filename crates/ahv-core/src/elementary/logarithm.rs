//! The natural logarithm and real powers of doubles.

use core::f64::consts::SQRT_2;

use super::double::exp_of_sum;
use super::pair::Pair;
use super::reduction::LN_2;

/// (artanh s − s − s³/3 − s⁵/5)/s⁷ as a polynomial in s² for |s| ≤ (√2 − 1)/(√2 + 1); relative error of artanh s 2⁻⁶⁹.
const ARTANH: [f64; 7] = [
    0.14285714285714476,
    0.11111111110907367,
    0.09090909156695835,
    0.07692298149609836,
    0.06667385264202787,
    0.058532070065899694,
    0.058634603904658064,
];

/// 1/3 and 1/5 as pairs.
const THIRD: Pair = Pair {
    high: 0.3333333333333333,
    low: 1.850371707708594e-17,
};
const FIFTH: Pair = Pair {
    high: 0.19999999999999998,
    low: 1.6653345369377347e-17,
};

/// 2⁵⁴ makes a normal number of every subnormal one.
const GROW: f64 = 18_014_398_509_481_984.0;

/// The bits of 2⁵², whose last ones count units.
const COUNTER: u64 = 0x4330_0000_0000_0000;
const COUNTED: f64 = 4_503_599_627_370_496.0;

/// Larger exponents give 0 or infinity.
const LARGEST_EXPONENT: f64 = 1000.0;

/// The logarithm to about 2⁻⁶⁷ of itself.
#[inline(always)]
fn logarithm(x: f64) -> Pair {
    let is_subnormal = x < f64::MIN_POSITIVE;
    let (grown, lacking) = if is_subnormal {
        (x * GROW, 1077.0)
    } else {
        (x, 1023.0)
    };
    let bits = grown.to_bits();
    let exponent = f64::from_bits(COUNTER | ((bits >> 52) & 0x7ff)) - COUNTED - lacking;
    let mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 1.0_f64.to_bits());
    let (mantissa, doublings) = if mantissa > SQRT_2 {
        (0.5 * mantissa, exponent + 1.0)
    } else {
        (mantissa, exponent)
    };
    // ln m = 2 artanh((m − 1)/(m + 1))
    let s = Pair::exact(mantissa - 1.0).over(Pair::sum(mantissa, 1.0));
    let square = s.times(s);
    let tail = FIFTH.plus(Pair::exact(square.high * polynomial(square.high)));
    let series = square.times(THIRD.plus(square.times(tail)));
    let half = s.plus(s.times(series));
    let of_mantissa = Pair {
        high: 2.0 * half.high,
        low: 2.0 * half.low,
    };
    let of_doublings = Pair {
        high: doublings * LN_2[0],
        low: doublings * LN_2[1],
    };
    let found = of_doublings.plus(of_mantissa);
    let outside = if x == f64::INFINITY { x } else { f64::NAN };
    let edge = if x == 0.0 { f64::NEG_INFINITY } else { outside };
    if x > 0.0 && x < f64::INFINITY {
        found
    } else {
        Pair::exact(edge)
    }
}

/// The polynomial of [`ARTANH`] by Estrin's scheme.
#[inline(always)]
fn polynomial(z: f64) -> f64 {
    let (c, z_2) = (&ARTANH, z * z);
    let last = (c[4] + c[5] * z) + z_2 * c[6];
    ((c[0] + c[1] * z) + z_2 * (c[2] + c[3] * z)) + (z_2 * z_2) * last
}

/// The natural logarithm.
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    logarithm(x).rounded()
}

/// x to the real power y: e to the power y ln x.
#[inline(always)]
pub(crate) fn powr(x: f64, y: f64) -> f64 {
    let logarithm = logarithm(x);
    let high = y * logarithm.high;
    let product = Pair::product(y, logarithm.high);
    // Beyond an exponent of 10³⁰⁰ only the logarithm 0 gives a moderate product, and the low parts are no numbers.
    let is_moderate = (high.abs() < LARGEST_EXPONENT) & (y.abs() < 1e300);
    let low = product.low + y * logarithm.low;
    exp_of_sum(high, if is_moderate { low } else { 0.0 })
}
