//! Sine, cosine and exponential of doubles against Taylor series in pairs of doubles, which carry about 106 bits, and both
//! against mpmath.
#![forbid(unsafe_code)]

mod common;

use ahv_core::Real;
use common::{around, spread};

/// A sum of two doubles, the second below half an ulp of the first.
#[derive(Clone, Copy, Debug)]
struct Pair(f64, f64);

impl Pair {
    const ZERO: Self = Self(0.0, 0.0);

    fn plus(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let back = sum - self.0;
        let error = (self.0 - (sum - back)) + (other.0 - back);
        Self::normal(sum, error + self.1 + other.1)
    }

    fn product(a: f64, b: f64) -> Self {
        Self(a * b, a.mul_add(b, -(a * b)))
    }

    fn times(self, other: Self) -> Self {
        let Self(product, error) = Self::product(self.0, other.0);
        Self::normal(product, error + self.0 * other.1 + self.1 * other.0)
    }

    fn over(self, divisor: f64) -> Self {
        let quotient = self.0 / divisor;
        let rest = (-quotient).mul_add(divisor, self.0) + self.1;
        Self::normal(quotient, rest / divisor)
    }

    fn minus(self) -> Self {
        Self(-self.0, -self.1)
    }

    fn normal(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }

    /// Distance of a double from this number, in ulp of the number.
    fn ulps(self, found: f64) -> f64 {
        (((found - self.0) - self.1) / ulp(self.0)).abs()
    }
}

fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

/// Terms of the series: on |x| ≤ π/4 what is left out is below 2⁻¹¹⁰.
const TERMS: u32 = 28;

/// Σ x^k/k! over even k and over odd k, each with the sign `sign` from term to term.
fn series(x: Pair, sign: f64) -> [Pair; 2] {
    let mut term = Pair(1.0, 0.0);
    let mut sums = [Pair::ZERO; 2];
    for k in 0..TERMS {
        let sum = &mut sums[(k % 2) as usize];
        *sum = sum.plus(term);
        term = term.times(x).over(f64::from(k + 1));
        if k % 2 == 1 {
            term = Pair(sign * term.0, sign * term.1);
        }
    }
    sums
}

/// π/2 and ln 2 as sums of three doubles.
const HALF_PI: [f64; 3] = [
    core::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_7e-33,
];
const LN_2: [f64; 3] = [
    core::f64::consts::LN_2,
    2.319_046_813_846_299_6e-17,
    5.707_708_438_416_212e-34,
];

/// The nearest multiple of `unit`, and what x exceeds it by.
fn reduced(x: f64, unit: [f64; 3]) -> (f64, Pair) {
    let count = (x / unit[0]).round();
    let parts = unit.map(|part| Pair::product(-count, part));
    (count, parts.into_iter().fold(Pair(x, 0.0), Pair::plus))
}

fn sin_cos(x: f64) -> [Pair; 2] {
    let (turns, rest) = reduced(x, HALF_PI);
    let [cos, sin] = series(rest, -1.0);
    match turns.rem_euclid(4.0) as u8 {
        0 => [sin, cos],
        1 => [cos, sin.minus()],
        2 => [sin.minus(), cos.minus()],
        _ => [cos.minus(), sin],
    }
}

/// The exponential as a number near 1 and the doublings that it lacks.
fn exp(x: f64) -> (Pair, f64) {
    let (doublings, rest) = reduced(x, LN_2);
    let [even, odd] = series(rest, 1.0);
    (even.plus(odd), doublings)
}

/// The number without its doublings, in two steps of which neither leaves the normal numbers.
fn halved(x: f64, doublings: f64) -> f64 {
    let half = (doublings / 2.0).trunc();
    x * 2f64.powi(-half as i32) * 2f64.powi((half - doublings) as i32)
}

/// The error of a function, the largest so far and where it was.
#[derive(Default)]
struct Worst {
    ulps: f64,
    at: f64,
    points: u32,
}

impl Worst {
    fn meet(&mut self, x: f64, ulps: f64) {
        assert!(ulps < 1.0, "{ulps} ulp at {x:?}");
        self.points += 1;
        if ulps > self.ulps {
            (self.ulps, self.at) = (ulps, x);
        }
    }
}

impl std::fmt::Display for Worst {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { ulps, at, points } = self;
        write!(f, "{ulps:.4} ulp at {at:?} of {points} points")
    }
}

fn meet_sin_cos(worst: &mut [Worst; 2], x: f64) {
    let ((sin, cos), exact) = (Real::sin_cos(x), sin_cos(x));
    worst[0].meet(x, exact[0].ulps(sin));
    worst[1].meet(x, exact[1].ulps(cos));
}

fn meet_exp(worst: &mut Worst, x: f64) {
    let (exact, doublings) = exp(x);
    worst.meet(x, exact.ulps(halved(Real::exp(x), doublings)));
}

