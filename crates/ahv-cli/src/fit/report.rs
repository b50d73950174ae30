//! What a fit says: text, JSON, pictures of residuals.

use std::fmt::Write as _;

use ahv_fit::Move;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};
use serde::Serialize;

use super::outcome::Fitted;
use super::plan::Plan;
use super::samples::Columns;
use crate::number::Shown;

/// A fit for people and programs.
#[derive(Serialize)]
pub(super) struct Report {
    table: String,
    samples: usize,
    origin: String,
    /// What the uncertainties are.
    uncertainty: &'static str,
    quantities: Vec<Part>,
    /// Sections that have no column, which stay.
    kept: Vec<&'static str>,
    /// Entries of the validity box, angles in rad.
    validity: Vec<(&'static str, (f64, f64))>,
}

#[derive(Serialize)]
struct Part {
    section: &'static str,
    doc: &'static str,
    unit: String,
    r_squared: Option<f64>,
    residual_rms: f64,
    cross_validated_rms: f64,
    worst_residual: f64,
    worst_sample: usize,
    condition: f64,
    degrees_of_freedom: usize,
    coefficients: Vec<Coefficient>,
    /// Row by row, in the order of the coefficients; angles in rad.
    covariance: Vec<Vec<f64>>,
    proposed: Vec<Proposed>,
    #[serde(skip)]
    shown: Vec<(f64, f64)>,
}

#[derive(Serialize)]
struct Coefficient {
    monomial: String,
    /// In the unit.
    value: f64,
    standard_error: f64,
    /// By how much it alone must change to move the quantity by as much as the residual.
    misfit: f64,
    unit: String,
    /// What a sign constraint holds at 0.
    held: bool,
}

#[derive(Serialize)]
struct Proposed {
    action: &'static str,
    monomial: String,
    cross_validated_rms_before: f64,
    cross_validated_rms_after: f64,
}

impl Report {
    pub(super) fn new(
        name: &str,
        plan: &Plan,
        columns: &Columns,
        fitted: &[Fitted],
        validity: Vec<(&'static str, (f64, f64))>,
    ) -> Self {
        let all = plan.quantities.iter().enumerate();
        let kept = all.filter(|(index, _)| !columns.quantities.contains(index));
        Self {
            table: name.to_owned(),
            samples: columns.responses.first().map_or(0, Vec::len),
            origin: columns.origin.clone(),
            uncertainty: match columns.drawn.is_empty() {
                true => "standard errors",
                false => "misfit",
            },
            quantities: fitted.iter().map(|it| Part::new(plan, it)).collect(),
            kept: kept.map(|(_, it)| it.fit.section).collect(),
            validity,
        }
    }

    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "{}: fit of {} samples of {}; uncertainties in the table: {}\n",
            self.table, self.samples, self.origin, self.uncertainty
        );
        for part in &self.quantities {
            part.write(&mut text);
        }
        if !self.kept.is_empty() {
            let kept = self.kept.join(", ");
            text += &format!("\nwithout a column, and as they were: {kept}\n");
        }
        let intervals = self.validity.iter();
        let intervals = intervals
            .map(|(name, (low, high))| format!("{name} {} to {}", short(*low), short(*high)));
        let intervals: Vec<String> = intervals.collect();
        text + "\nvalidity box of the samples, angles in rad: " + &intervals.join(", ")
    }

    /// Residuals over fitted values, a panel for each quantity.
    pub(super) fn figure(&self) -> Result<String, PlotError> {
        let panel = |part: &Part| Panel {
            title: part.doc.to_owned(),
            x: Axis::linear(format!("fitted {} [{}]", part.section, part.unit)),
            y: Axis::linear(format!("residual [{}]", part.unit)),
            layers: vec![
                Layer::new("", Colour::Grey, Mark::HorizontalRule(0.0)),
                Layer::new(
                    "sample less fit",
                    Colour::Blue,
                    Mark::Markers(Shape::Point, part.shown.clone()),
                ),
            ],
        };
        let panels: Vec<Panel> = self.quantities.iter().map(panel).collect();
        Figure::new(
            format!("Residuals of {}", self.table),
            panels.len().min(3),
            panels,
        )
        .svg()
    }
}

