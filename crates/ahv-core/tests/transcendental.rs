//! The elementary functions that are computed in pairs of doubles against mpmath: tangents, logarithm, powers, their inverses.
#![forbid(unsafe_code)]

mod common;

use std::collections::BTreeMap;

use ahv_core::Real;

/// The value that the crate gives.
fn found<R: Real>(name: &str, x: R, y: R) -> R {
    match name {
        "tan" => x.tan(),
        "asin" => x.asin(),
        "atan" => x.atan(),
        "atan2" => x.atan2(y),
        "tanh" => x.tanh(),
        "ln" => x.ln(),
        "powr" => x.powr(y),
        _ => panic!("the vectors name {name}"),
    }
}

/// The size of the last bit of a number.
fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

#[test]
fn mpmath_gives_the_same() {
    let text = include_str!("../../../tests/vectors/transcendental.txt");
    let mut worst = BTreeMap::<&str, (f64, f64, f64)>::new();
    for line in text.lines().skip(1) {
        let (name, numbers) = line.split_once(',').expect("function,x,y,nearest,missing");
        let numbers: Vec<f64> = numbers
            .split(',')
            .map(|n| n.parse().expect("a number"))
            .collect();
        let [x, y, nearest, missing] = numbers[..] else {
            panic!("four numbers")
        };
        let value = found(name, x, y);
        let ulps = if nearest.is_finite() {
            ((value - nearest) / ulp(nearest) - missing).abs()
        } else {
            assert_eq!(value, nearest, "{name} of {x:?}, {y:?}");
            0.0
        };
        assert!(
            ulps < 1.0,
            "{name} of {x:?}, {y:?}: {value:?} is off by {ulps} ulp"
        );
        let largest = worst.entry(name).or_default();
        if ulps > largest.0 {
            *largest = (ulps, x, y);
        }
    }
    assert_eq!(worst.len(), 7);
    println!("largest errors in ulp, and where: {worst:?}");
}

/// Singles are rounded doubles: within half an ulp and what the double misses.
#[test]
fn singles_are_the_nearest_to_doubles() {
    for x in common::spread(-3.0, 3.0, 200_000).map(|x| x as f32) {
        let y = 1.7 - x;
        for name in ["tan", "asin", "atan", "atan2", "tanh", "ln", "powr"] {
            let (single, double) = (found(name, x, y), found(name, f64::from(x), f64::from(y)));
            assert!(
                single == double as f32 || single.is_nan() && double.is_nan(),
                "{name} of {x}, {y}"
            );
        }
    }
}

/// Above 10⁶ rad the tangent is the quotient of sine and cosine.
#[test]
fn tangent_of_large_angles_is_a_quotient() {
    for x in [1e6_f64.next_up(), 1e15, 1e22, f64::MAX] {
        let (sin, cos) = Real::sin_cos(x);
        assert_eq!(Real::tan(x), sin / cos);
        assert_eq!(Real::tan(-x), -sin / cos);
    }
}

