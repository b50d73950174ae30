//! What `ahv disperse` tells.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use ahv_analysis::disperse::{
    Contribution, Distribution, Kind, Part, Quantity, SolutionError, Spread,
};
use ahv_analysis::linearize::LinearizeError;
use ahv_analysis::statistics::Estimate;
use ahv_analysis::trim::TrimError;
use serde::Serialize;

use super::Outcome;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::number::{Shown, cell};
use crate::output::Pairs;
use crate::vehicle::{Heading, PointJson};

#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    /// The trim of the vehicle about which is drawn.
    #[serde(flatten)]
    point: PointJson,
    distribution: Distribution,
    seed: u64,
    members: usize,
    asked: u64,
    complete: bool,
    varied: usize,
    trimmed: usize,
    /// Members that did not trim, by reason.
    failed: BTreeMap<String, usize>,
    shares: Pairs<Estimate>,
    quantities: Vec<JsonQuantity>,
}

#[derive(Serialize)]
struct JsonQuantity {
    kind: Kind,
    name: String,
    part: Part,
    unit: &'static str,
    nominal: f64,
    spread: Option<Spread>,
    linear_std: Option<f64>,
    sensitivities: Vec<JsonSensitivity>,
}

#[derive(Serialize)]
struct JsonSensitivity {
    parameter: &'static str,
    slope: f64,
    effect: f64,
}

/// Why a vehicle has no solution, in few words that those of one kind have in common.
fn reason(error: &SolutionError) -> String {
    match error {
        SolutionError::Trim(TrimError::Blocked { blocking, .. }) => {
            let mut inputs: Vec<String> = blocking
                .iter()
                .map(|it| {
                    let side = if it.upper { "upper" } else { "lower" };
                    format!("{side} bound of {}", it.input)
                })
                .collect();
            // In one order, whichever was met first.
            inputs.sort();
            format!("no trim: {}", inputs.join(" and "))
        }
        SolutionError::Trim(TrimError::NoConvergence { .. }) => {
            "no trim: no convergence".to_owned()
        }
        SolutionError::Trim(TrimError::NonFinite { name, .. }) => {
            format!("no trim: the equation of {name} is not finite")
        }
        SolutionError::Linearize(LinearizeError::NonFinite { row, column, .. }) => {
            format!("no roots: the derivative of {row} by {column} is not finite")
        }
        other => other.to_string(),
    }
}

