//! What [`Lanes`] and [`Branchless`] promise: the bits of the numbers that stand in them.
#![forbid(unsafe_code)]

mod common;

use ahv_core::{Branchless, Lane, Lanes, Real};

const WIDTH: usize = 4;

/// Bits of a number, of which all that are NaN count as one.
fn bits(x: f64) -> u64 {
    if x.is_nan() {
        f64::NAN.to_bits()
    } else {
        x.to_bits()
    }
}

/// Every function of one number.
fn functions<R: Real>(x: R) -> [R; 14] {
    let (sin, cos) = x.sin_cos();
    [
        sin,
        cos,
        x.sin(),
        x.cos(),
        x.exp(),
        x.sqrt(),
        x.recip(),
        x.abs(),
        -x,
        x.asin(),
        x.atan(),
        x.tanh(),
        x.ln(),
        x.tan(),
    ]
}

/// Every function of two numbers.
fn operations<R: Real>(x: R, y: R) -> [R; 9] {
    [
        x + y,
        x - y,
        x * y,
        x / y,
        x.atan2(y),
        x.powr(y),
        x.min(y),
        x.max(y),
        x.select(y, y, x + x),
    ]
}

/// Numbers for which the functions go different ways, and those next to where the ways part.
fn varied<T: Real>(parting: &[f64]) -> Vec<T> {
    let edges = [
        0.0,
        -0.0,
        1e-310,
        5e-324,
        1e-40,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
    ];
    let ranges = [1e-6, 0.7, 3.0, 90.0, 1e3, 2e6, 1e15];
    edges
        .into_iter()
        .chain(parting.iter().flat_map(|&x| common::around(x)))
        .chain(ranges.into_iter().flat_map(|x| common::spread(-x, x, 40)))
        .map(T::from_f64)
        .collect()
}

/// Lanes that mix the numbers: neighbours, and numbers from far apart in the list.
fn mixed<T: Copy>(numbers: &[T]) -> Vec<[T; WIDTH]> {
    let length = numbers.len();
    let at = |index: usize| numbers[index % length];
    [1, 7, 61, 113]
        .into_iter()
        .flat_map(|stride| {
            (0..length).map(move |first| [0, 1, 2, 3].map(|lane| at(first + lane * stride)))
        })
        .collect()
}

fn lanes_have_the_bits_of_their_numbers<T: Lane>(parting: &[f64]) {
    let all = mixed(&varied::<T>(parting));
    for (x, y) in all.iter().zip(all.iter().cycle().skip(5)) {
        let (a, b) = (Lanes(*x), Lanes(*y));
        let (of_one, of_two) = (functions(a), operations(a, b));
        for lane in 0..WIDTH {
            let shown = |lanes: &Lanes<T, WIDTH>| bits(lanes.0[lane].to_f64());
            let alone = functions(x[lane]).map(|value| bits(value.to_f64()));
            assert_eq!(
                of_one.each_ref().map(shown),
                alone,
                "{:?} in {x:?}",
                x[lane]
            );
            let alone = operations(x[lane], y[lane]).map(|value| bits(value.to_f64()));
            assert_eq!(
                of_two.each_ref().map(shown),
                alone,
                "{:?} in {x:?}",
                x[lane]
            );
        }
        assert_eq!(a.is_finite(), x.iter().all(|x| x.is_finite()));
    }
}

fn lanes_that_are_not_finite_show_it<T: Lane>() {
    for x in mixed(&varied::<T>(&[])) {
        let x = Lanes(x);
        assert_eq!(x.is_finite(), Real::is_finite(x.to_f64()));
    }
}

#[test]
fn lanes_of_doubles_have_the_bits_of_doubles() {
    let tangent = [0.414_213_562_373_095_03, 2.414_213_562_373_095];
    let parting = [core::f64::consts::FRAC_PI_4, 1e6, 708.0];
    lanes_have_the_bits_of_their_numbers::<f64>(&[parting.as_slice(), &tangent].concat());
    lanes_that_are_not_finite_show_it::<f64>();
}

