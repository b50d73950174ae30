//! The regulator against closed forms and SciPy.
#![forbid(unsafe_code)]

use ahv_analysis::lqr::{LqrError, Regulator, bryson};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::DMatrix;

/// Matrices A, B, Q, R and SciPy's X of one case.
type Case = [DMatrix<f64>; 5];

fn scipy() -> Vec<Case> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/vectors/riccati.txt"
    );
    let text = std::fs::read_to_string(path).expect("the vectors are there");
    let matrices: Vec<_> = text.lines().skip(1).map(matrix).collect();
    let cases = matrices
        .chunks_exact(5)
        .map(|case| case.to_vec().try_into().expect("five"));
    cases.collect()
}

fn of_rows(rows: &[&[f64]]) -> DMatrix<f64> {
    DMatrix::from_row_slice(rows.len(), rows[0].len(), &rows.concat())
}

fn matrix(line: &str) -> DMatrix<f64> {
    let mut fields = line.split(',').skip(1);
    let mut size = || {
        fields
            .next()
            .and_then(|field| field.parse().ok())
            .expect("a size")
    };
    let (rows, columns) = (size(), size());
    let values: Vec<f64> = fields
        .map(|field| field.parse().expect("a number"))
        .collect();
    DMatrix::from_row_slice(rows, columns, &values)
}

#[test]
fn a_double_integrator_has_the_closed_form() {
    let (a, b) = (
        of_rows(&[&[0.0, 1.0], &[0.0, 0.0]]),
        of_rows(&[&[0.0], &[1.0]]),
    );
    for (weight, effort) in [(1.0, 1.0), (9.0, 0.25)] {
        let q = of_rows(&[&[weight, 0.0], &[0.0, 0.0]]);
        let r = of_rows(&[&[effort]]);
        let regulator = Regulator::new(&a, &b, &q, &r).expect("a regulator");
        // K = [ω², √2 ω] with ω⁴ = q/r: damping 1/√2, whatever the weights.
        let omega = f64::powf(weight / effort, 0.25);
        let gain = of_rows(&[&[omega * omega, 2.0_f64.sqrt() * omega]]);
        assert_relative_eq!(regulator.gain, gain, max_relative = 1e-12);
        for pole in regulator.poles {
            assert_relative_eq!(pole.re, -omega / 2.0_f64.sqrt(), max_relative = 1e-12);
        }
    }
}

#[test]
fn a_scalar_system_has_the_closed_form() {
    for (a, b, q, r) in [
        (1.5, 2.0, 3.0, 0.5),
        (-0.2, 1e-3, 1e4, 1e-2),
        (0.0, 1.0, 1.0, 1.0),
    ] {
        let of = |value| of_rows(&[&[value]]);
        let regulator = Regulator::new(&of(a), &of(b), &of(q), &of(r)).expect("a regulator");
        let root = f64::sqrt(a * a + b * b * q / r);
        assert_relative_eq!(
            regulator.cost[0],
            (a + root) * r / (b * b),
            max_relative = 1e-12
        );
        assert_relative_eq!(regulator.poles[0].re, -root, max_relative = 1e-12);
    }
}

#[test]
fn a_multiple_pole_is_no_harm() {
    // q chosen so that both poles of the double integrator are −1.
    let (a, b) = (
        of_rows(&[&[0.0, 1.0], &[0.0, 0.0]]),
        of_rows(&[&[0.0], &[1.0]]),
    );
    let q = of_rows(&[&[1.0, 0.0], &[0.0, 2.0]]);
    let regulator = Regulator::new(&a, &b, &q, &of_rows(&[&[1.0]])).expect("a regulator");
    assert_relative_eq!(
        regulator.gain,
        of_rows(&[&[1.0, 2.0]]),
        max_relative = 1e-12
    );
}

#[test]
fn costs_are_scipys() {
    let cases = scipy();
    assert_eq!(cases.len(), 5);
    for [a, b, q, r, x] in cases {
        let regulator = Regulator::new(&a, &b, &q, &r).expect("a regulator");
        // Entry by entry, for the states' units differ.
        let sizes = x.diagonal().map(f64::sqrt);
        let difference = (&regulator.cost - &x).component_div(&(&sizes * sizes.transpose()));
        assert_abs_diff_eq!(difference.amax(), 0.0, epsilon = 1e-9);
        assert!(regulator.residual < 1e-11, "{}", regulator.residual);
        let gain = r.clone().try_inverse().expect("R") * b.transpose() * &x;
        let stable = (&a - &b * gain).complex_eigenvalues();
        let rightmost = stable
            .iter()
            .map(|pole| pole.re)
            .fold(f64::NEG_INFINITY, f64::max);
        assert_relative_eq!(regulator.poles[0].re, rightmost, max_relative = 1e-8);
    }
}