impl Outcome<'_> {
    pub(super) fn json(&self) -> Json<'_> {
        let values = self.nominal.values();
        let quantity = |(index, quantity): (usize, &Quantity)| JsonQuantity {
            kind: quantity.kind,
            name: quantity.name.clone(),
            part: quantity.part,
            unit: self.unit(quantity),
            nominal: values[index],
            spread: self.spreads[index],
            linear_std: self.slopes.std(index, &self.draws),
            sensitivities: self
                .slopes
                .ranked(index, &self.draws)
                .into_iter()
                .map(|it| JsonSensitivity {
                    parameter: self.parameter(&it),
                    slope: it.slope,
                    effect: it.effect,
                })
                .collect(),
        };
        Json {
            heading: self.vehicle.heading(),
            point: {
                let trim = &self.nominal.solution.trim;
                self.vehicle.point(&trim.state, &trim.input)
            },
            distribution: self.draws.distribution(),
            seed: self.arguments.seed,
            members: self.members.len(),
            asked: self.arguments.members,
            complete: self.is_complete(),
            varied: self.slopes.parameters.len(),
            trimmed: self.trimmed(),
            failed: self.failed(),
            shares: Pairs(self.shares()),
            quantities: self
                .nominal
                .quantities
                .iter()
                .enumerate()
                .map(quantity)
                .collect(),
        }
    }

    fn trimmed(&self) -> usize {
        self.members.iter().filter(|it| it.solution.is_ok()).count()
    }

    fn failed(&self) -> BTreeMap<String, usize> {
        let mut failed = BTreeMap::new();
        for error in self
            .members
            .iter()
            .filter_map(|it| it.solution.as_ref().err())
        {
            *failed.entry(reason(error)).or_default() += 1;
        }
        failed
    }

    /// Shares with their intervals: of all members, then of those that trim.
    fn shares(&self) -> Vec<(&'static str, Estimate)> {
        let solutions: Vec<_> = self
            .members
            .iter()
            .filter_map(|it| it.solution.as_ref().ok())
            .collect();
        let of_trimmed = |hits: usize| Estimate::of_share(hits as u64, solutions.len() as u64);
        let (states, bounds) = (self.vehicle.states, &self.vehicle.state_bounds);
        let outside = |state: &[f64]| states.outside(state, bounds).next().is_some();
        let inside = solutions.iter().filter(|it| !outside(&it.trim.state));
        let stable = solutions.iter().filter(|it| it.unstable_poles() == 0);
        let non_minimum_phase = solutions.iter().filter(|it| it.is_non_minimum_phase());
        vec![
            (
                "trims",
                Estimate::of_share(solutions.len() as u64, self.members.len() as u64),
            ),
            ("inside_validity_box", of_trimmed(inside.count())),
            ("stable", of_trimmed(stable.count())),
            ("non_minimum_phase", of_trimmed(non_minimum_phase.count())),
        ]
    }

    /// The unit of a quantity.
    pub(super) fn unit(&self, quantity: &Quantity) -> &'static str {
        let (states, inputs) = (self.vehicle.states, self.vehicle.inputs);
        match (quantity.kind, quantity.part) {
            (Kind::Trim, _) => {
                let names = [quantity.name.clone(), quantity.name.replace("eta", "chi")];
                let state = names.iter().find(|name| states.index_of(name).is_some());
                state.map_or_else(|| inputs.unit(&quantity.name), |name| states.unit(name))
            }
            (_, Part::Imaginary) => "rad/s",
            _ => "1/s",
        }
    }

    pub(super) fn text(&self) -> String {
        let members = if self.is_complete() {
            self.members.len().to_string()
        } else {
            format!(
                "interrupted: {} of {}",
                self.members.len(),
                self.arguments.members
            )
        };
        let mut text = format!(
            "{}: {}, {}\n{} members, {} {}, seed {}\n",
            self.vehicle.name(),
            self.vehicle.at(&self.nominal.flight),
            self.vehicle.described(),
            members,
            match self.slopes.parameters.len() {
                1 => "1 parameter".to_owned(),
                count => format!("{count} parameters"),
            },
            match self.draws.distribution() {
                Distribution::Uniform => "uniform within the uncertainty",
                Distribution::Normal => "normal, the uncertainty three standard deviations",
            },
            self.arguments.seed
        );
        // Writing into a String cannot fail.
        for (name, Estimate { value, low, high }) in self.shares() {
            let [value, low, high] = [value, low, high].map(|share| Shown(100.0 * share));
            let of = if name == "trims" { "members" } else { "trims" };
            let name = name.replace('_', " ");
            let _ = writeln!(
                text,
                "  {name:<20} {value:5.1} % of the {of} [{low:.1}, {high:.1}]"
            );
        }
        for (reason, count) in self.failed() {
            let _ = writeln!(text, "  {count} without: {reason}");
        }
        let _ = writeln!(
            text,
            "{:<34} {:>10} {:>10} {:>10} {:>8} {:>11} {:>10} {:>10} {:>10}",
            "", "nominal", "mean", "std", "+-", "first order", "5 %", "50 %", "95 %"
        );
        let values = self.nominal.values();
        for (index, quantity) in self.nominal.quantities.iter().enumerate() {
            let (label, factor) = self.label(quantity);
            let Some(spread) = self.spreads[index] else {
                let nominal = number(factor * values[index]);
                let _ = writeln!(text, "{label:<34} {nominal:>10} in no two members");
                continue;
            };
            let linear = self.slopes.std(index, &self.draws);
            let linear = linear.map_or_else(|| "none".to_owned(), |std| number(factor * std));
            let error = spread.std_error;
            let error = error.map_or_else(|| "open".to_owned(), |it| number(factor * it));
            let [nominal, mean, std, p05, p50, p95] = [
                values[index],
                spread.mean,
                spread.std,
                spread.p05,
                spread.p50,
                spread.p95,
            ]
            .map(|value| number(factor * value));
            let _ = writeln!(
                text,
                "{label:<34} {nominal:>10} {mean:>10} {std:>10} {error:>8} {linear:>11} {p05:>10} {p50:>10} {p95:>10}"
            );
        }
        text.push_str(
            "What a parameter larger in magnitude by a standard deviation adds, to first order:",
        );
        for index in self.headline() {
            let (label, factor) = self.label(&self.nominal.quantities[index]);
            let _ = write!(text, "\n  {label}:");
            for it in self.ranked(index).iter().take(self.arguments.top) {
                let effect = factor * it.effect;
                let sign = if effect > 0.0 { "+" } else { "" };
                let (parameter, effect) = (self.parameter(it), number(effect));
                let _ = write!(text, "\n    {parameter:<20} {sign}{effect}");
            }
        }
        text
    }

    /// Quantities that a person asks for first: the trim's angles and fuel, the rightmost pole, the rightmost zero.
    pub(super) fn headline(&self) -> Vec<usize> {
        let values = self.nominal.values();
        let quantities = || self.nominal.quantities.iter().enumerate();
        let trim = quantities().filter(|(_, it)| {
            let numbered = it.name.ends_with(|last: char| last.is_ascii_digit());
            it.kind == Kind::Trim && !numbered
        });
        let rightmost = |kind: Kind| {
            let real = quantities().filter(|(_, it)| it.kind == kind && it.part == Part::Real);
            let real = real.map(|(index, _)| index);
            real.max_by(|&a, &b| values[a].total_cmp(&values[b]))
        };
        let roots = [rightmost(Kind::Pole), rightmost(Kind::Zero)];
        trim.map(|(index, _)| index)
            .chain(roots.into_iter().flatten())
            .collect()
    }

    /// Contributions to a quantity, the greatest first.
    pub(super) fn ranked(&self, index: usize) -> Vec<Contribution> {
        self.slopes.ranked(index, &self.draws)
    }

    /// Name and unit for a person, and the factor to that unit.
    pub(super) fn label(&self, quantity: &Quantity) -> (String, f64) {
        let (unit, factor) = match self.unit(quantity) {
            "rad" => ("deg", 1_f64.to_degrees()),
            unit => (unit, 1.0),
        };
        let name = quantity.name.replace('_', " ");
        let part = match quantity.part {
            Part::Value => "",
            Part::Real => ", real",
            Part::Imaginary => ", imaginary",
        };
        let kind = if quantity.kind == Kind::Pole {
            "pole "
        } else {
            ""
        };
        let unit = if unit == "1" {
            String::new()
        } else {
            format!(" [{unit}]")
        };
        (format!("{kind}{name}{part}{unit}"), factor)
    }

    /// Name of the parameter of a contribution.
    pub(super) fn parameter(&self, contribution: &Contribution) -> &'static str {
        let names = self.vehicle.model.parameters().names;
        names
            .get(contribution.parameter)
            .copied()
            .unwrap_or_default()
    }

    /// Writes the members: number, what became of it, its parameters, its quantities; what it has not stays empty.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the file cannot be written.
    pub(super) fn csv(&self, path: &Path) -> Result<(), Failure> {
        let varied = || self.slopes.parameters.iter();
        let labels = self.vehicle.units.labels(self.vehicle.model.parameters());
        let parameters = varied().filter_map(|&index| {
            let (name, unit) = labels.iter().nth(index)?;
            Some(format!("{name} [{unit}]"))
        });
        let quantities = self.nominal.quantities.iter().map(|quantity| {
            let part = match quantity.part {
                Part::Value => "",
                Part::Real => "_real",
                Part::Imaginary => "_imaginary",
            };
            format!("{}{part} [{}]", quantity.name, self.unit(quantity))
        });
        let first = ["member", "outcome"].map(str::to_owned).into_iter();
        let mut file = CsvFile::create(path)?;
        file.row(
            &first
                .chain(parameters)
                .chain(quantities)
                .chain(["complete".to_owned()])
                .collect::<Vec<_>>(),
        )?;
        let complete = self.is_complete().to_string();
        for member in &self.members {
            let outcome = match &member.solution {
                Ok(_) => "trim".to_owned(),
                Err(error) => reason(error),
            };
            let drawn = self.draws.member_values(member.number);
            let parameters = varied().map(|&index| drawn.get(index).copied());
            let numbers = parameters.chain(member.values.iter().copied());
            let cells = numbers.map(|it| it.map_or_else(String::new, cell));
            let first = [member.number.to_string(), outcome].into_iter();
            let last = [complete.clone()];
            file.row(&first.chain(cells).chain(last).collect::<Vec<_>>())?;
        }
        file.finish()
    }
}

/// A number of four decimals, or of three digits where these would not show it.
fn number(value: f64) -> String {
    if value != 0.0 && (value.abs() < 1e-3 || value.abs() >= 1e9) {
        format!("{:.2e}", Shown(value))
    } else {
        format!("{:.4}", Shown(value))
    }
}
