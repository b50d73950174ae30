//! `ahv linearize`: the linear system about a trim.

mod mat;

use std::path::{Path, PathBuf};

use ahv_analysis::linearize::{LinearSystem, LinearizeError, PATH_INPUTS, PATH_OUTPUTS, linearize};
use ahv_analysis::trim::{SteadyFlight, Trim};
use ahv_core::Vector;
use clap::Args;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::condition::{Condition, Heading, Vehicle};
use crate::csv_file::CsvFile;
use crate::failure::{Failure, print};
use crate::names;
use crate::number::{Shown, cell};
use crate::output::{self, Pairs};
use crate::place::Place;
use crate::units::Units;
use crate::vehicle::{FlightModel, for_model};

/// Linearises a model about its trim: dx/dt = A x + B u, y = C x + D u.
///
/// Derivatives are the generated ones, exact to rounding. States, inputs and outputs are deviations from the trim, in the
/// units of the model, angles in rad.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

    /// Inputs, in their order in u
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_values = PATH_INPUTS)]
    inputs: Vec<String>,

    /// Outputs, states in their order in y
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_values = PATH_OUTPUTS)]
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
    for_model!(arguments.condition.model, Model => {
        let vehicle: Vehicle<Model> = arguments.condition.vehicle()?;
        about_trim(arguments, &vehicle)
    })
}

fn about_trim<M: FlightModel>(arguments: &Arguments, vehicle: &Vehicle<M>) -> Result<(), Failure> {
    let flight = arguments.place.flight(vehicle)?;
    let trim = vehicle.trim(&flight)?;
    let system = vehicle.linear(&trim, &arguments.inputs, &arguments.outputs)?;
    if let Some(path) = &arguments.out {
        write(
            path,
            vehicle,
            &system,
            &json(vehicle, &flight, &trim, &system),
        )?;
    }
    match arguments.json {
        true => output::print_json(&json(vehicle, &flight, &trim, &system)),
        false => print(&text(vehicle, &flight, &system)),
    }
}

impl<M: FlightModel> Vehicle<M> {
    /// The linear system about `trim`.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for an unknown input or output, [`Failure::Numeric`] for a derivative that is not finite.
    pub(crate) fn linear<N: AsRef<str>>(
        &self,
        trim: &Trim<M::State, M::Input>,
        inputs: &[N],
        outputs: &[N],
    ) -> Result<LinearSystem, Failure> {
        let [inputs, outputs] =
            [inputs, outputs].map(|names| names.iter().map(AsRef::as_ref).collect::<Vec<&str>>());
        let unknown = |option, kind, name: &str, known| {
            let problem = names::unknown(kind, name, known);
            Failure::Request(format!("{option}: {problem}"))
        };
        linearize(&self.model, &trim.state, &trim.input, &inputs, &outputs).map_err(|error| {
            match &error {
                LinearizeError::UnknownInput(name) => {
                    unknown("--inputs", "input", name, M::Input::NAMES)
                }
                LinearizeError::UnknownOutput(name) => {
                    unknown("--outputs", "state", name, M::State::NAMES)
                }
                LinearizeError::NonFinite { .. } => {
                    Failure::Numeric(format!("{}: {error}", M::NAME))
                }
            }
        })
    }
}

/// The system by the names of its matrices, with the point that it stands for.
#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    velocity: f64,
    altitude: f64,
    gamma_deg: f64,
    states: &'a [&'static str],
    inputs: &'a [&'static str],
    outputs: &'a [&'static str],
    units: Pairs<&'static str>,
    state: Pairs<f64>,
    input: Pairs<f64>,
    #[serde(rename = "A")]
    a: Vec<Vec<f64>>,
    #[serde(rename = "B")]
    b: Vec<Vec<f64>>,
    #[serde(rename = "C")]
    c: Vec<Vec<f64>>,
    #[serde(rename = "D")]
    d: Vec<Vec<f64>>,
}

fn json<'a, M: FlightModel>(
    vehicle: &'a Vehicle<M>,
    flight: &SteadyFlight<M::Input>,
    trim: &Trim<M::State, M::Input>,
    system: &'a LinearSystem,
) -> Json<'a> {
    Json {
        heading: vehicle.heading(),
        velocity: flight.velocity,
        altitude: flight.altitude,
        gamma_deg: flight.gamma.to_degrees(),
        states: &system.states,
        inputs: &system.inputs,
        outputs: &system.outputs,
        units: Pairs::units_of_both::<M::State, M::Input>(vehicle.units),
        state: Pairs::of(&trim.state),
        input: Pairs::of(&trim.input),
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
fn write<M: FlightModel>(
    path: &Path,
    vehicle: &Vehicle<M>,
    system: &LinearSystem,
    json: &Json<'_>,
) -> Result<(), Failure> {
    match path.extension().and_then(|it| it.to_str()) {
        Some("json") => output::write(path, output::json(json)?),
        Some("csv") => csv::<M>(path, vehicle.units, system, json),
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
fn csv<M: FlightModel>(
    path: &Path,
    units: Units,
    system: &LinearSystem,
    json: &Json<'_>,
) -> Result<(), Failure> {
    let state = |name: &&str| format!("{name} [{}]", units.label::<M::State>(name));
    let input = |name: &&str| format!("{name} [{}]", units.label::<M::Input>(name));
    let rate = |name: &&str| format!("d{name}/dt [{}/s]", units.label::<M::State>(name));
    let mut file = CsvFile::create(path)?;
    let mut header = vec![String::new()];
    header.extend(system.states.iter().map(state));
    header.extend(system.inputs.iter().map(input));
    file.row(&header)?;
    let rates = system
        .states
        .iter()
        .map(rate)
        .zip(json.a.iter().zip(&json.b));
    let outputs = system
        .outputs
        .iter()
        .map(state)
        .zip(json.c.iter().zip(&json.d));
    for (label, (by_state, by_input)) in rates.chain(outputs) {
        let values = by_state.iter().chain(by_input).copied().map(cell);
        let row: Vec<String> = std::iter::once(label).chain(values).collect();
        file.row(&row)?;
    }
    file.finish()
}

fn text<M: FlightModel>(
    vehicle: &Vehicle<M>,
    flight: &SteadyFlight<M::Input>,
    system: &LinearSystem,
) -> String {
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
        "{}: linear system, {}\n{}{matrices}",
        M::NAME,
        vehicle.at(flight),
        vehicle.described()
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
