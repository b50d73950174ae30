//! Sine, cosine and exponential against Taylor series in pairs of doubles, which carry about 106 bits.

use ahv_core::Real;

/// A sum of two doubles, the second below half an ulp of the first.
#[derive(Clone, Copy)]
struct Pair(f64, f64);

impl Pair {
    fn plus(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let back = sum - self.0;
        let error = (self.0 - (sum - back)) + (other.0 - back);
        Self::normal(sum, error + self.1 + other.1)
    }

    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let error = self.0.mul_add(other.0, -product);
        Self::normal(product, error + self.0 * other.1 + self.1 * other.0)
    }

    fn over(self, divisor: f64) -> Self {
        let quotient = self.0 / divisor;
        let rest = (-quotient).mul_add(divisor, self.0) + self.1;
        Self::normal(quotient, rest / divisor)
    }

    fn normal(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }

    /// Distance of a double from this number, in ulp of the number.
    fn ulps(self, found: f64) -> f64 {
        let ulp = self.0.abs().next_up() - self.0.abs();
        (((found - self.0) - self.1) / ulp).abs()
    }
}

/// Σ xᵏ/k! over every `stride`-th k from `first`, with alternating signs where asked.
fn series(x: Pair, first: u32, stride: u32, alternating: bool) -> Pair {
    let mut term = Pair(1.0, 0.0);
    let mut total = Pair(0.0, 0.0);
    for k in 0..40 {
        if k >= first && (k - first).is_multiple_of(stride) {
            let odd = ((k - first) / stride) % 2 == 1;
            let signed = if alternating && odd {
                Pair(-term.0, -term.1)
            } else {
                term
            };
            total = total.plus(signed);
        }
        term = term.times(x).over(f64::from(k + 1));
    }
    total
}

const HALF_PI: Pair = Pair(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
const LN_2: Pair = Pair(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);

fn reduced(x: f64, unit: Pair) -> (f64, Pair) {
    let count = (x / unit.0).round();
    let multiple = Pair(count, 0.0).times(unit);
    (count, Pair(x, 0.0).plus(Pair(-multiple.0, -multiple.1)))
}

fn sin_cos(x: f64) -> (Pair, Pair) {
    let (turns, rest) = reduced(x, HALF_PI);
    let (sin, cos) = (series(rest, 1, 2, true), series(rest, 0, 2, true));
    let minus = |p: Pair| Pair(-p.0, -p.1);
    match turns.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, minus(sin)),
        2 => (minus(sin), minus(cos)),
        _ => (minus(cos), sin),
    }
}

fn exp(x: f64) -> Pair {
    let (doublings, rest) = reduced(x, LN_2);
    let mantissa = series(rest, 0, 1, false);
    let scale = 2f64.powi(doublings as i32);
    Pair(mantissa.0 * scale, mantissa.1 * scale)
}

/// Points that fill an interval evenly without a common fraction.
fn spread(low: f64, high: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| low + (high - low) * (f64::from(k) * 0.618_033_988_749_894_9).fract())
}

#[test]
fn sine_and_cosine_are_within_an_ulp() {
    let mut worst = (0.0_f64, 0.0_f64);
    let ranges = [
        (-0.2, 0.2, 60_000),
        (-0.8, 0.8, 60_000),
        (-10.0, 10.0, 60_000),
        (-9e5, 9e5, 20_000),
    ];
    for (low, high, count) in ranges {
        for x in spread(low, high, count) {
            let (sin, cos) = Real::sin_cos(x);
            let (exact_sin, exact_cos) = sin_cos(x);
            let (s, c) = (exact_sin.ulps(sin), exact_cos.ulps(cos));
            assert!(s < 1.0 && c < 1.0, "at {x}: sin {s}, cos {c} ulp");
            worst = (worst.0.max(s), worst.1.max(c));
        }
    }
    println!("worst: sin {:.3}, cos {:.3} ulp", worst.0, worst.1);
}

#[test]
fn exponential_is_within_an_ulp() {
    let mut worst = 0.0_f64;
    for (low, high, count) in [
        (-3.0, 3.0, 60_000),
        (-700.0, 700.0, 60_000),
        (-1e-3, 1e-3, 10_000),
    ] {
        for x in spread(low, high, count) {
            let error = exp(x).ulps(Real::exp(x));
            assert!(error < 1.0, "at {x}: {error} ulp");
            worst = worst.max(error);
        }
    }
    println!("worst: exp {worst:.3} ulp");
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
    assert_eq!(Real::sin_cos(0.0_f64), (0.0, 1.0));
    // Where the small angle's way meets the reduction.
    let edge = core::f64::consts::FRAC_PI_4;
    for x in [edge, edge.next_up(), edge.next_down()] {
        assert!(sin_cos(x).0.ulps(Real::sin(x)) < 1.0 && sin_cos(x).1.ulps(Real::cos(x)) < 1.0);
    }
    assert!((Real::sin(1e22) - 1e22f64.sin()).abs() < 1e-15);
}
