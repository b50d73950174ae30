//! Every generated function against the oracle (SymPy, mpmath at 50 digits) and against CasADi.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use ahv_tests::evaluate::{MODELS, evaluate};
use ahv_tests::measure::{Worst, compare, error};
use ahv_tests::vectors::{Point, read_casadi, read_oracle};

/// In units of 2⁻⁵²·K.
const BAR: f64 = 8.0;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors")
}

fn points(model: &str) -> Vec<Point> {
    let points = read_oracle(&folder().join(format!("{model}.sympy.txt")));
    assert!(points.len() >= 30, "only {} points", points.len());
    points
}

#[test]
fn generated_functions_match_the_oracle() {
    for (model, _) in MODELS {
        let mut worst: BTreeMap<String, Worst> = BTreeMap::new();
        for point in points(model) {
            compare(&point, &evaluate::<f64>(model, &point.inputs), &mut worst);
        }
        for (function, found) in &worst {
            println!("{model}::{function}: {:.2} at {}", found.error, found.label);
            assert!(
                found.error <= BAR,
                "{model}::{function}: {} at {:?}",
                found.error,
                found.point
            );
        }
    }
}

#[test]
fn generated_functions_match_casadi() {
    for (model, _) in MODELS {
        let casadi = read_casadi(&folder().join(format!("{model}.casadi.txt")));
        let points = points(model);
        assert_eq!(casadi.len(), points.len());
        for (point, values) in points.iter().zip(&casadi) {
            let ours = evaluate::<f64>(model, &point.inputs);
            for (label, &value) in values {
                let reference = point.outputs[label];
                let own = error(value, reference);
                assert!(
                    own <= BAR,
                    "CasADi's {model} {label} is {own} away from the oracle"
                );
                if reference.high.is_nan() {
                    continue; // outside the domain
                }
                let apart = (ours[label] - value).abs();
                let allowed = 2.0 * BAR * f64::EPSILON * reference.magnitude;
                assert!(
                    apart <= allowed,
                    "{model} {label}: {} against CasADi's {value}",
                    ours[label]
                );
            }
        }
    }
}

/// In single precision the rounding of the inputs is the same for both sides.
#[test]
fn single_precision_agrees_with_double() {
    for (model, _) in MODELS {
        for point in points(model) {
            let rounded: BTreeMap<String, f64> = point
                .inputs
                .iter()
                .map(|(k, &v)| (k.clone(), f64::from(v as f32)))
                .collect();
            let (single, double) = (
                evaluate::<f32>(model, &rounded),
                evaluate::<f64>(model, &rounded),
            );
            for (label, reference) in &point.outputs {
                let apart = (single[label] - double[label]).abs();
                // The exponent of the density amplifies a rounding by up to 8.
                let allowed = 64.0 * f64::from(f32::EPSILON) * reference.magnitude + 1e-30;
                assert!(
                    apart <= allowed || reference.high.is_nan(),
                    "{model} {label}: {} against {}",
                    single[label],
                    double[label]
                );
            }
        }
    }
}

/// The vectors hold every function that the models have.
#[test]
fn no_generated_function_is_left_out() {
    for (model, _) in MODELS {
        let point = points(model).remove(0);
        let first = |label: &String| label.split('.').next().unwrap_or_default().to_owned();
        let tested: BTreeSet<String> = point.outputs.keys().map(first).collect();
        // A function that is zero all over has no entries: additive noise has no L^j b^k.
        let evaluated = evaluate::<f64>(model, &point.inputs);
        let evaluated = evaluated
            .iter()
            .filter(|(label, value)| **value != 0.0 || point.outputs.contains_key(*label));
        let evaluated: BTreeSet<String> = evaluated.map(|(label, _)| first(label)).collect();
        assert_eq!(tested, evaluated, "vectors of {model}");
    }
}

/// A test that cannot fail proves nothing.
#[test]
fn a_perturbed_coefficient_is_seen() {
    let point = points("dcom").remove(0);
    let mut perturbed = point.inputs.clone();
    *perturbed.get_mut("parameter.c_l_alpha").unwrap() *= 1.0 + 1e-9;
    let values = evaluate::<f64>("dcom", &perturbed);
    assert!(error(values["drift.gamma"], point.outputs["drift.gamma"]) > BAR);
}
