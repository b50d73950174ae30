//! Generated Jacobians against central differences of sixth order of the generated drift.

use ahv_core::{DifferentiableModel, Model, Vector};
use ahv_tests::evaluate::vector;
use ahv_tests::vectors::{Point, read_oracle};
use std::path::Path;

/// Truncation and rounding of the differences together stay below this part of the column's scale.
const BAR: f64 = 2e-9;

/// f'(0) from six values of f around 0.
fn sixth_order(f: impl Fn(f64) -> f64, step: f64) -> f64 {
    let difference = |k: f64| f(k * step) - f(-k * step);
    (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * step)
}

/// A step that balances truncation and rounding for a component of this size.
fn step(value: f64) -> f64 {
    2e-3 * value.abs().max(1.0)
}

fn check<M, const N: usize>(name: &str, model: &M, x: M::State, u: M::Input)
where
    M: DifferentiableModel<Scalar = f64>,
{
    let (by_state, by_input) = model.jacobians(&x, &u);
    let row = |y: &M::State, r: usize| y.get(r).unwrap();
    for r in 0..N {
        let scale = |terms: &mut dyn Iterator<Item = (f64, f64)>| {
            terms.map(|(slope, size)| (slope * size).abs()).sum::<f64>()
                + row(&model.drift(&x, &u), r).abs()
        };
        let state_row = by_state.get(r).unwrap();
        let input_row = by_input.get(r).unwrap();
        for c in 0..M::State::LEN {
            let (exact, at) = (state_row.get(c).unwrap(), x.get(c).unwrap());
            let moved = |d: f64| {
                let mut y = x;
                y.set(c, at + d).unwrap();
                row(&model.drift(&y, &u), r)
            };
            let h = step(at);
            let allowed =
                BAR * scale(&mut [(exact, at.abs().max(1.0))].into_iter()) / at.abs().max(1.0);
            let found = sixth_order(moved, h);
            assert!(
                (found - exact).abs() <= allowed + 1e-300,
                "{name}: d {}/d {}: {exact} against {found} by differences",
                M::State::NAMES[r],
                M::State::NAMES[c]
            );
        }
        for c in 0..M::Input::LEN {
            let (exact, at) = (input_row.get(c).unwrap(), u.get(c).unwrap());
            let moved = |d: f64| {
                let mut v = u;
                v.set(c, at + d).unwrap();
                row(&model.drift(&x, &v), r)
            };
            let found = sixth_order(moved, step(at));
            let allowed = BAR * scale(&mut [(exact, 1.0)].into_iter());
            assert!(
                (found - exact).abs() <= allowed + 1e-300,
                "{name}: d {}/d {}: {exact} against {found} by differences",
                M::State::NAMES[r],
                M::Input::NAMES[c]
            );
        }
    }
}

fn points(model: &str) -> Vec<Point> {
    read_oracle(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("vectors/{model}.sympy.txt")))
}

macro_rules! check_model {
    ($model:ident, $states:literal) => {
        for point in points(stringify!($model)) {
            let model = ahv_models::$model::Model::new(&vector("parameter", &point.inputs));
            let (x, u) = (
                vector("state", &point.inputs),
                vector("input", &point.inputs),
            );
            check::<_, $states>(stringify!($model), &model, x, u);
        }
    };
}

#[test]
fn com_jacobians_match_differences() {
    check_model!(com, 5);
}

#[test]
fn dcom_jacobians_match_differences() {
    check_model!(dcom, 11);
}

#[test]
fn sdcom_jacobians_match_differences() {
    check_model!(sdcom, 8);
}

/// The differences themselves are right: a wrong slope is seen.
#[test]
fn differences_are_of_sixth_order() {
    let errors: Vec<f64> = [0.2, 0.1]
        .map(|h| (sixth_order(|d| (1.0 + d).exp(), h) - 1f64.exp()).abs())
        .to_vec();
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 6.0).abs() < 0.1, "order {order}");
    assert_eq!(ahv_models::dcom::State::<f64>::LEN, 11);
    let _ = <ahv_models::dcom::Model<f64> as Model>::drift;
}
