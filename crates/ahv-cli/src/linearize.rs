//! `ahv linearize`: the linear system about a trim.

mod mat;

use std::path::{Path, PathBuf};

use ahv_analysis::linearize::{LinearSystem, LinearizeError};
use ahv_analysis::trim::SteadyState;
use clap::Args;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::csv_file::CsvFile;
use crate::failure::{Failure, complain, print};
use crate::flight_condition::FlightCondition;
use crate::named::Named;
use crate::names;
use crate::number::{Shown, cell};
use crate::output::{self, Pairs};
use crate::vehicle::{Heading, Vehicle, VehicleArgs};

/// Linearises a model about its trim, or a given state: dx/dt = A x + B u, y = C x + D u.
///
/// Derivatives are the generated ones, exact to rounding. States, inputs and outputs are deviations from that point, in the
/// units of the model, angles in rad.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// A state that is no trim, e.g. velocity=7702ft/s,alpha=1.5deg, in the place of that of a trim; what is not given is as the
    /// flight condition has it, or 0. Inputs are then those of --input, and all others 0
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state: Vec<String>,

    /// Inputs, in their order in u [default: those of the model's path]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    inputs: Vec<String>,

    /// Outputs, states or other quantities in their order in y [default: those of the model's path]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    outputs: Vec<String>,

    /// File to write: .json, .csv, or .mat with A, B, C, D and their names for python-control, MATLAB and Octave
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Print the system as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    about_point(arguments, &arguments.vehicle.vehicle()?)
}

fn about_point(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let (flight, point) = arguments.condition.point(vehicle, &arguments.state)?;
    let system = vehicle.linear((&point.0, &point.1), &arguments.inputs, &arguments.outputs)?;
    for why in system.inputs.iter().filter_map(|input| vehicle.idle(input)) {
        complain(&format!("note: {why}"));
    }
    let json = json(vehicle, &flight, &point, &system);
    if let Some(path) = &arguments.out {
        write(path, vehicle, &system, &json)?;
    }
    match arguments.json {
        true => output::print_json(&json),
        false => print(&text(vehicle, &point, &system)),
    }
}

impl Vehicle {
    /// The linear system about a point; without names from the model's default inputs to its default outputs.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for an unknown input or output, [`Failure::Numeric`] for a derivative that is not finite.
    pub fn linear(
        &self,
        point: (&[f64], &[f64]),
        inputs: &[String],
        outputs: &[String],
    ) -> Result<LinearSystem, Failure> {
        let or_default = |names: &[String], default: &[&'static str]| match names {
            [] => default.iter().map(ToString::to_string).collect(),
            names => names.to_vec(),
        };
        let inputs: Vec<String> = or_default(inputs, self.model.default_inputs());
        let outputs: Vec<String> = or_default(outputs, self.model.default_outputs());
        let unknown = |option, kind, name: &str, known: &[&str]| {
            let problem = names::unknown(kind, name, known);
            Failure::Request(format!("{option}: {problem}"))
        };
        for (option, names) in [("--inputs", &inputs), ("--outputs", &outputs)] {
            if let Some(name) = names::twice(names) {
                return Err(Failure::Request(format!("{option}: {name} is given twice")));
            }
        }
        let system = self
            .model
            .linearize(&self.parameters, point, &inputs, &outputs);
        system.map_err(|error| match &error {
            LinearizeError::UnknownInput(name) => {
                unknown("--inputs", "input", name, self.inputs.names)
            }
            LinearizeError::UnknownOutput(name) => {
                let known = [self.states.names, self.outputs.names].concat();
                unknown("--outputs", "state or output", name, &known)
            }
            LinearizeError::NonFinite { .. } => {
                Failure::Numeric(format!("{}: {error}", self.name()))
            }
        })
    }
}

/// The system by the names of its matrices, with the point that it stands for.
#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    #[serde(flatten)]
    condition: Named<f64>,
    states: &'a [&'static str],
    inputs: &'a [&'static str],
    outputs: &'a [&'static str],
    units: Pairs<&'static str>,
    state: Pairs<f64>,
    input: Pairs<f64>,
    output_values: Pairs<f64>,
    #[serde(rename = "A")]
    a: Vec<Vec<f64>>,
    #[serde(rename = "B")]
    b: Vec<Vec<f64>>,
    #[serde(rename = "C")]
    c: Vec<Vec<f64>>,
    #[serde(rename = "D")]
    d: Vec<Vec<f64>>,
}

