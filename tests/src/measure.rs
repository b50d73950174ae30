//! The audited error: |error| / (2⁻⁵²·K), K being the expression with every summand replaced by its absolute value.

use std::collections::BTreeMap;

use crate::vectors::{Point, Reference};

/// The worst that was seen of one function.
#[derive(Clone, Debug, Default)]
pub struct Worst {
    /// Its error in the measure.
    pub error: f64,
    /// The entry at which it occurred.
    pub label: String,
    /// The point at which it occurred.
    pub point: BTreeMap<String, f64>,
}

/// The error of a value in units of 2⁻⁵²·K; infinite where a value is not finite, or not zero where K is.
///
/// Outside a function's domain the reference is NaN, and any value will do.
pub fn error(value: f64, reference: Reference) -> f64 {
    if reference.high.is_nan() {
        return 0.0;
    }
    let difference = ((value - reference.high) - reference.low).abs();
    if difference == 0.0 {
        0.0
    } else if difference.is_nan() || reference.magnitude == 0.0 {
        f64::INFINITY
    } else {
        difference / (f64::EPSILON * reference.magnitude)
    }
}

/// Compares values with a point's references and keeps the worst error of each function.
///
/// # Panics
/// When an output of the reference has no value, or a value without a reference is not a structural zero.
pub fn compare(point: &Point, values: &BTreeMap<String, f64>, worst: &mut BTreeMap<String, Worst>) {
    for (label, &value) in values {
        if !point.outputs.contains_key(label) {
            assert!(
                value == 0.0,
                "{label} is {value}, but the oracle has no such entry"
            );
        }
    }
    for (label, &reference) in &point.outputs {
        let value = values
            .get(label)
            .unwrap_or_else(|| panic!("no generated value for {label}"));
        let function = label.split('.').next().unwrap_or(label);
        let found = worst.entry(function.to_owned()).or_default();
        let error = error(*value, reference);
        if error >= found.error {
            *found = Worst {
                error,
                label: label.clone(),
                point: point.inputs.clone(),
            };
        }
    }
}