#[test]
fn brysons_rule_squares_deviations() {
    assert_eq!(
        bryson(&[2.0, 0.5, f64::INFINITY]),
        of_rows(&[&[0.25, 0.0, 0.0], &[0.0, 4.0, 0.0], &[0.0, 0.0, 0.0]])
    );
}

#[test]
fn what_no_input_moves_is_refused_unless_it_decays() {
    let (b, q, r) = (
        of_rows(&[&[0.0], &[1.0]]),
        DMatrix::identity(2, 2),
        of_rows(&[&[1.0]]),
    );
    let unreachable = |mode| of_rows(&[&[mode, 0.0], &[1.0, 1.0]]);
    match Regulator::new(&unreachable(0.5), &b, &q, &r) {
        Err(LqrError::NotStabilizable { real, imaginary }) => {
            assert_relative_eq!(real, 0.5, max_relative = 1e-12);
            assert_eq!(imaginary, 0.0);
        }
        other => panic!("{other:?}"),
    }
    let marginal = Regulator::new(&unreachable(0.0), &b, &q, &r);
    assert!(
        matches!(marginal, Err(LqrError::NotStabilizable { .. })),
        "{marginal:?}"
    );
    let decaying = Regulator::new(&unreachable(-0.5), &b, &q, &r).expect("a regulator");
    assert_relative_eq!(decaying.poles[0].re, -0.5, max_relative = 1e-12);
}

#[test]
fn what_no_weight_sees_is_refused_unless_it_decays() {
    let (b, r) = (of_rows(&[&[1.0], &[1.0]]), of_rows(&[&[1.0]]));
    let q = of_rows(&[&[1.0, 0.0], &[0.0, 0.0]]);
    let of = |mode| of_rows(&[&[1.0, 0.0], &[0.0, mode]]);
    let refused = Regulator::new(&of(0.25), &b, &q, &r);
    assert!(
        matches!(refused, Err(LqrError::NotDetectable { real: 0.25, .. })),
        "{refused:?}"
    );
    assert!(Regulator::new(&of(-0.25), &b, &q, &r).is_ok());
}

/// A mass whose speed alone has a weight: v' = u and K = 1; its position moves on.
#[test]
fn a_position_without_weight_has_no_gain() {
    let a = of_rows(&[&[0.0, 1.0], &[0.0, 0.0]]);
    let (b, r) = (of_rows(&[&[0.0], &[1.0]]), of_rows(&[&[1.0]]));
    let q = of_rows(&[&[0.0, 0.0], &[0.0, 1.0]]);
    let regulator = Regulator::new(&a, &b, &q, &r).expect("a regulator");
    assert_eq!(regulator.gain[(0, 0)], 0.0);
    assert_relative_eq!(regulator.gain[(0, 1)], 1.0, max_relative = 1e-12);
    assert_eq!(regulator.poles[0].re, 0.0);
    assert_relative_eq!(regulator.poles[1].re, -1.0, max_relative = 1e-12);
    let cost = of_rows(&[&[0.0, 0.0], &[0.0, 1.0]]);
    assert_relative_eq!(regulator.cost, cost, epsilon = 1e-12);
}

#[test]
fn what_is_no_problem_is_refused() {
    let (a, b) = (
        of_rows(&[&[0.0, 1.0], &[0.0, 0.0]]),
        of_rows(&[&[0.0], &[1.0]]),
    );
    let (q, r) = (DMatrix::identity(2, 2), of_rows(&[&[1.0]]));
    let wide = of_rows(&[&[0.0, 1.0]]);
    assert!(matches!(
        Regulator::new(&a, &wide, &q, &r),
        Err(LqrError::Shape { name: "B", .. })
    ));
    let hole = of_rows(&[&[0.0, f64::NAN], &[0.0, 0.0]]);
    assert_eq!(
        Regulator::new(&hole, &b, &q, &r),
        Err(LqrError::NonFinite { name: "A" })
    );
    for (q, r, at_fault) in [
        (-&q, r.clone(), "Q"),
        (of_rows(&[&[1.0, 1.0], &[0.0, 1.0]]), r.clone(), "Q"),
        (q.clone(), of_rows(&[&[0.0]]), "R"),
    ] {
        let refused = Regulator::new(&a, &b, &q, &r);
        assert!(
            matches!(refused, Err(LqrError::Weight { name, .. }) if name == at_fault),
            "{refused:?}"
        );
    }
}