#[test]
fn sine_and_cosine_are_within_an_ulp() {
    let mut worst = <[Worst; 2]>::default();
    let ranges = [
        (-0.2, 0.2, 100_000),
        (-0.8, 0.8, 200_000),
        (-10.0, 10.0, 100_000),
        (-1e6, 1e6, 100_000),
    ];
    for (low, high, count) in ranges {
        spread(low, high, count).for_each(|x| meet_sin_cos(&mut worst, x));
    }
    // Where the reduction cancels most: at each multiple of π/2 up to the last angle that is reduced here.
    let mut turn = 1.0;
    while turn <= 636_619.0 {
        let Pair(high, low) = Pair::product(turn, HALF_PI[0]);
        meet_sin_cos(&mut worst, high + (low + turn * HALF_PI[1]));
        turn += 1.0;
    }
    println!("sin {}, cos {}", worst[0], worst[1]);
}

#[test]
fn exponential_is_within_an_ulp() {
    let mut worst = Worst::default();
    let ranges = [
        (-3.0, 3.0, 500_000),
        (-708.0, 708.0, 400_000),
        (-1e-3, 1e-3, 100_000),
    ];
    for (low, high, count) in ranges {
        spread(low, high, count).for_each(|x| meet_exp(&mut worst, x));
    }
    println!("exp {worst}");
}

/// The series of this file and the functions of the crate.
#[test]
fn mpmath_gives_the_same() {
    let text = include_str!("../../../tests/vectors/elementary.txt");
    let (mut worst, mut oracle) = (<[Worst; 3]>::default(), 0.0_f64);
    for line in text.lines().skip(1) {
        let (name, numbers) = line.split_once(',').expect("function,x,nearest,missing");
        let numbers: Vec<f64> = numbers
            .split(',')
            .map(|n| n.parse().expect("a number"))
            .collect();
        let [x, nearest, missing] = numbers[..] else {
            panic!("three numbers")
        };
        let (place, found, (Pair(high, low), doublings)) = match name {
            "sin" => (0, Real::sin(x), (sin_cos(x)[0], 0.0)),
            "cos" => (1, Real::cos(x), (sin_cos(x)[1], 0.0)),
            _ => (2, Real::exp(x), exp(x)),
        };
        worst[place].meet(x, ((found - nearest) / ulp(nearest) - missing).abs());
        if x.abs() <= 1e6 && nearest.is_normal() {
            let nearest = halved(nearest, doublings);
            let difference = ((high - nearest) + low) / ulp(nearest) - missing;
            oracle = oracle.max(difference.abs());
        }
    }
    // The file's last number has six decimals.
    assert!(oracle < 1e-6, "the series are off by {oracle} ulp");
    println!(
        "sin {}, cos {}, exp {}; series {oracle:.1e}",
        worst[0], worst[1], worst[2]
    );
}

#[test]
fn edges_are_those_of_ieee() {
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(Real::sin(x).is_nan() && Real::cos(x).is_nan());
    }
    assert!(Real::exp(f64::NAN).is_nan());
    assert_eq!(Real::exp(f64::INFINITY), f64::INFINITY);
    assert_eq!(Real::exp(f64::NEG_INFINITY), 0.0);
    assert_eq!(Real::exp(710.0_f64), f64::INFINITY);
    assert_eq!(Real::exp(-746.0_f64), 0.0);
    assert!(Real::exp(-740.0_f64) > 0.0);
    assert_eq!(Real::exp(0.0_f64), 1.0);
    assert_eq!(Real::exp(-0.0_f64), 1.0);
    assert_eq!(Real::sin_cos(0.0_f64), (0.0, 1.0));
    assert_eq!(Real::sin(-0.0_f64).to_bits(), 0.0_f64.to_bits());
    for tiny in [f64::from_bits(1), f64::MIN_POSITIVE, 1e-160, 1e-20] {
        for x in [tiny, -tiny] {
            assert_eq!(Real::sin_cos(x), (x, 1.0));
            assert_eq!(Real::exp(x), 1.0);
        }
    }
    assert!((Real::sin(1e22) - 1e22f64.sin()).abs() < 1e-15);
}

/// On both sides of the places where a function goes another way.
#[test]
fn ways_meet_within_an_ulp() {
    let (mut worst, mut worst_exp) = (<[Worst; 2]>::default(), Worst::default());
    let meetings = [core::f64::consts::FRAC_PI_4, 1e6];
    meetings
        .into_iter()
        .flat_map(around)
        .for_each(|x| meet_sin_cos(&mut worst, x));
    around(708.0).for_each(|x| meet_exp(&mut worst_exp, x));
    println!("sin {}, cos {}, exp {worst_exp}", worst[0], worst[1]);
}
