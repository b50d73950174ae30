//! Reference vectors: points drawn at random, and what functions are there, to 50 digits.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A value that a double cannot hold: the nearest double, the rest, and the measure of its sums.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Nearest double.
    pub high: f64,
    /// What is missing.
    pub low: f64,
    /// The same expression with every summand replaced by its absolute value.
    pub magnitude: f64,
}

/// A point and the values of all functions at it.
#[derive(Clone, Debug)]
pub struct Point {
    /// State, input, Wiener increments and parameters, such as `state.alpha`.
    pub inputs: BTreeMap<String, f64>,
    /// Function values, such as `jacobians.state.velocity.alpha`.
    pub outputs: BTreeMap<String, Reference>,
}

/// Reads a file of the oracle.
///
/// # Panics
/// When the file cannot be read or is not one: these are the tests' own files.
pub fn read_oracle(path: &Path) -> Vec<Point> {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines().skip(1);
    let header = lines.next().expect("a header");
    let (inputs, outputs) = header.split_once('|').expect("inputs|outputs");
    let inputs: Vec<&str> = inputs.split(',').collect();
    let outputs: Vec<&str> = outputs.split(',').collect();
    lines
        .map(|line| {
            let (left, right) = line.split_once('|').expect("inputs|outputs");
            let numbers = left.split(',').map(number);
            let references = right.split(',').map(|text| {
                let mut parts = text.split(';').map(number);
                let mut part = || parts.next().expect("high;low;magnitude");
                Reference {
                    high: part(),
                    low: part(),
                    magnitude: part(),
                }
            });
            Point {
                inputs: named(&inputs, numbers),
                outputs: named(&outputs, references),
            }
        })
        .collect()
}

/// Reads a file of CasADi's values: one map a point.
///
/// # Panics
/// When the file cannot be read or is not one.
pub fn read_casadi(path: &Path) -> Vec<BTreeMap<String, f64>> {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines().skip(1);
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| named(&names, line.split(',').map(number)))
        .collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|e| panic!("`{text}`: {e}"))
}

fn named<T>(names: &[&str], values: impl Iterator<Item = T>) -> BTreeMap<String, T> {
    let map: BTreeMap<String, T> = names.iter().map(ToString::to_string).zip(values).collect();
    assert_eq!(map.len(), names.len(), "a line with a value missing");
    map
}
