//! Normal numbers from uniform bits (Box and Muller 1958), without branches.
//!
//! The polynomials are shorter than those of `ahv-core`: a normal number of 44 bits (f32: 20) is as random as one of 53.
//! By `ahv-core/scripts/elementary.py`.

use core::f64::consts::{FRAC_PI_2, LN_2};

use ahv_core::{Lane, Real};

use super::chacha::WORDS;

/// Most normal numbers that come from a block.
pub(super) const MOST: usize = 16;

/// sin x/x as a polynomial in x² for |x| ≤ π/2; absolute error 2⁻⁴⁴.
const SINE: [f64; 7] = [
    0.9999999999999498,
    -0.1666666666646722,
    0.008333333320383393,
    -0.00019841266687321236,
    2.7556953229449346e-06,
    -2.5030279200133748e-08,
    1.5411363186105563e-10,
];

/// cos x as a polynomial in x² for |x| ≤ π/2; absolute error 2⁻⁴⁸.
const COSINE: [f64; 8] = [
    0.9999999999999981,
    -0.4999999999998996,
    0.041666666665811244,
    -0.0013888888861122554,
    2.4801582874307304e-05,
    -2.755693565584146e-07,
    2.0858324349964e-09,
    -1.1008026561441563e-11,
];

/// (artanh s − s)/s³ as a polynomial in s² for |s| ≤ (√2 − 1)/(√2 + 1); relative error of artanh s 2⁻⁴⁴.
const ARTANH: [f64; 5] = [
    0.3333333333692341,
    0.1999999793005545,
    0.14286057113457418,
    0.11087546575232551,
    0.09804523740099952,
];

/// As [`SINE`]; error 2⁻²⁷.
const SINE_F32: [f32; 5] = [
    1.0,
    -0.166_666_58,
    0.008_333_051,
    -0.000_198_090_7,
    2.605_210_3e-6,
];

/// As [`COSINE`]; error 2⁻²⁴.
const COSINE_F32: [f32; 5] = [
    0.999_999_94,
    -0.499_999_05,
    0.041_663_583,
    -0.001_385_369_7,
    2.315_377_2e-5,
];

/// As [`ARTANH`]; error 2⁻²⁹.
const ARTANH_F32: [f32; 3] = [0.333_333_88, 0.199_880_39, 0.149_627_97];

/// The bits of √½.
const ROOT_HALF: u64 = 0x3FE6_A09E_667F_3BCD;
const ROOT_HALF_F32: u32 = 0x3F35_04F3;
/// The bits of 1, and those of the fraction of a number.
const ONE: u64 = 0x3FF0_0000_0000_0000;
const FRACTION: u64 = 0x000F_FFFF_FFFF_FFFF;
const ONE_F32: u32 = 0x3F80_0000;
const FRACTION_F32: u32 = 0x007F_FFFF;
/// 2⁵²: a whole number in its low bits is what it exceeds 2⁵² by.
const TWO_52: u64 = 0x4330_0000_0000_0000;
/// 2⁻³¹
const UNIT_31: f64 = 1.0 / (1_u64 << 31) as f64;

/// What normal numbers are computed in.
pub trait Precision: Lane {
    /// Numbers that a block of ChaCha8 gives.
    #[doc(hidden)]
    const PER_BLOCK: u64;

    /// Puts the numbers of a block, one a lane, to the first [`Self::PER_BLOCK`] places.
    #[doc(hidden)]
    fn fill<const N: usize>(numbers: &mut [[Self; N]; MOST], words: &[[u32; N]; WORDS]);
}

/// Three words make two numbers: 52 bits for the radius, 32 for the angle.
impl Precision for f64 {
    const PER_BLOCK: u64 = 10;

    #[inline(always)]
    fn fill<const N: usize>(numbers: &mut [[Self; N]; MOST], words: &[[u32; N]; WORDS]) {
        let (threes, _) = words.as_chunks();
        let (pairs, _) = numbers.as_chunks_mut();
        for ([low, high, angle], [first, second]) in threes.iter().zip(pairs) {
            for lane in 0..N {
                let radius = u64::from(low[lane]) | (u64::from(high[lane]) << 32);
                [first[lane], second[lane]] = pair(radius, angle[lane]);
            }
        }
    }
}

