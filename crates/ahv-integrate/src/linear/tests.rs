//! The sparse elimination against a dense one with complete exchanges.

extern crate std;

use std::boxed::Box;

use ahv_core::{Bounds, DifferentiableModel, Pattern, Vector};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};
use nalgebra::{DMatrix, DVector};

use super::{Elimination, Factors};

#[path = "../../tests/common/random.rs"]
mod random;

use random::Random;

/// Greatest residual in units of what its summands are large.
fn residual(matrix: &DMatrix<f64>, x: &DVector<f64>, right: &DVector<f64>) -> f64 {
    let sizes = matrix.abs() * x.abs() + right.abs();
    (matrix * x - right).abs().component_div(&sizes).max()
}

/// Greatest residual of the solutions with 1/(γh) · 1 − ∂f/∂x, and greatest distance from the dense solutions, whose
/// components are of size 1: from all over the box, for steps from 1 µs to 1 s.
fn errors<M, B, U>(model: &M, states: &B, inputs: &U, pattern: Pattern<2>) -> [f64; 2]
where
    M: DifferentiableModel<Scalar = f64>,
    B: Vector<Bounds>,
    U: Vector<Bounds>,
{
    let length = M::State::LEN;
    let elimination = Box::leak(Box::new(Elimination::of(&pattern, length)));
    let mut random = Random(7);
    let mut worst = [0.0_f64; 2];
    for _ in 0..1000 {
        let (x, u) = (random.within(states), random.within(inputs));
        let step = 10.0_f64.powf(-6.0 * random.unit());
        let (_, jacobian, _) = model.drift_and_jacobians(&x, &u);
        let dense = DMatrix::from_fn(length, length, |i, j| {
            let entry = jacobian.get(i).and_then(|row| row.get(j));
            let shift = if i == j { 4.0 / step } else { 0.0 };
            shift - entry.expect("a square matrix")
        });
        let right = &dense * DVector::from_fn(length, |_, _| 2.0 * random.unit() - 1.0);
        let factors = Factors::of_shifted(4.0 / step, &jacobian, elimination);
        let solved = factors.solve(&M::State::from_fn(|index| right[index]));
        let solved = DVector::from_fn(length, |i, _| solved.get(i).expect("a component"));
        let reference = dense.clone().full_piv_lu().solve(&right);
        let reference = reference.expect("the matrix is regular");
        worst = [
            worst[0].max(residual(&dense, &solved, &right)),
            worst[1].max((solved - reference).abs().max()),
        ];
    }
    worst
}

/// The same for a generated model, with a pattern or with its own.
macro_rules! errors_of {
    ($model:ident) => {
        errors_of!($model, $model::STATE_JACOBIAN_PATTERN)
    };
    ($model:ident, $pattern:expr) => {
        errors(
            &$model::Model::new(&$model::NOMINAL),
            &$model::STATE_BOUNDS,
            &$model::INPUT_BOUNDS,
            $pattern,
        )
    };
}

#[test]
fn solutions_are_those_of_a_dense_elimination_to_rounding() {
    for (name, [residual, distance]) in [
        ("com", errors_of!(com)),
        ("com_rigid", errors_of!(com_rigid)),
        ("dcom", errors_of!(dcom)),
        ("sdcom", errors_of!(sdcom)),
        ("sdcom_gust", errors_of!(sdcom_gust)),
        ("sdcom_printed", errors_of!(sdcom_printed)),
    ] {
        std::println!("{name}: residual {residual:.1e}, distance {distance:.1e}");
        assert!(residual < 1e-13, "{name}: {residual:e}");
        assert!(distance < 1e-11, "{name}: {distance:e}");
    }
}

#[test]
fn an_entry_that_the_pattern_lacks_shows_in_the_solution() {
    // Without the last row's stiffness and damping.
    const AT: &[[usize; 2]] = dcom::STATE_JACOBIAN_PATTERN.at;
    const LESS: &[[usize; 2]] = AT.split_at(AT.len() - 2).0;
    let pattern = Pattern::new(dcom::STATE_JACOBIAN_PATTERN.shape, LESS);
    let [residual, _] = errors_of!(dcom, pattern);
    assert!(residual > 1e-3, "{residual:e}");
}

/// Counted by hand for an arrow: from the tip it costs 9 products and fills in, from the shaft it costs 3.
#[test]
fn the_order_of_elimination_avoids_fill_in() {
    const ARROW: [[usize; 2]; 10] = [
        [0, 0],
        [0, 1],
        [0, 2],
        [0, 3],
        [1, 0],
        [1, 1],
        [2, 0],
        [2, 2],
        [3, 0],
        [3, 3],
    ];
    let elimination = Elimination::of(&Pattern::new([4, 4], &ARROW), 4);
    let products =
        |elimination: &Elimination| -> u32 { elimination.pivots().map(super::products).sum() };
    assert_eq!(products(&elimination), 3);
    // What docs/integrators.md says; without zeros it is 10² + 9² + … = 385.
    let elimination = Elimination::of(&dcom::STATE_JACOBIAN_PATTERN, 11);
    assert_eq!(products(&elimination), 58);
}

#[test]
fn a_singular_matrix_has_no_finite_solution() {
    static ELIMINATION: Elimination = Elimination::of(&dcom::STATE_JACOBIAN_PATTERN, 11);
    let zero = dcom::State::splat(dcom::State::splat(0.0));
    let factors = Factors::of_shifted(0.0, &zero, &ELIMINATION);
    let solved = factors.solve(&dcom::State::splat(1.0));
    assert!(solved.find(|x: f64| !x.is_finite()).is_some());
}
