//! Poles at the trims against values that were computed independently of this project.
#![forbid(unsafe_code)]

use ahv_analysis::trim::{LevelFlight, trim};
use ahv_core::{DifferentiableModel, Vector};
use ahv_models::{com_rigid, dcom};
use approx::assert_abs_diff_eq;
use nalgebra::{Complex, DMatrix};

/// Eigenvalues of ∂f/∂x at level flight, by real part, then imaginary part.
fn poles<M: DifferentiableModel<Scalar = f64>>(model: &M) -> Vec<Complex<f64>> {
    let trim = trim(model, &LevelFlight::new(7702.0808, 85_000.0)).expect("the model trims");
    let (jacobian, _) = model.jacobians(&trim.state, &trim.input);
    let entry = |row, column| jacobian.get(row).and_then(|it: M::State| it.get(column));
    let matrix = DMatrix::from_fn(M::State::LEN, M::State::LEN, |row, column| {
        entry(row, column).expect("a square matrix")
    });
    let mut poles: Vec<_> = matrix.complex_eigenvalues().iter().copied().collect();
    poles.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
    poles
}

/// The fastest real poles, stable and unstable.
fn short_period(poles: &[Complex<f64>]) -> (f64, f64) {
    let real = poles.iter().filter(|pole| pole.im == 0.0).map(|p| p.re);
    real.fold((0.0, 0.0), |(low, high), pole| {
        (low.min(pole), high.max(pole))
    })
}

#[test]
fn the_rigid_com_has_the_recomputed_short_period() {
    let poles = poles(&com_rigid::Model::new(&com_rigid::NOMINAL));
    let (stable, unstable) = short_period(&poles);
    assert_abs_diff_eq!(stable, -1.764, epsilon = 6e-4);
    assert_abs_diff_eq!(unstable, 1.694, epsilon = 6e-4);
}

#[test]
fn section_5_3_has_the_recomputed_poles() {
    let poles = poles(&dcom::Model::new(&dcom::SECTION5_3));
    let (stable, unstable) = short_period(&poles);
    // Table 3 prints -3.97 and +3.86.
    assert_abs_diff_eq!(stable, -3.9694, epsilon = 6e-5);
    assert_abs_diff_eq!(unstable, 3.8612, epsilon = 6e-5);
    for (real, imaginary) in [(-0.41, 20.5), (-1.05, 52.5), (-2.10, 105.0)] {
        let near = |pole: &&Complex<f64>| (pole.im - imaginary).abs() < 0.1;
        let pole = poles.iter().find(near).expect("a flexible pair");
        assert_abs_diff_eq!(pole.re, real, epsilon = 0.01);
    }
}

#[test]
fn inertia_does_most_of_the_short_period_of_section_5_3() {
    let (heavy, light) = (dcom::NOMINAL, dcom::SECTION5_3);
    for (m, i_yy, stable, unstable) in [
        (heavy.m, light.i_yy, -4.134, 4.065),
        (heavy.m, heavy.i_yy, -1.742, 1.673),
    ] {
        let parameters = dcom::Parameters { m, i_yy, ..light };
        let found = short_period(&poles(&dcom::Model::new(&parameters)));
        assert_abs_diff_eq!(found.0, stable, epsilon = 6e-4);
        assert_abs_diff_eq!(found.1, unstable, epsilon = 6e-4);
    }
}
