//! The tangent and the hyperbolic tangent of doubles.

use super::pair::Pair;
use super::reduction::{COS, SIN, cubic_pairs, power_of_two, reduced, reduced_exponent};

/// 2⁻³⁰: a smaller angle is its own tangent.
const TINY: f64 = 9.313225746154785e-10;

/// Above, the hyperbolic tangent is 1.
const LARGEST: f64 = 20.0;

/// The tangent of a moderate angle in rad.
#[inline(always)]
pub(crate) fn moderate_tan(x: f64) -> f64 {
    let (rest, low, quarters) = reduced(x);
    let (sin, cos) = kernel(rest, low);
    // A quarter turn makes of the tangent the inverse one, with the other sign.
    let (above, below) = if quarters & 1 == 1 {
        (cos.negative(), sin)
    } else {
        (sin, cos)
    };
    let found = above.over(below).rounded();
    if x.abs() < TINY { x } else { found }
}

/// Sine and cosine of x + low for |x| ≤ π/4 and a low far smaller than x, to about 2⁻⁵⁶ of themselves.
#[inline(always)]
fn kernel(x: f64, low: f64) -> (Pair, Pair) {
    let square = Pair::product(x, x);
    let x_2 = square.high;
    let x_4 = x_2 * x_2;
    let half = 0.5 * x_2;
    let sin = (x * x_2) * cubic_pairs(&SIN, x_2, x_4) + (low - low * half);
    let main = Pair::ordered_sum(1.0, -half);
    let cos = main.low + (x_4 * cubic_pairs(&COS, x_2, x_4) - (x * low + 0.5 * square.low));
    (Pair::ordered_sum(x, sin), Pair::ordered_sum(main.high, cos))
}

/// (eʳ − 1 − r − r²/2)/r³ as a polynomial in r for |r| ≤ ln 2/2; relative error of eʳ − 1 2⁻⁶⁰.
const EXP_LESS_ONE: [f64; 10] = [
    0.16666666666666677,
    0.04166666666666669,
    0.008333333333321695,
    0.0013888888888870217,
    0.00019841269885985402,
    2.4801587355967003e-05,
    2.755724433650261e-06,
    2.7557245702065875e-07,
    2.510899601613109e-08,
    2.0923721907815714e-09,
];

/// The hyperbolic tangent: (e²ˣ − 1)/(e²ˣ + 1).
#[inline(always)]
pub(crate) fn tanh(x: f64) -> f64 {
    let size = x.abs();
    let moderate = if size > LARGEST { LARGEST } else { size };
    let less_one = exp_less_one(2.0 * moderate);
    let found = less_one.over(less_one.plus(Pair::exact(2.0))).rounded();
    let found = if size < TINY { size } else { found };
    found.copysign(x)
}

/// eˣ − 1 for 0 ≤ x ≤ 40.
#[inline(always)]
fn exp_less_one(x: f64) -> Pair {
    let (r, low, doublings) = reduced_exponent(x);
    let square = Pair::product(r, r);
    let (c, r_2) = (&EXP_LESS_ONE, square.high);
    let r_4 = r_2 * r_2;
    let p = ((c[0] + c[1] * r) + r_2 * (c[2] + c[3] * r))
        + r_4 * (((c[4] + c[5] * r) + r_2 * (c[6] + c[7] * r)) + r_4 * (c[8] + c[9] * r));
    let half = Pair::ordered_sum(r, 0.5 * r_2);
    let rest = half.low + (0.5 * square.low + ((r * r_2) * p + (low + low * r)));
    let near_one = Pair::ordered_sum(half.high, rest);
    let scale = power_of_two(doublings);
    let scaled = Pair {
        high: scale * near_one.high,
        low: scale * near_one.low,
    };
    Pair::exact(scale - 1.0).plus(scaled)
}