/// Two words make two numbers: 31 bits for the radius, 32 for the angle.
impl Precision for f32 {
    const PER_BLOCK: u64 = 16;

    #[inline(always)]
    fn fill<const N: usize>(numbers: &mut [[Self; N]; MOST], words: &[[u32; N]; WORDS]) {
        let (twos, _) = words.as_chunks();
        let (pairs, _) = numbers.as_chunks_mut();
        for ([radius, angle], [first, second]) in twos.iter().zip(pairs) {
            for lane in 0..N {
                [first[lane], second[lane]] = pair_f32(radius[lane], angle[lane]);
            }
        }
    }
}

/// √(−2 ln u) (cos θ, sin θ) for u in (0, 1] from the upper 52 bits of `radius` and θ in [−π/2, π/2) from `angle`; the
/// lowest bit of `radius` says whether half a turn is added to θ.
#[inline(always)]
fn pair(radius: u64, angle: u32) -> [f64; 2] {
    let u = 2.0 - f64::from_bits(ONE | (radius >> 12));
    // u = 2ᵏ m with m between √½ and √2.
    let shifted = u.to_bits().wrapping_add(ONE - ROOT_HALF);
    let k = f64::from_bits(TWO_52 | (shifted >> 52)) - (f64::from_bits(TWO_52) + 1023.0);
    let m = f64::from_bits((shifted & FRACTION).wrapping_add(ROOT_HALF));
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let [a0, a1, a2, a3, a4] = ARTANH;
    let artanh = s + s * z * (a0 + z * (a1 + z * (a2 + z * (a3 + z * a4))));
    let r = Real::sqrt(k * (-2.0 * LN_2) - 4.0 * artanh);
    let r = f64::from_bits(r.to_bits() ^ (radius << 63));

    let theta = f64::from(angle as i32) * (FRAC_PI_2 * UNIT_31);
    let z = theta * theta;
    let [s0, s1, s2, s3, s4, s5, s6] = SINE;
    let sine = theta * (s0 + z * (s1 + z * (s2 + z * (s3 + z * (s4 + z * (s5 + z * s6))))));
    let [c0, c1, c2, c3, c4, c5, c6, c7] = COSINE;
    let cosine = c0 + z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * (c6 + z * c7))))));
    [r * cosine, r * sine]
}

/// As [`pair`], with the upper 31 bits of `radius`.
#[inline(always)]
fn pair_f32(radius: u32, angle: u32) -> [f32; 2] {
    let u = ((radius >> 1) as i32 as f32 + 1.0) * UNIT_31 as f32;
    let shifted = u.to_bits().wrapping_add(ONE_F32 - ROOT_HALF_F32);
    let k = ((shifted >> 23) as i32 - 127) as f32;
    let m = f32::from_bits((shifted & FRACTION_F32).wrapping_add(ROOT_HALF_F32));
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let [a0, a1, a2] = ARTANH_F32;
    let artanh = s + s * z * (a0 + z * (a1 + z * a2));
    let r = Real::sqrt(k * (-2.0 * LN_2) as f32 - 4.0 * artanh);
    let r = f32::from_bits(r.to_bits() ^ (radius << 31));

    let theta = angle as i32 as f32 * (FRAC_PI_2 * UNIT_31) as f32;
    let z = theta * theta;
    let [s0, s1, s2, s3, s4] = SINE_F32;
    let sine = theta * (s0 + z * (s1 + z * (s2 + z * (s3 + z * s4))));
    let [c0, c1, c2, c3, c4] = COSINE_F32;
    let cosine = c0 + z * (c1 + z * (c2 + z * (c3 + z * c4)));
    [r * cosine, r * sine]
}

#[cfg(test)]
mod tests;
