//! `ahv forces`: forces and moment at a point, and what they consist of.

use std::path::{Path, PathBuf};

use ahv_core::EntryKind;
use clap::Args;
use serde::Serialize;

use crate::csv_file::CsvFile;
use crate::failure::{Failure, all, print};
use crate::flight_condition::{FlightCondition, Point};
use crate::number::{Shown, cell};
use crate::output::{self, Pairs};
use crate::vehicle::{Heading, Vehicle, VehicleArgs};

/// Forces and moment of a model at its trim, or a given state, broken down by what they consist of.
///
/// A model with surfaces breaks them down by surface, one of curve fits by coefficient: then a part is the coefficient times the
/// derivative by it. Angles are in deg, parts in the units of the model.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// A state that is no trim, e.g. velocity=7702ft/s,alpha=1.5deg, in the place of that of a trim; what is not given is as the
    /// flight condition has it, or 0. Inputs are then those of --input, and all others 0
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state: Vec<String>,

    /// Folder for forces.csv
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print forces and their parts as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input, a given state without forces, or a file that cannot be written; [`Failure::Numeric`] if there
/// is no trim.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    let (_, point) = arguments.condition.point(&vehicle, &arguments.state)?;
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let (state, input) = &point;
    let fault = vehicle.model.fault(&vehicle.parameters, state, input);
    if let Some(fault) = fault {
        let message = format!("{}: {fault}", vehicle.name());
        return Err(match arguments.state.is_empty() {
            true => Failure::Numeric(message),
            false => Failure::Request(format!("--state: {message}")),
        });
    }
    let breakdown = Breakdown::new(&vehicle, &point);
    let written = folder.map_or(Ok(()), |folder| breakdown.csv(&folder.join("forces.csv")));
    let printed = match arguments.json {
        true => output::print_json(&breakdown.json()),
        false => print(&breakdown.text()),
    };
    all([written, printed])
}

/// Forces and moments with their parts.
struct Breakdown<'a> {
    vehicle: &'a Vehicle,
    point: &'a Point,
    /// What the parts are: `surface` or `coefficient`.
    by: &'static str,
    /// The forces and moments, outputs of the model, with their values.
    forces: Vec<(&'static str, f64)>,
    /// Parts with their share of each force.
    parts: Vec<(String, Vec<f64>)>,
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    state: Pairs<f64>,
    input: Pairs<f64>,
    output_values: Pairs<f64>,
    units: Pairs<&'static str>,
    by: &'static str,
    forces: Pairs<f64>,
    parts: Vec<JsonPart<'a>>,
}

#[derive(Serialize)]
struct JsonPart<'a> {
    name: &'a str,
    #[serde(flatten)]
    forces: Pairs<f64>,
}

impl<'a> Breakdown<'a> {
    fn new(vehicle: &'a Vehicle, point: &'a Point) -> Self {
        let values = vehicle
            .model
            .output_values(&vehicle.parameters, &point.0, &point.1);
        let surfaces = Self::by_surface(vehicle, point, &values);
        surfaces.unwrap_or_else(|| Self::by_coefficient(vehicle, point, &values))
    }

    /// The outputs that are called `PART_FORCE` beside one that is called `FORCE`; `None` where there are none.
    fn by_surface(vehicle: &'a Vehicle, point: &'a Point, values: &[f64]) -> Option<Self> {
        let names = vehicle.outputs.names;
        let of = |name: &str| values.get(vehicle.outputs.index_of(name)?).copied();
        let part = |name: &'static str, force: &str| name.strip_suffix(force)?.strip_suffix('_');
        let mut forces = Vec::new();
        let mut parts: Vec<(String, Vec<f64>)> = Vec::new();
        for &force in names {
            if names.iter().any(|other| part(force, other).is_some()) {
                // It is a part itself.
                continue;
            }
            let found: Vec<&str> = names.iter().filter_map(|name| part(name, force)).collect();
            if found.is_empty() {
                continue;
            }
            forces.push((force, of(force)?));
            for found in found {
                let value = of(&format!("{found}_{force}"))?;
                match parts.iter_mut().find(|(known, _)| known == found) {
                    Some((_, values)) => values.push(value),
                    None => parts.push((found.to_owned(), vec![value])),
                }
            }
        }
        (!forces.is_empty()).then_some(Self {
            vehicle,
            point,
            by: "surface",
            forces,
            parts,
        })
    }

