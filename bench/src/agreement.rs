//! Whether all candidates compute the same.

use serde::Serialize;

use crate::candidates::{Candidate, LANES, PRODUCT, REFERENCE};
use crate::points::Points;
use crate::subject::SUBJECTS;

const TOLERANCE: f64 = 1e-12;

/// Greatest difference of a candidate from the reference.
#[derive(Serialize)]
pub(crate) struct Agreement {
    pub(crate) function: &'static str,
    pub(crate) candidate: &'static str,
    /// Relative to the greater of the value and the root mean square of its component over the points:
    /// a component that happens to cancel is held to the accuracy of its summands.
    pub(crate) worst: f64,
}

/// Compares every candidate with the reference at every point.
///
/// # Errors
/// A difference that rounding does not explain.
pub(crate) fn check(
    candidates: &mut [Candidate],
    points: &[Points],
) -> Result<Vec<Agreement>, String> {
    let mut found = Vec::new();
    for (index, (subject, points)) in SUBJECTS.iter().zip(points).enumerate() {
        let values = |it: &mut Candidate| Ok((it.name, it.kernels[index].values(points)?));
        let all = candidates.iter_mut().map(values);
        let all: Vec<_> = all.collect::<Result<_, String>>()?;
        let Some((_, reference)) = all.iter().find(|(name, _)| *name == REFERENCE) else {
            continue;
        };
        same_bits(subject.title, &all)?;
        let scales = root_mean_squares(reference);
        for (candidate, values) in all.iter().filter(|(name, _)| *name != REFERENCE) {
            let worst = worst(values, reference, &scales);
            // Written so that NaN fails.
            if !worst.le(&TOLERANCE) {
                return Err(format!(
                    "error: {candidate} and {REFERENCE} differ by {worst:.1e} in {}",
                    subject.title
                ));
            }
            found.push(Agreement {
                function: subject.symbol,
                candidate,
                worst,
            });
        }
    }
    Ok(found)
}

/// Members side by side have the bits that they have alone.
fn same_bits(title: &str, all: &[(&str, Vec<Vec<f64>>)]) -> Result<(), String> {
    let bits = |name: &str| {
        let values = all.iter().find(|(it, _)| *it == name);
        let numbers = values
            .into_iter()
            .flat_map(|(_, values)| values.iter().flatten());
        numbers.map(|it| it.to_bits()).collect::<Vec<_>>()
    };
    if bits(PRODUCT) == bits(LANES) {
        return Ok(());
    }
    Err(format!("error: {LANES} and {PRODUCT} differ in {title}"))
}

fn root_mean_squares(values: &[Vec<f64>]) -> Vec<f64> {
    let mut sums = vec![0.0; values.first().map_or(0, Vec::len)];
    for point in values {
        for (sum, value) in sums.iter_mut().zip(point) {
            *sum += value * value;
        }
    }
    sums.iter()
        .map(|sum| (sum / values.len() as f64).sqrt())
        .collect()
}

fn worst(values: &[Vec<f64>], reference: &[Vec<f64>], scales: &[f64]) -> f64 {
    let mut worst = 0.0_f64;
    for (point, expected) in values.iter().zip(reference) {
        for ((value, expected), scale) in point.iter().zip(expected).zip(scales) {
            let difference = (value - expected).abs();
            if difference.is_nan() {
                return f64::NAN;
            }
            if difference > 0.0 {
                worst = worst.max(difference / expected.abs().max(*scale));
            }
        }
    }
    worst
}