fn json<'a>(
    vehicle: &'a Vehicle,
    flight: &SteadyState,
    (state, input): &(Vec<f64>, Vec<f64>),
    system: &'a LinearSystem,
) -> Json<'a> {
    let point = vehicle.point(state, input);
    Json {
        heading: vehicle.heading(),
        condition: Named::given(vehicle, flight),
        states: &system.states,
        inputs: &system.inputs,
        outputs: &system.outputs,
        units: point.units,
        state: point.state,
        input: point.input,
        output_values: point.outputs,
        a: rows(&system.a),
        b: rows(&system.b),
        c: rows(&system.c),
        d: rows(&system.d),
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// Writes the system in the format that the file's name asks for.
fn write(
    path: &Path,
    vehicle: &Vehicle,
    system: &LinearSystem,
    json: &Json<'_>,
) -> Result<(), Failure> {
    match path.extension().and_then(|it| it.to_str()) {
        Some("json") => output::write(path, output::json(json)?),
        Some("csv") => csv(path, vehicle, system, json),
        Some("mat") => {
            let LinearSystem {
                a,
                b,
                c,
                d,
                states,
                inputs,
                outputs,
            } = system;
            let matrices = [("A", a), ("B", b), ("C", c), ("D", d)];
            let names = [("states", states), ("inputs", inputs), ("outputs", outputs)];
            let names = names.map(|(name, list)| (name, list.as_slice()));
            output::write(path, mat::file(&matrices, &names))
        }
        _ => Err(Failure::Request(format!(
            "--out: {} should end in .json, .csv or .mat",
            path.display()
        ))),
    }
}

/// [A, B; C, D] with a label at each row and column.
fn csv(
    path: &Path,
    vehicle: &Vehicle,
    system: &LinearSystem,
    json: &Json<'_>,
) -> Result<(), Failure> {
    let label = |name: &&str| format!("{name} [{}]", vehicle.unit(name));
    let rate = |name: &&str| format!("d{name}/dt [{}/s]", vehicle.unit(name));
    let mut file = CsvFile::create(path)?;
    let mut header = vec![String::new()];
    header.extend(system.states.iter().chain(&system.inputs).map(label));
    file.row(&header)?;
    let rates = system
        .states
        .iter()
        .map(rate)
        .zip(json.a.iter().zip(&json.b));
    let outputs = system
        .outputs
        .iter()
        .map(label)
        .zip(json.c.iter().zip(&json.d));
    for (label, (by_state, by_input)) in rates.chain(outputs) {
        let values = by_state.iter().chain(by_input).copied().map(cell);
        let row: Vec<String> = std::iter::once(label).chain(values).collect();
        file.row(&row)?;
    }
    file.finish()
}

fn text(vehicle: &Vehicle, (state, input): &(Vec<f64>, Vec<f64>), system: &LinearSystem) -> String {
    let LinearSystem {
        states,
        inputs,
        outputs,
        a,
        b,
        c,
        d,
    } = system;
    let matrices = [
        ("A", a, states, states),
        ("B", b, states, inputs),
        ("C", c, outputs, states),
        ("D", d, outputs, inputs),
    ];
    let matrices: String = matrices
        .map(|(name, matrix, rows, columns)| format!("\n{name}\n{}", block(matrix, rows, columns)))
        .concat();
    format!(
        "{}: linear system, {}\nabout\n{}\n{}{matrices}",
        vehicle.name(),
        vehicle.described(),
        vehicle.states.describe(state),
        vehicle.inputs.describe(input)
    )
}

/// A matrix with its labels.
fn block(matrix: &DMatrix<f64>, rows: &[&str], columns: &[&str]) -> String {
    let head: String = columns.iter().map(|name| format!(" {name:>11}")).collect();
    let lines = rows.iter().zip(matrix.row_iter()).map(|(name, row)| {
        let values: String = row
            .iter()
            .map(|value| format!(" {:>11.4e}", Shown(value + 0.0)))
            .collect();
        format!("{name:>11}{values}")
    });
    let lines: Vec<String> = lines.collect();
    format!("{:>11}{head}\n{}", "", lines.join("\n"))
}