#[test]
fn lanes_of_singles_have_the_bits_of_singles() {
    lanes_have_the_bits_of_their_numbers::<f32>(&[core::f64::consts::FRAC_PI_4, 1e4, 87.0]);
    lanes_that_are_not_finite_show_it::<f32>();
}

#[test]
fn lanes_of_straight_numbers_have_the_bits_of_those() {
    lanes_have_the_bits_of_their_numbers::<Branchless<f64>>(&[core::f64::consts::FRAC_PI_4, 708.0]);
    lanes_have_the_bits_of_their_numbers::<Branchless<f32>>(&[core::f64::consts::FRAC_PI_4, 87.0]);
}

#[test]
fn lanes_show_what_is_wrong_with_them() {
    assert_eq!(Lanes([1.0, 2.0]).to_f64(), 1.0);
    assert!(Lanes([1.0, f64::NAN]).to_f64().is_nan());
    assert_eq!(Lanes([1.0, 2.0, f64::INFINITY]).to_f64(), f64::INFINITY);
    assert_eq!(Lanes::<f64, 3>::from_f64(0.5), Lanes::splat(0.5));
    assert_eq!(
        [Lanes::ZERO, Lanes::ONE, Lanes::TWO, Lanes::HALF],
        [0.0, 1.0, 2.0, 0.5].map(Lanes::<f64, 3>::splat)
    );
    assert_eq!(
        Lanes::<usize, 3>::from_fn(|lane| 2 * lane),
        Lanes([0, 2, 4])
    );
}

/// The numbers for which a straight function has a result.
struct Range {
    angle: f64,
    exponent: f64,
    turns: f64,
}

fn straight_numbers_have_the_bits_of_theirs<T: Lane>(range: &Range, parting: &[f64]) {
    let numbers = varied::<T>(parting);
    let (mut inside, mut outside) = (0, 0);
    for (index, &x) in numbers.iter().enumerate() {
        let magnitude = x.to_f64().abs();
        let known = [magnitude <= range.angle; 4]
            .into_iter()
            .chain([magnitude <= range.exponent]);
        let known = known.chain([true; 8]);
        let known = known.chain([magnitude <= range.turns]);
        for ((found, exact), known) in functions(Branchless(x))
            .into_iter()
            .zip(functions(x))
            .zip(known)
        {
            if known {
                assert_eq!(bits(found.to_f64()), bits(exact.to_f64()), "{x:?}");
                inside += 1;
            } else {
                assert!(found.to_f64().is_nan(), "{x:?}");
                outside += 1;
            }
        }
        let y = numbers[(index + 7) % numbers.len()];
        let found = operations(Branchless(x), Branchless(y)).map(|value| bits(value.to_f64()));
        assert_eq!(found, operations(x, y).map(|value| bits(value.to_f64())));
        assert!(Real::is_finite(Branchless(x)));
    }
    assert!(inside > 500 && outside > 500);
}

#[test]
fn straight_doubles_have_the_bits_of_doubles_or_are_nan() {
    let range = Range {
        angle: core::f64::consts::FRAC_PI_4,
        exponent: 708.0,
        turns: 1e6,
    };
    straight_numbers_have_the_bits_of_theirs::<f64>(&range, &[range.angle, range.exponent]);
}

#[test]
fn straight_singles_have_the_bits_of_singles_or_are_nan() {
    let range = Range {
        angle: f64::from(core::f32::consts::FRAC_PI_4),
        exponent: 87.0,
        turns: 1e4,
    };
    straight_numbers_have_the_bits_of_theirs::<f32>(&range, &[range.angle, range.exponent]);
}

/// With the feature `std` the root is the standard library's.
#[test]
fn roots_have_the_bits_of_those_without_std() {
    for x in varied::<f64>(&[2.0]) {
        assert_eq!(bits(Real::sqrt(x)), bits(libm::sqrt(x)));
        let x = x as f32;
        assert_eq!(bits(Real::sqrt(x).into()), bits(libm::sqrtf(x).into()));
    }
    for x in common::spread(1e-3, 1e3, 100_000) {
        assert_eq!(Real::sqrt(x), libm::sqrt(x));
        assert_eq!(Real::sqrt(x as f32), libm::sqrtf(x as f32));
    }
}
