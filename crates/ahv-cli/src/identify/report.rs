//! What `ahv identify` says and draws.

use std::fmt::Write as _;

use ahv_identify::Parameter;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};
use serde::Serialize;

use super::Outcome;
use crate::failure::{Failure, print};
use crate::number::{Shown, fixed};
use crate::output::{self, readable};
use crate::vehicle::Heading;

/// Correlation from which two estimates are named.
const STRONG: f64 = 0.9;
/// Probability below which residuals are called coloured.
const COLOURED: f64 = 0.01;
/// Panels in a row.
const COLUMNS: usize = 2;

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    method: &'static str,
    samples: usize,
    segments: usize,
    iterations: usize,
    log_likelihood: f64,
    parameters: Vec<JsonParameter>,
    correlations: Vec<Vec<f64>>,
    outputs: Vec<JsonOutput>,
}

#[derive(Serialize)]
struct JsonParameter {
    name: &'static str,
    unit: &'static str,
    start: f64,
    value: f64,
    standard_error: f64,
    white_error: f64,
}

#[derive(Serialize)]
struct JsonOutput {
    name: &'static str,
    unit: &'static str,
    noise: f64,
    whiteness_statistic: f64,
    whiteness_lags: usize,
    whiteness_p: f64,
}

impl Outcome<'_> {
    pub(super) fn print(&self, json: bool) -> Result<(), Failure> {
        match json {
            true => output::print_json(&self.json()),
            false => print(&self.text()),
        }
    }

    fn parameter(&self, it: &Parameter) -> JsonParameter {
        let labels = self.vehicle.units.labels(self.vehicle.model.parameters());
        JsonParameter {
            name: labels.names[it.index],
            unit: labels.units[it.index],
            start: self.vehicle.parameters[it.index],
            value: it.value,
            standard_error: it.standard_error,
            white_error: it.white_error,
        }
    }

    fn json(&self) -> Json<'_> {
        let estimate = &self.estimate;
        let correlations = estimate.correlations.row_iter();
        let outputs = self.problem.measured.iter().enumerate();
        let outputs = outputs.map(|(index, name)| {
            let test = &estimate.whiteness[index];
            JsonOutput {
                name,
                unit: self.vehicle.unit(name),
                noise: estimate.noise[index],
                whiteness_statistic: test.statistic,
                whiteness_lags: test.lags,
                whiteness_p: test.p,
            }
        });
        Json {
            heading: self.vehicle.heading(),
            method: self.method.name(),
            samples: self.problem.record.times.len(),
            segments: estimate.segments,
            iterations: estimate.iterations,
            log_likelihood: estimate.log_likelihood,
            parameters: estimate
                .parameters
                .iter()
                .map(|it| self.parameter(it))
                .collect(),
            correlations: correlations
                .map(|row| row.iter().copied().collect())
                .collect(),
            outputs: outputs.collect(),
        }
    }

    fn text(&self) -> String {
        let Json {
            method,
            samples,
            segments,
            iterations,
            parameters,
            correlations,
            outputs,
            ..
        } = self.json();
        let mut text = format!(
            "{}: {method}, {samples} samples in {segments} segments, {iterations} iterations; {}\n{:<16} {:>14} {:>14} {:>12} {:>12}",
            self.vehicle.name(),
            self.vehicle.described(),
            "parameter",
            "start",
            "estimate",
            "std error",
            "as if white",
        );
        // Writing into a String cannot fail.
        for it in &parameters {
            let _ = write!(
                text,
                "\n{:<16} {:>14.6e} {:>14.6e} {:>12.3e} {:>12.3e}  {}",
                it.name,
                Shown(it.start),
                Shown(it.value),
                Shown(it.standard_error),
                Shown(it.white_error),
                it.unit
            );
        }
        for (row, values) in correlations.iter().enumerate() {
            for (column, value) in values.iter().enumerate().take(row) {
                if value.abs() > STRONG {
                    let (a, b) = (parameters[column].name, parameters[row].name);
                    let _ = write!(text, "\ncorrelation of {a} and {b}: {}", fixed(*value, 3));
                }
            }
        }
        for it in outputs {
            let coloured = match it.whiteness_p < COLOURED {
                true => "coloured",
                false => "no sign of colour",
            };
            let _ = write!(
                text,
                "\n{}: measurement noise {:.3e} {}; residuals: {coloured} (Ljung-Box {} over {} lags, p {})",
                it.name,
                Shown(it.noise),
                it.unit,
                fixed(it.whiteness_statistic, 1),
                it.whiteness_lags,
                fixed(it.whiteness_p, 3)
            );
        }
        text
    }

    /// Measured and fitted outputs over time.
    pub(super) fn figure(&self) -> Result<String, PlotError> {
        let record = &self.problem.record;
        let outputs = self.problem.measured.iter().enumerate();
        let panels = outputs.map(|(index, name)| {
            let (unit, factor) = readable(self.vehicle.unit(name));
            let points = |rows: &[Vec<f64>]| -> Vec<(f64, f64)> {
                let rows = record.times.iter().zip(rows);
                rows.map(|(time, row)| (*time, factor * row[index]))
                    .collect()
            };
            Panel {
                title: (*name).to_owned(),
                x: Axis::linear("time [s]"),
                y: Axis::linear(format!("{name} [{unit}]")),
                layers: vec![
                    Layer::new(
                        "measured",
                        Colour::SkyBlue,
                        Mark::Markers(Shape::Dot, points(&record.outputs)),
                    ),
                    Layer::new(
                        self.method.name(),
                        Colour::Vermillion,
                        Mark::Line(points(&self.estimate.fitted)),
                    ),
                ],
            }
        });
        let title = format!("{}: {}", self.vehicle.name(), self.method.name());
        Figure::new(title, COLUMNS, panels.collect()).svg()
    }
}
