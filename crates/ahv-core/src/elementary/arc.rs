//! Inverse tangents and the inverse sine of doubles.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::pair::Pair;
use crate::Real;

/// (atan t − t)/t³ as a polynomial in t² for |t| ≤ tan(π/8); relative error of atan t 2⁻⁵⁹.
const ARC: [f64; 11] = [
    -0.3333333333333327,
    0.19999999999969428,
    -0.14285714281496567,
    0.1111111083893405,
    -0.09090899160250497,
    0.07692082604182458,
    -0.0666333588676279,
    0.05849443556842783,
    -0.05045815083558404,
    0.03821944304783067,
    -0.01806697503803219,
];

/// tan(π/8) and tan(3π/8): between them the angle is counted from π/4.
const MIDDLE: [f64; 2] = [0.41421356237309503, 2.414213562373095];

/// What π/4 exceeds its double by; of π/2, 3π/4 and π it is as many times this.
const REST_OF_QUARTER_PI: f64 = 3.061616997868383e-17;

/// 3π/4.
const THREE_QUARTERS_PI: f64 = 2.356194490192345;

/// 2⁻²⁵⁰: a smaller tangent is its own angle, and its quotient needs no correction.
const TINY: f64 = 5.527147875260445e-76;

/// Tangents above 2⁶⁰ have the angle π/2.
const LARGEST_TANGENT: f64 = 1_152_921_504_606_846_976.0;

/// The angle of the point (x, y) of the first quadrant in rad; if `is_mirrored` that of (−x, y).
#[inline(always)]
fn angle(y: f64, x: Pair, is_mirrored: bool) -> f64 {
    let is_middle = y > MIDDLE[0] * x.high;
    let is_steep = y > MIDDLE[1] * x.high;
    let upright = Pair::exact(y);
    let (above, below) = if is_steep {
        (x.negative(), upright)
    } else if is_middle {
        (upright.plus(x.negative()), upright.plus(x))
    } else {
        (upright, x)
    };
    let (mut from, mut quarters) = (0.0, 0.0);
    if is_middle {
        (from, quarters) = (FRAC_PI_4, 1.0);
    }
    if is_steep {
        (from, quarters) = (FRAC_PI_2, 2.0);
    }
    if is_mirrored {
        let mirrored = if is_middle { THREE_QUARTERS_PI } else { PI };
        from = if is_steep { FRAC_PI_2 } else { mirrored };
        quarters = 4.0 - quarters;
    }
    let sign = if is_mirrored { -1.0 } else { 1.0 };
    let quotient = above.over(below);
    let t = quotient.high;
    let correction = if t.abs() > TINY { quotient.low } else { 0.0 };
    let z = t * t;
    let rest = (t * z) * polynomial(z) + (correction - correction * z);
    let main = Pair::ordered_sum(from, sign * t);
    main.high + (main.low + (quarters * REST_OF_QUARTER_PI + sign * rest))
}

/// The polynomial of [`ARC`] by Estrin's scheme.
#[inline(always)]
fn polynomial(z: f64) -> f64 {
    let (c, z_2) = (&ARC, z * z);
    let z_4 = z_2 * z_2;
    let first = (c[0] + c[1] * z) + z_2 * (c[2] + c[3] * z);
    let second = (c[4] + c[5] * z) + z_2 * (c[6] + c[7] * z);
    let third = (c[8] + c[9] * z) + z_2 * c[10];
    first + z_4 * (second + z_4 * third)
}

/// The angle in [−π/2, π/2] whose tangent is x.
#[inline(always)]
pub(crate) fn atan(x: f64) -> f64 {
    let size = x.abs();
    let size = if size > LARGEST_TANGENT {
        LARGEST_TANGENT
    } else {
        size
    };
    angle(size, Pair::exact(1.0), false).copysign(x)
}

/// The angle in [−π, π] of the point (x, y), with the signs of zeros as IEEE 754 has them.
#[inline(always)]
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    let (size_y, size_x) = (y.abs(), x.abs());
    let larger = if size_y > size_x { size_y } else { size_x };
    // No sum of the two overflows, no correction of a quotient underflows; a number that is lost here is far below the other.
    let scale = if larger > LARGE {
        SHRINK
    } else if larger < SMALL {
        GROW
    } else {
        1.0
    };
    let are_infinite = size_y == f64::INFINITY && size_x == f64::INFINITY;
    let scaled = |size: f64| if are_infinite { 1.0 } else { size * scale };
    let distance = if larger == 0.0 { 1.0 } else { scaled(size_x) };
    angle(scaled(size_y), Pair::exact(distance), x.is_sign_negative()).copysign(y)
}

/// 2⁹⁰⁰, 2⁻⁶⁰, 2⁻⁷⁰⁰ and 2²⁵⁰.
const LARGE: f64 = 8.452712498170644e270;
const SHRINK: f64 = 8.673617379884035e-19;
const SMALL: f64 = 1.90109156629516e-211;
const GROW: f64 = 1.8092513943330656e75;

/// The angle in [−π/2, π/2] whose sine is x: that of the point (√(1 − x²), x).
#[inline(always)]
pub(crate) fn asin(x: f64) -> f64 {
    let square = Pair::product(x, x);
    let rest = Pair::ordered_sum(1.0, -square.high);
    let rest = Pair::ordered_sum(rest.high, rest.low - square.low);
    let root = Real::sqrt(rest.high);
    let back = Pair::product(root, root);
    let missing = ((rest.high - back.high) - back.low) + rest.low;
    let low = if root == 0.0 {
        0.0
    } else {
        missing / (2.0 * root)
    };
    angle(x.abs(), Pair { high: root, low }, false).copysign(x)
}
