//! What [`Fused`] rounds, and what it does not.
#![forbid(unsafe_code)]

mod common;

use ahv_core::{Fused, MulAdd, Real, Straight};

fn quadruples() -> impl Iterator<Item = [f64; 4]> {
    let numbers: Vec<f64> = common::spread(-2.0, 2.0, 4001).collect();
    (0..100_000).map(move |k| [1, 3, 7, 13].map(|stride| numbers[k * stride % numbers.len()]))
}

#[test]
fn products_are_added_in_one_rounding() {
    for [a, b, c, d] in quadruples() {
        let [x, y, z, w] = [a, b, c, d].map(Fused::new);
        let bits = |fused: Fused<f64>| fused.value().to_bits();
        assert_eq!(bits(x * y + z * w), c.mul_add(d, a * b).to_bits());
        assert_eq!(bits(x * y - z * w), (-c).mul_add(d, a * b).to_bits());
        assert_eq!(bits(z + x * y), a.mul_add(b, c).to_bits());
        assert_eq!(bits(z - x * y), (-a).mul_add(b, c).to_bits());
        assert_eq!(bits(-(x * y) + z), (z.value() + -(a * b)).to_bits());
        assert_eq!(bits(z + -(x * y)), (-a).mul_add(b, c).to_bits());
        let [x, y, z, w] = [a, b, c, d].map(|value| Fused::new(Straight(value)));
        assert_eq!(
            (x * y + z * w).value().0.to_bits(),
            c.mul_add(d, a * b).to_bits()
        );
    }
}

#[test]
fn sums_and_products_alone_are_those_of_doubles() {
    for [a, b, c, _] in quadruples() {
        let [x, y, z] = [a, b, c].map(Fused::new);
        let values = [x + y, x - y, x * y, x / y, -x, -(x * y), x * y * z].map(Fused::value);
        let expected = [a + b, a - b, a * b, a / b, -a, -(a * b), a * b * c];
        assert_eq!(values.map(f64::to_bits), expected.map(f64::to_bits));
        let product = x * y;
        let (sin, cos) = product.sin_cos();
        let values = [
            sin,
            cos,
            product.sin(),
            product.cos(),
            product.exp(),
            product.abs(),
            product.recip(),
        ];
        let p = a * b;
        let (sin, cos) = Real::sin_cos(p);
        let expected = [sin, cos, sin, cos, Real::exp(p), p.abs(), 1.0 / p];
        assert_eq!(
            values.map(|v| v.value().to_bits()),
            expected.map(f64::to_bits)
        );
        assert_eq!(product.abs().sqrt().value(), p.abs().sqrt());
        assert_eq!((product.to_f64(), product.is_finite()), (p, true));
        assert_eq!(product, Fused::from_f64(p));
    }
    assert!(!Fused::new(f64::INFINITY).is_finite());
    assert!(!(Fused::new(f64::MAX) * Fused::TWO).is_finite());
    let constants = [Fused::ZERO, Fused::ONE, Fused::TWO, Fused::HALF];
    assert_eq!(constants.map(Fused::<f64>::value), [0.0, 1.0, 2.0, 0.5]);
}

/// A sum of products of which the first is rounded has an error of one rounding of it and one of the sum; without
/// fusing each product has one.
#[test]
fn fewer_roundings_leave_smaller_errors() {
    let (mut fused_errors, mut plain_errors) = (0.0_f64, 0.0_f64);
    for [a, b, c, d] in quadruples() {
        let [x, y, z, w] = [a, b, c, d].map(Fused::new);
        let (fused, plain) = ((x * y + z * w).value(), a * b + c * d);
        // The exact sum is the plain one and what it, p and q lost.
        let (p, q) = (a * b, c * d);
        let back = plain - p;
        let lost = (p - (plain - back)) + (q - back) + a.mul_add(b, -p) + c.mul_add(d, -q);
        let error = |sum: f64| ((plain - sum) + lost).abs();
        let bound = f64::EPSILON / 2.0 * (p.abs() + fused.abs());
        assert!(error(fused) <= bound * 1.0001, "{a} {b} {c} {d}");
        fused_errors += error(fused);
        plain_errors += error(plain);
    }
    let ratio = fused_errors / plain_errors;
    println!("mean error of a·b + c·d, fused to plain: {ratio:.3}");
    assert!(ratio < 0.9);
    // (1 + ε)² = 1 + 2ε + ε², of which a rounded product has lost the last term.
    let (x, known) = (1.0 + f64::EPSILON, 1.0 + 2.0 * f64::EPSILON);
    let square = Fused::new(x) * Fused::new(x);
    assert_eq!((Fused::new(-known) + square).value(), f64::EPSILON.powi(2));
    assert_eq!((square - Fused::new(known)).value(), 0.0);
    assert_eq!(MulAdd::mul_add(x, x, -known), f64::EPSILON.powi(2));
}
