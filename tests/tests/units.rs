//! The International System: a model that is given parameters, state and input in SI answers in SI.

use std::path::Path;

use ahv_core::{DifferentiableModel, Vector};
use ahv_tests::evaluate::vector;
use ahv_tests::vectors::{Point, read_oracle};

/// Rounding of the factors and of the evaluation, relative to the size of the terms.
const BAR: f64 = 1e-13;

/// Points of each model.
const POINTS: usize = 6;

fn points(model: &str) -> Vec<Point> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors");
    let mut points = read_oracle(&folder.join(format!("{model}.sympy.txt")));
    points.truncate(POINTS);
    points
}

/// A vector with every component in its SI unit.
fn in_si<V: Vector<f64>>(of: V) -> V {
    V::from_fn(|i| of.get(i).unwrap() * V::SI_FACTORS[i])
}

/// Holds a value against that of the other system. `size` is that of the terms it is the sum of.
fn close(label: &str, value: f64, factor: f64, in_si: f64, size: f64) {
    let (expected, size) = (value * factor, size * factor);
    assert!(
        (in_si - expected).abs() <= BAR * size.max(expected.abs()),
        "{label}: {in_si} in SI, but {expected} converted"
    );
}

/// What an entry is the sum of, by the oracle; an entry that the oracle does not list is a structural zero.
fn size(point: &Point, label: &str) -> f64 {
    point.outputs.get(label).map_or(0.0, |it| it.magnitude)
}

fn check_drift<M: DifferentiableModel<Scalar = f64>>(point: &Point, ours: &M, theirs: &M) {
    let x: M::State = vector("state", &point.inputs);
    let u: M::Input = vector("input", &point.inputs);
    let (y, v) = (in_si(x), in_si(u));
    let (drift, converted) = (ours.drift(&x, &u), theirs.drift(&y, &v));
    let (a, b) = ours.jacobians(&x, &u);
    let (c, d) = theirs.jacobians(&y, &v);
    for (i, row) in M::State::NAMES.iter().enumerate() {
        let by = M::State::SI_FACTORS[i];
        let label = format!("drift.{row}");
        close(
            &label,
            drift.get(i).unwrap(),
            by,
            converted.get(i).unwrap(),
            size(point, &label),
        );
        for (j, column) in M::State::NAMES.iter().enumerate() {
            let label = format!("jacobians.state.{row}.{column}");
            let (slope, other) = (
                a.get(i).unwrap().get(j).unwrap(),
                c.get(i).unwrap().get(j).unwrap(),
            );
            close(
                &label,
                slope,
                by / M::State::SI_FACTORS[j],
                other,
                size(point, &label),
            );
        }
        for (j, column) in M::Input::NAMES.iter().enumerate() {
            let label = format!("jacobians.input.{row}.{column}");
            let (slope, other) = (
                b.get(i).unwrap().get(j).unwrap(),
                d.get(i).unwrap().get(j).unwrap(),
            );
            close(
                &label,
                slope,
                by / M::Input::SI_FACTORS[j],
                other,
                size(point, &label),
            );
        }
    }
}

/// Entries of the diffusion are rates times the root of a second, which no system changes.
fn check_diffusion<S: Vector<f64>, N: Vector<f64>>(
    point: &Point,
    ours: &impl Vector<N>,
    theirs: &impl Vector<N>,
) {
    for (i, row) in S::NAMES.iter().enumerate() {
        let (g, h) = (ours.get(i).unwrap(), theirs.get(i).unwrap());
        for (j, column) in N::NAMES.iter().enumerate() {
            let label = format!("diffusion.{row}.{column}");
            let (entry, other) = (g.get(j).unwrap(), h.get(j).unwrap());
            close(&label, entry, S::SI_FACTORS[i], other, size(point, &label));
        }
    }
}

macro_rules! check_model {
    ($model:ident $(, $diffusion:ident)?) => {
        #[test]
        fn $model() {
            use ahv_models::$model as model;
            for point in points(stringify!($model)) {
                let parameters: model::Parameters<f64> = vector("parameter", &point.inputs);
                let (ours, theirs) = (parameters, in_si(parameters));
                check_drift(&point, &model::Model::new(&ours), &model::Model::new(&theirs));
                $({
                    let x: model::State<f64> = vector("state", &point.inputs);
                    let u: model::Input<f64> = vector("input", &point.inputs);
                    let ours = model::$diffusion(&x, &u, &model::prepare(&ours));
                    let theirs = model::$diffusion(&in_si(x), &in_si(u), &model::prepare(&theirs));
                    check_diffusion::<model::State<f64>, model::Noise<f64>>(&point, &ours, &theirs);
                })?
            }
        }
    };
}

check_model!(com);
check_model!(com_rigid);
check_model!(dcom, diffusion);
check_model!(sdcom, diffusion);
check_model!(sdcom_printed, diffusion);
check_model!(sdcom_gust, diffusion);
check_model!(flexible_mode, diffusion);

/// The factors are the exact ones of foot and pound-force.
#[test]
fn factors_are_exact() {
    type State = ahv_models::dcom::State<f64>;
    type Parameters = ahv_models::dcom::Parameters<f64>;
    assert_eq!(State::UNITS[..3], ["ft/s", "ft", "rad"]);
    assert_eq!(State::SI_UNITS[..3], ["m/s", "m", "rad"]);
    assert_eq!(State::SI_FACTORS[..3], [0.3048, 0.3048, 1.0]);
    let inertia = <Parameters as Vector<f64>>::index_of("i_yy").unwrap();
    assert_eq!(Parameters::SI_UNITS[inertia], "kg*m");
    assert_eq!(Parameters::SI_FACTORS[inertia], 4.448_221_615_260_5);
}
