//! Sine, cosine and exponential of single precision against those of doubles.
#![forbid(unsafe_code)]

mod common;

use ahv_core::Real;
use core::f32::consts::FRAC_PI_4;

/// Largest errors in ulp: sine, cosine, exponential.
#[derive(Default)]
struct Worst([(f64, f32); 3]);

impl Worst {
    fn meet(&mut self, function: usize, x: f32, found: f32, exact: f64) {
        let nearest = (exact as f32).abs();
        let ulps = (f64::from(found) - exact).abs() / f64::from(nearest.next_up() - nearest);
        assert!(ulps < 1.0, "function {function}: {ulps} ulp at {x:?}");
        let worst = &mut self.0[function];
        if ulps > worst.0 {
            *worst = (ulps, x);
        }
    }

    fn meet_sin_cos(&mut self, x: f32) {
        let ((sin, cos), (exact_sin, exact_cos)) = (Real::sin_cos(x), Real::sin_cos(f64::from(x)));
        self.meet(0, x, sin, exact_sin);
        self.meet(1, x, cos, exact_cos);
    }

    fn meet_exp(&mut self, x: f32) {
        self.meet(2, x, Real::exp(x), Real::exp(f64::from(x)));
    }
}

/// Every `stride`-th number from 0 to `last`, with both signs.
fn numbers(last: f32, stride: usize) -> impl Iterator<Item = f32> {
    let bits = (0..=last.to_bits()).step_by(stride);
    bits.map(f32::from_bits).flat_map(|x| [x, -x])
}

#[test]
fn sine_and_cosine_are_within_an_ulp() {
    let mut worst = Worst::default();
    let mut points = 0;
    let moderate = numbers(1e4, 1009);
    let beyond = numbers(f32::MAX, 20_011).filter(|x| x.abs() > 1e4);
    let small = common::spread(-0.8, 0.8, 500_000).map(|x| x as f32);
    // Where the reduction cancels most.
    let multiples = (1..=6367).map(|turn| (f64::from(turn) * core::f64::consts::FRAC_PI_2) as f32);
    for x in moderate.chain(beyond).chain(small).chain(multiples) {
        worst.meet_sin_cos(x);
        points += 1;
    }
    println!(
        "sin, cos: {:?} in ulp and where, of {points} points",
        &worst.0[..2]
    );
    assert!(points > 1_000_000);
}

#[test]
fn exponential_is_within_an_ulp() {
    let mut worst = Worst::default();
    let mut points = 0;
    let spread = common::spread(-87.3, 88.7, 800_000).map(|x| x as f32);
    for x in numbers(87.3, 5003).chain(spread) {
        worst.meet_exp(x);
        points += 1;
    }
    println!("exp: {:?} in ulp and where, of {points} points", worst.0[2]);
    assert!(points > 1_000_000);
}

#[test]
fn edges_are_those_of_ieee() {
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(Real::sin(x).is_nan() && Real::cos(x).is_nan());
    }
    assert!(Real::exp(f32::NAN).is_nan());
    assert_eq!(Real::exp(f32::INFINITY), f32::INFINITY);
    assert_eq!(Real::exp(f32::NEG_INFINITY), 0.0);
    assert_eq!(Real::exp(89.0_f32), f32::INFINITY);
    assert_eq!(Real::exp(-104.0_f32), 0.0);
    assert!(Real::exp(-100.0_f32) > 0.0);
    assert_eq!(Real::exp(0.0_f32), 1.0);
    assert_eq!(Real::exp(-0.0_f32), 1.0);
    assert_eq!(Real::sin_cos(0.0_f32), (0.0, 1.0));
    assert_eq!(Real::sin(-0.0_f32).to_bits(), 0.0_f32.to_bits());
    for tiny in [f32::from_bits(1), f32::MIN_POSITIVE, 1e-20] {
        for x in [tiny, -tiny] {
            assert_eq!(Real::sin_cos(x), (x, 1.0));
            assert_eq!(Real::exp(x), 1.0);
        }
    }
}

/// On both sides of the places where a function goes another way.
#[test]
fn ways_meet_within_an_ulp() {
    let mut worst = Worst::default();
    let around = |x: f32| {
        let (up, down) = (x.next_up(), x.next_down());
        [x, up, up.next_up(), down, down.next_down()]
            .into_iter()
            .flat_map(|x| [x, -x])
    };
    for x in [FRAC_PI_4, 1e4].into_iter().flat_map(around) {
        worst.meet_sin_cos(x);
    }
    around(87.0).for_each(|x| worst.meet_exp(x));
    println!("{:?} in ulp and where", worst.0);
}