#[test]
fn edges_are_those_of_ieee() {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    for name in ["tan", "asin", "atan", "atan2", "tanh", "ln", "powr"] {
        assert!(found(name, nan, 0.5).is_nan() && found(name, nan, nan).is_nan());
    }
    for name in ["tan", "asin", "atan", "tanh"] {
        for x in [0.0_f64, -0.0, f64::from_bits(1), -f64::MIN_POSITIVE, 1e-300] {
            assert_eq!(found(name, x, 0.0).to_bits(), x.to_bits(), "{name} of {x}");
        }
    }
    assert!(Real::tan(inf).is_nan() && Real::asin(1.0_f64.next_up()).is_nan());
    assert!(Real::asin(inf).is_nan() && Real::asin(-2.0_f64).is_nan());
    assert_eq!((Real::asin(1.0), Real::asin(-1.0)), (FRAC_PI_2, -FRAC_PI_2));
    assert_eq!((Real::atan(inf), Real::atan(-inf)), (FRAC_PI_2, -FRAC_PI_2));
    assert_eq!((Real::tanh(inf), Real::tanh(-inf)), (1.0, -1.0));
    assert_eq!((Real::ln(0.0), Real::ln(-0.0)), (-inf, -inf));
    assert_eq!((Real::ln(1.0), Real::ln(inf)), (0.0, inf));
    assert!(Real::ln(-1e-300_f64).is_nan() && Real::ln(-inf).is_nan());
    let angles = [
        (0.0, 1.0, 0.0),
        (0.0, -1.0, PI),
        (0.0, 0.0, 0.0),
        (0.0, -0.0, PI),
        (1.0, 0.0, FRAC_PI_2),
        (1.0, -0.0, FRAC_PI_2),
        (1.0, 1.0, FRAC_PI_4),
        (inf, inf, FRAC_PI_4),
        (inf, -inf, 3.0 * FRAC_PI_4),
        (inf, 1.0, FRAC_PI_2),
        (inf, -1e308, FRAC_PI_2),
        (1.0, inf, 0.0),
        (1.0, -inf, PI),
    ];
    for (y, x, angle) in angles {
        assert_eq!(Real::atan2(y, x).to_bits(), f64::to_bits(angle), "{y}, {x}");
        assert_eq!(Real::atan2(-y, x), -angle, "{y}, {x}");
    }
    assert!(Real::atan2(1.0, nan).is_nan() && Real::atan2(nan, inf).is_nan());
}

#[test]
fn edges_of_powers_are_those_of_powr() {
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    let powers = [
        (0.0, 0.5, 0.0),
        (0.0, -0.5, inf),
        (inf, 0.5, inf),
        (inf, -0.5, 0.0),
        (2.0, 0.0, 1.0),
        (2.0, -0.0, 1.0),
        (1.0, 1e300, 1.0),
        (1.0, 1e301, 1.0),
        (1.0, -f64::MAX, 1.0),
        (2.0, inf, inf),
        (2.0, -inf, 0.0),
        (0.5, inf, 0.0),
        (0.5, -inf, inf),
        (2.0, 1e308, inf),
        (2.0, -1e308, 0.0),
        (2.0, -1074.0, f64::from_bits(1)),
        (2.0, -1022.0, f64::MIN_POSITIVE),
        (2.0, 1023.0, 8.98846567431158e307),
        (2.0, 1024.0, inf),
        (9.0, 0.5, 3.0),
        (1024.0, 0.25, 5.656854249492381),
    ];
    for (x, y, power) in powers {
        assert_eq!(Real::powr(x, y), power, "{x} to the power {y}");
    }
    for (x, y) in [
        (0.0, 0.0),
        (inf, 0.0),
        (1.0, inf),
        (-1.0, 0.5),
        (-8.0, 3.0),
        (2.0, nan),
    ] {
        assert!(Real::powr(x, y).is_nan(), "{x} to the power {y}");
    }
}

/// What cannot be compared is no number.
#[test]
fn choices_are_those_of_the_order() {
    let nan = f64::NAN;
    assert_eq!(Real::select(1.0, 2.0, 3.0, 4.0), 3.0);
    assert_eq!(Real::select(2.0, 2.0, 3.0, 4.0), 4.0);
    assert_eq!(Real::select(-0.0, 0.0, 3.0, 4.0), 4.0);
    assert_eq!(Real::select(1.0, 2.0, 3.0, nan), 3.0);
    assert!(Real::select(1.0, 2.0, nan, 3.0).is_nan());
    assert!(Real::select(nan, 2.0, 3.0, 4.0).is_nan() && Real::select(2.0, nan, 3.0, 4.0).is_nan());
    assert_eq!(<f64 as Real>::min(-1.0, 2.0), -1.0);
    assert_eq!(<f64 as Real>::max(-1.0, 2.0), 2.0);
    for (x, y) in [(nan, 1.0), (1.0, nan)] {
        assert!(<f64 as Real>::min(x, y).is_nan() && <f64 as Real>::max(x, y).is_nan());
        assert!(<f32 as Real>::min(x as f32, y as f32).is_nan());
    }
}