    /// The coefficients of the table times the derivatives of the outputs by them.
    fn by_coefficient(vehicle: &'a Vehicle, point: &'a Point, values: &[f64]) -> Self {
        let slopes =
            vehicle
                .model
                .output_parameter_jacobian(&vehicle.parameters, &point.0, &point.1);
        let entries = vehicle.model.table().entries.iter().enumerate();
        let coefficients = entries.filter(|(_, entry)| {
            matches!(
                entry.kind,
                EntryKind::Coefficient | EntryKind::RequiredCoefficient
            )
        });
        let coefficients: Vec<_> = coefficients.collect();
        let share = |output: usize, parameter: usize| {
            slopes[(output, parameter)] * vehicle.parameters[parameter]
        };
        let outputs = vehicle.outputs.iter().zip(values).enumerate();
        let forces = outputs.filter(|(output, ((_, unit), _))| {
            let moved = |&(parameter, _): &(usize, _)| share(*output, parameter) != 0.0;
            *unit != "1" && coefficients.iter().any(moved)
        });
        let forces: Vec<_> = forces.collect();
        let parts = coefficients.iter().map(|&(parameter, entry)| {
            let shares = forces.iter().map(|&(output, _)| share(output, parameter));
            (format!("{} {}", entry.section, entry.key), shares.collect())
        });
        let parts: Vec<(String, Vec<f64>)> = parts.collect();
        let forces = forces
            .iter()
            .map(|&(_, ((name, _), &value))| (name, value))
            .collect();
        let seen = |(_, shares): &(String, Vec<f64>)| shares.iter().any(|&it| it != 0.0);
        Self {
            vehicle,
            point,
            by: "coefficient",
            forces,
            parts: parts.into_iter().filter(seen).collect(),
        }
    }

    fn json(&self) -> Json<'_> {
        let point = self.vehicle.point(&self.point.0, &self.point.1);
        let names = || self.forces.iter().map(|&(name, _)| name);
        let parts = self.parts.iter().map(|(name, values)| JsonPart {
            name,
            forces: Pairs(names().zip(values.iter().copied()).collect()),
        });
        Json {
            heading: self.vehicle.heading(),
            state: point.state,
            input: point.input,
            output_values: point.outputs,
            units: point.units,
            by: self.by,
            parts: parts.collect(),
            forces: Pairs(self.forces.clone()),
        }
    }

    fn text(&self) -> String {
        let label = |&(name, _): &(&'static str, f64)| {
            let label = format!("{name} [{}]", self.vehicle.unit(name));
            (label.chars().count().max(13), label)
        };
        let columns: Vec<(usize, String)> = self.forces.iter().map(label).collect();
        let head: String = columns
            .iter()
            .map(|(width, label)| format!("  {label:>width$}"))
            .collect();
        let line = |name: &str, values: &mut dyn Iterator<Item = f64>| {
            let cells: String = columns
                .iter()
                .zip(values)
                .map(|((width, _), value)| format!("  {:>width$.3}", Shown(value)))
                .collect();
            format!("{name:<18}{cells}\n")
        };
        let parts: String = self
            .parts
            .iter()
            .map(|(name, values)| line(name, &mut values.iter().copied()))
            .collect();
        let total = line("total", &mut self.forces.iter().map(|&(_, value)| value));
        format!(
            "{}: forces by {}, {}\nat\n{}\n{}\n{:<18}{head}\n{parts}{}",
            self.vehicle.name(),
            self.by,
            self.vehicle.described(),
            self.vehicle.states.describe(&self.point.0),
            self.vehicle.inputs.describe(&self.point.1),
            "",
            total.trim_end()
        )
    }

    fn csv(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        let label = |&(name, _): &(&str, f64)| format!("{name} [{}]", self.vehicle.unit(name));
        let header = std::iter::once(self.by.to_owned()).chain(self.forces.iter().map(label));
        file.row(&header.collect::<Vec<_>>())?;
        let totals = self.forces.iter().map(|&(_, value)| value).collect();
        for (name, values) in self.parts.iter().chain([&("total".to_owned(), totals)]) {
            let cells = values.iter().copied().map(cell);
            file.row(
                &std::iter::once(name.clone())
                    .chain(cells)
                    .collect::<Vec<_>>(),
            )?;
        }
        file.finish()
    }
}
