//! Margins against closed forms, the promise of every regulator, and the poles of loops that are pushed over them.
#![forbid(unsafe_code)]

use ahv_analysis::lqr::{Regulator, bryson};
use ahv_analysis::margins::{Margin, MarginError, margins};
use approx::assert_relative_eq;
use nalgebra::{Complex, DMatrix};

/// s (s + 1) (s + 2) below a gain.
fn three_poles(k: f64) -> [DMatrix<f64>; 3] {
    [
        DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -2.0, -3.0]),
        DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 1.0]),
        DMatrix::from_row_slice(1, 3, &[k, 0.0, 0.0]),
    ]
}

#[test]
fn three_poles_have_the_closed_form() {
    for k in [0.5, 2.0, 5.5] {
        let [a, b, gain] = three_poles(k);
        let [
            Margin {
                least_gain,
                most_gain,
                phase,
            },
        ] = margins(&a, &b, &gain).expect("stable")[..]
        else {
            panic!("one input")
        };
        // Routh: k < 6, at ω = √2.
        assert_eq!(least_gain, None);
        assert_relative_eq!(most_gain.expect("a bound"), 6.0 / k, max_relative = 1e-9);
        // |L| = 1: w (w + 1) (w + 4) = k² with w = ω², by bisection.
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let w = 0.5 * (low + high);
            if w * (w + 1.0) * (w + 4.0) < k * k {
                low = w
            } else {
                high = w
            }
        }
        let omega = f64::sqrt(low);
        let expected = 90.0_f64.to_radians() - omega.atan() - (omega / 2.0).atan();
        assert_relative_eq!(phase.expect("a crossing"), expected, max_relative = 1e-7);
    }
    let [a, b, gain] = three_poles(6.5);
    assert!(
        matches!(margins(&a, &b, &gain), Err(MarginError::Unstable { real, .. }) if real > 0.0)
    );
    assert_eq!(
        margins(&a, &b, &DMatrix::identity(1, 1)),
        Err(MarginError::Size)
    );
}

/// Plants with two inputs and numbers of all sizes, as vehicles have.
fn plants() -> Vec<[DMatrix<f64>; 2]> {
    let mut state = 5_u64;
    let mut number = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    };
    let mut plants = Vec::new();
    for n in (2..10).chain(2..10) {
        let scale = |i: usize| [1.0, 1e-3, 200.0][i % 3];
        let a = DMatrix::from_fn(n, n, |i, j| 3.0 * number() * scale(i) / scale(j));
        let b = DMatrix::from_fn(n, 2, |i, _| number() * scale(i));
        plants.push([a, b]);
    }
    plants
}

/// Anderson and Moore: a regulator with a diagonal R stands half the gain, any larger one, and 60° at each input.
#[test]
fn regulators_keep_their_promise() {
    for [a, b] in plants() {
        let n = a.nrows();
        let scale: Vec<f64> = (0..n).map(|i| [1.0, 1e-3, 200.0][i % 3]).collect();
        let regulator = Regulator::new(&a, &b, &bryson(&scale), &bryson(&[1.0, 1.0])).expect("one");
        for margin in margins(&a, &b, &regulator.gain).expect("stable") {
            assert_eq!(margin.most_gain, None, "{margin:?}");
            assert!(
                margin.least_gain.is_none_or(|it| it < 0.5 + 1e-9),
                "{margin:?}"
            );
            assert!(
                margin
                    .phase
                    .is_none_or(|it| it > 60.0_f64.to_radians() - 1e-9),
                "{margin:?}"
            );
        }
    }
}

/// A gain or a delay just inside a margin is stable, and just outside it is not.
#[test]
fn a_loop_that_is_pushed_over_its_margin_is_unstable() {
    let mut pushed = [0; 2];
    for [a, b] in plants() {
        let n = a.nrows();
        let scale: Vec<f64> = (0..n).map(|i| [1.0, 1e-3, 200.0][i % 3]).collect();
        let designed = Regulator::new(&a, &b, &bryson(&scale), &bryson(&[1.0, 1.0])).expect("one");
        // Another plant than that of the gains.
        let a = DMatrix::from_fn(n, n, |i, j| {
            a[(i, j)] * (1.0 + 0.02 * ((i * n + j) as f64).sin())
        });
        let Ok(found) = margins(&a, &b, &designed.gain) else {
            continue;
        };
        for (input, margin) in found.into_iter().enumerate() {
            let rightmost = |factor: Complex<f64>| {
                let mut gain = designed.gain.map(Complex::from);
                gain.row_mut(input).iter_mut().for_each(|it| *it *= factor);
                let closed = a.map(Complex::from) - b.map(Complex::from) * gain;
                let poles = closed.schur().eigenvalues().expect("triangular");
                poles
                    .iter()
                    .map(|it| it.re)
                    .fold(f64::NEG_INFINITY, f64::max)
            };
            for (bound, inside) in [(margin.least_gain, 1.001), (margin.most_gain, 0.999)] {
                let Some(bound) = bound else { continue };
                assert!(rightmost(Complex::from(bound * inside)) < 0.0, "{margin:?}");
                assert!(rightmost(Complex::from(bound / inside)) > 0.0, "{margin:?}");
                pushed[0] += 1;
            }
            // A turn of all frequencies, up or down: one of them meets the crossing.
            if let Some(phase) = margin.phase {
                let turned_by = |angle: f64| rightmost(Complex::new(angle.cos(), angle.sin()));
                let turned = |by: f64| [1.0, -1.0].map(|sign| turned_by(sign * by * phase));
                assert!(turned(0.999).iter().all(|it| *it < 0.0), "{margin:?}");
                assert!(turned(1.001).iter().any(|it| *it > 0.0), "{margin:?}");
                pushed[1] += 1;
            }
        }
    }
    assert!(pushed.iter().all(|count| *count > 5), "{pushed:?}");
}