impl Part {
    fn new(plan: &Plan, it: &Fitted) -> Self {
        let quantity = &plan.quantities[it.quantity];
        let errors = it.estimate.errors();
        let coefficients = it
            .terms
            .iter()
            .enumerate()
            .map(|(index, term)| Coefficient {
                monomial: term.key.clone(),
                value: it.estimate.values[index] * term.factor(),
                standard_error: errors[index] * term.factor(),
                misfit: it.estimate.reach[index] * term.factor(),
                unit: term.unit.clone(),
                held: it.estimate.held[index],
            });
        let proposed = it.proposed.iter().map(|(step, term)| Proposed {
            action: match step.action {
                Move::Add(_) => "add",
                Move::Drop(_) => "drop",
            },
            monomial: term.key.clone(),
            cross_validated_rms_before: step.before,
            cross_validated_rms_after: step.after,
        });
        let covariance = it.estimate.covariance.row_iter();
        Self {
            section: quantity.fit.section,
            doc: quantity.fit.doc,
            unit: quantity.unit.clone(),
            r_squared: it.residuals.r_squared,
            residual_rms: it.estimate.residual,
            cross_validated_rms: it.estimate.cross_validated,
            worst_residual: it.residuals.worst.0,
            worst_sample: it.residuals.worst.1 + 1,
            condition: it.estimate.condition,
            degrees_of_freedom: it.estimate.degrees,
            coefficients: coefficients.collect(),
            covariance: covariance
                .map(|row| row.iter().copied().collect())
                .collect(),
            proposed: proposed.collect(),
            shown: it.residuals.shown.clone(),
        }
    }

    fn write(&self, text: &mut String) {
        let squared = self
            .r_squared
            .map_or("none, for the samples are all equal".to_owned(), |it| {
                format!("{it:.6}")
            });
        let unit = match self.unit.as_str() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        // Writing to a text cannot fail.
        let _ = write!(
            text,
            "\n{}, {}: R² {squared}\n  residual{unit}: {} rms, {} cross-validated, {} at worst (sample {}); condition {}\n",
            self.section,
            self.doc,
            short(self.residual_rms),
            short(self.cross_validated_rms),
            short(self.worst_residual),
            self.worst_sample,
            short(self.condition),
        );
        let width = self
            .coefficients
            .iter()
            .map(|it| it.monomial.chars().count())
            .max()
            .unwrap_or(0)
            .max(8);
        let _ = writeln!(
            text,
            "  {:<width$}  {:>13}  {:>13}  {:>13}  unit",
            "monomial", "value", "std. error", "misfit"
        );
        for it in &self.coefficients {
            let held = if it.held {
                "  held at 0 by its sign"
            } else {
                ""
            };
            let _ = writeln!(
                text,
                "  {:<width$}  {:>13}  {:>13}  {:>13}  {}{held}",
                it.monomial,
                short(it.value),
                short(it.standard_error),
                short(it.misfit),
                it.unit
            );
        }
        for it in &self.proposed {
            let (before, after) = (it.cross_validated_rms_before, it.cross_validated_rms_after);
            let _ = writeln!(
                text,
                "  worth trying: {} `{}`: cross-validated residual {} to {}",
                it.action,
                it.monomial,
                short(before),
                short(after)
            );
        }
    }
}

/// A number in six significant digits.
fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".to_owned(),
        1e-4..1e6 => {
            let places = (5 - size.log10().floor() as i32).max(0) as usize;
            format!("{:.places$}", Shown(value))
        }
        _ => format!("{:.5e}", Shown(value)),
    }
}
