//! `ahv identify`: parameters of a model from a flight record.

mod record;
mod report;
mod written;

use std::path::PathBuf;

use ahv_core::EntryKind;
use ahv_identify::{Estimate, IdentifyError, Problem, filter, output_error};
use clap::{Args, ValueEnum};

use crate::failure::{Failure, all};
use crate::flight_condition::FlightCondition;
use crate::names;
use crate::output;
use crate::progress::{Progress, Work};
use crate::vehicle::{Vehicle, VehicleArgs};

/// Estimates parameters of a model from a flight record, by maximum likelihood.
///
/// The record is a CSV file with a line a sample: `time [s]`, the inputs, each held until the next line, and measured states
/// or outputs, as `ahv montecarlo --trajectories` writes it. Standard errors are Cramer-Rao bounds, corrected for coloured residuals.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    vehicle: VehicleArgs,

    /// The record
    #[arg(long, value_name = "FILE")]
    record: PathBuf,

    /// Parameters to estimate, by their names in the generated code, e.g. c_l_alpha
    #[arg(long, value_name = "NAME", value_delimiter = ',', required = true)]
    parameters: Vec<String>,

    /// States or outputs that are compared [default: all that the record has]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    measured: Vec<String>,

    /// Method [default: filter for models with coloured noise, output-error for others]
    #[arg(long)]
    method: Option<Method>,

    /// Length of a segment in s, each with an initial state of its own [default: the whole record]
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    segment: Option<f64>,

    /// With output-error: states that start a segment as measured, or else as the trim has them, and are not estimated
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    hold: Vec<String>,

    #[command(flatten)]
    condition: FlightCondition,

    /// Table to write: that of --table with the estimates, their uncertainty and a note of the record
    #[arg(long, value_name = "FILE", requires = "table")]
    out: Option<PathBuf>,

    /// Picture to write (SVG): measured and fitted outputs
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,

    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,
}

/// How parameters are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The model flies with the recorded inputs; residuals are measurement noise
    OutputError,
    /// An extended Kalman filter predicts each sample; the model's own noise counts
    Filter,
}

impl Method {
    const fn name(self) -> &'static str {
        match self {
            Self::OutputError => "output-error",
            Self::Filter => "filter",
        }
    }
}

/// A question with its answer.
struct Outcome<'a> {
    vehicle: &'a Vehicle,
    method: Method,
    problem: Problem<'a>,
    estimate: Estimate,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input, a record that does not fit, and files that cannot be written; [`Failure::Numeric`] if
/// there is no trim or no estimate.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    let problem = problem(arguments, &vehicle)?;
    let stochastic = vehicle.model.coloured_states() > 0;
    let method = arguments.method.unwrap_or(match stochastic {
        true => Method::Filter,
        false => Method::OutputError,
    });
    if method == Method::Filter && !arguments.hold.is_empty() {
        return Err(Failure::Request(
            "--hold: the filter estimates every state; it is for output-error".to_owned(),
        ));
    }
    let progress = Progress::start(Work {
        command: "identify",
        unit: "",
        total: None,
    });
    let estimate = match method {
        Method::OutputError => output_error(&problem),
        Method::Filter => filter(&problem),
    };
    drop(progress);
    let estimate = estimate.map_err(|error| {
        let why = format!("{}: {error}", vehicle.name());
        match error {
            IdentifyError::Diverges { .. } | IdentifyError::NoConvergence { .. } => {
                Failure::Numeric(why)
            }
            _ => Failure::Request(why),
        }
    })?;
    let outcome = Outcome {
        vehicle: &vehicle,
        method,
        problem,
        estimate,
    };
    let written = match (&arguments.out, &arguments.vehicle.table()) {
        (Some(out), Some(table)) => outcome
            .table(table, &arguments.record)
            .and_then(|text| output::write(out, text)),
        _ => Ok(()),
    };
    let printed = outcome.print(arguments.json);
    let drawn = match &arguments.figure {
        Some(path) => output::picture(path, outcome.figure()),
        None => Ok(()),
    };
    all([written, printed, drawn])
}

fn problem<'a>(arguments: &Arguments, vehicle: &'a Vehicle) -> Result<Problem<'a>, Failure> {
    let free = free(arguments, vehicle)?;
    let (flight, inputs) = arguments.condition.flight_and_inputs(vehicle)?;
    let start = vehicle.trim(&flight)?.state;
    let (measured, record) =
        record::read(&arguments.record, vehicle, &arguments.measured, &inputs)?;
    let states = vehicle.states;
    let held = arguments.hold.iter().map(|name| {
        states.index_of(name).ok_or_else(|| {
            let problem = names::unknown("state", name, states.names);
            Failure::Request(format!("--hold: {problem}"))
        })
    });
    let bounds = vehicle.state_bounds.iter().zip(&start);
    let deviation = bounds.map(|(bounds, value)| {
        let width = bounds.max - bounds.min;
        // Where there is no box, as much as the value itself.
        if width.is_finite() {
            width / 6.0
        } else {
            1.0 + value.abs()
        }
    });
    Ok(Problem {
        model: &vehicle.model,
        parameters: vehicle.parameters.clone(),
        free,
        measured,
        deviation: deviation.collect(),
        held: held.collect::<Result<_, _>>()?,
        start,
        record,
        segment: arguments.segment.unwrap_or(f64::INFINITY),
    })
}

/// Indices of the parameters that are asked for.
fn free(arguments: &Arguments, vehicle: &Vehicle) -> Result<Vec<usize>, Failure> {
    let refused = |why: String| Failure::Request(format!("--parameters: {why}"));
    if let Some(name) = names::twice(&arguments.parameters) {
        return Err(refused(format!("{name} is given twice")));
    }
    let (known, entries) = (
        vehicle.model.parameters().names,
        vehicle.model.table().entries,
    );
    let place = |name: &String| {
        let found = known.iter().position(|it| it == name);
        let index = found.ok_or_else(|| refused(names::unknown("parameter", name, known)))?;
        match entries.get(index).map(|entry| entry.kind) {
            Some(EntryKind::Switch) => Err(refused(format!(
                "{name} is a choice by name, not a number of the table"
            ))),
            _ => Ok(index),
        }
    };
    arguments.parameters.iter().map(place).collect()
}
