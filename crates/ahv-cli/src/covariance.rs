//! `ahv covariance`: how noise spreads the states of a flight, to first order and by flying.

mod figure;
mod report;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use ahv_analysis::covariance::{CovarianceError, Flight, Spreading};
use ahv_analysis::monte_carlo::{Experiment, Mode, Scheme, Snapshot};
use ahv_analysis::ordered::Control;
use clap::Args;
use nalgebra::{DMatrix, DVector};

use crate::failure::{Failure, all, print};
use crate::flight_condition::FlightCondition;
use crate::flights::deviations;
use crate::flights::feedback::FeedbackArguments;
use crate::number::{Shown, positive};
use crate::output;
use crate::progress::{Progress, Work};
use crate::registry::needs_noise;
use crate::show::show;
use crate::signals::Stoppable;
use crate::steps::{MOST_STEPS, allowed};
use crate::vehicle::{Vehicle, VehicleArgs};

/// Fewest members that have a standard deviation.
const FEWEST: u64 = 2;
/// Times at which the spread is told, in equal parts of the flight.
const SAMPLES: u32 = 20;

/// Propagates the covariance of the states along a flight from the trim, and flies the same many times.
///
/// To first order deviations have the covariance of P' = A P + P A' + G G', here by matrix exponentials; beside it stands the
/// spread of an ensemble (splitting of Strang, for a model without coloured noise Heun, Ito) with intervals of 95 %, and the ratio
/// of the two standard deviations. Inputs are held, or follow a state feedback. Where that loop is unstable the spread grows.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// Standard deviations of the states at the start, e.g. altitude=50ft,gamma=0.2deg
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state_std: Vec<String>,

    /// Standard deviations of the inputs at the start, e.g. phi=0.01; without feedback they are held
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input_std: Vec<String>,

    #[command(flatten)]
    feedback: FeedbackArguments,

    /// Add the covariance at which the linear system comes to rest
    #[arg(long)]
    stationary: bool,

    /// End of the flight in s
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Longest step in s
    #[arg(long, value_name = "S", default_value_t = 0.002, value_parser = positive, allow_negative_numbers = true)]
    dt: f64,

    /// Flights of the ensemble
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(30..=1_000_000))]
    members: u64,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Folder for covariance.svg and covariance.csv
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim or the
/// flight diverges.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    if arguments.state_std.is_empty() && arguments.input_std.is_empty() {
        let why = "; without --state-std or --input-std nothing spreads";
        needs_noise("--model", vehicle.model, why)?;
    }
    spread(arguments, &vehicle)
}

/// What is printed: the spread to first order and of the ensemble, at the same times.
struct Outcome<'a> {
    vehicle: &'a Vehicle,
    arguments: &'a Arguments,
    place: String,
    /// State and input of the trim.
    start: [Vec<f64>; 2],
    scheme: Scheme,
    linear: Vec<Spreading>,
    /// Members that were flown.
    members: u64,
    sampled: Vec<Snapshot>,
    /// If it is asked for: where the linear system comes to rest, or why it does not.
    stationary: Option<Result<DMatrix<f64>, String>>,
}

/// Steps of each part of the flight.
fn steps(arguments: &Arguments) -> Result<u64, Failure> {
    let (t_end, dt, parts) = (arguments.t_end, arguments.dt, f64::from(SAMPLES));
    let steps = parts * (t_end / parts / dt - 1e-9).ceil().max(1.0);
    Ok(allowed(t_end, dt, steps, MOST_STEPS)? / u64::from(SAMPLES))
}

fn spread(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let (model, parameters) = (vehicle.model, &vehicle.parameters);
    let scheme = model.default_scheme(parameters);
    let steady = arguments.condition.flight(vehicle)?;
    let trim = vehicle.trim(&steady)?;
    let part = arguments.t_end / f64::from(SAMPLES);
    let steps = steps(arguments)?;
    let experiment = Experiment {
        parameters: parameters.clone(),
        dispersion: None,
        state: [
            trim.state,
            deviations("--state-std", &arguments.state_std, vehicle, vehicle.states)?,
        ],
        input: [
            trim.input,
            deviations("--input-std", &arguments.input_std, vehicle, vehicle.inputs)?,
        ],
        feedback: arguments.feedback.read(vehicle, &steady)?,
        watched: Vec::new(),
        scheme,
        mode: Mode::Exact,
        dt: part / steps as f64,
        snapshots: (1..=u64::from(SAMPLES))
            .map(|index| index * steps)
            .collect(),
        seed: arguments.seed,
        control_variate: false,
    };
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let progress = Progress::start(Work {
        command: "covariance",
        unit: "member-steps",
        total: Some(arguments.members.saturating_mul(experiment.steps())),
    });
    let [start, x_std] = &experiment.state;
    let [input, u_std] = &experiment.input;
    let variances = x_std.iter().chain(u_std).map(|std| std * std);
    let flight = Flight {
        start: start.clone(),
        input: input.clone(),
        initial: DMatrix::from_diagonal(&DVector::from_vec(variances.collect())),
        feedback: experiment.feedback.as_ref().map(|it| it.regulation()),
        dt: arguments.dt,
    };
    let failed = |error: CovarianceError| match error {
        CovarianceError::Times => Failure::Request(format!("--dt and --t-end: {error}")),
        _ => Failure::Numeric(format!("{}: {error}", vehicle.name())),
    };
    let restless = |error: CovarianceError| match error {
        CovarianceError::NotAtRest { name, rate } => format!(
            "there is no stationary covariance: the flight is not at rest, {name} changes by {} per s",
            show(rate, vehicle.unit(name))
        ),
        _ => error.to_string(),
    };
    // Not multiples of a part: 14 of 20 parts of 1 s are 0.7 s.
    let time = |index| arguments.t_end * f64::from(index) / f64::from(SAMPLES);
    let times: Vec<f64> = (1..=SAMPLES).map(time).collect();
    let linear = model.covariance(parameters, &flight, &times);
    let linear = linear.map_err(failed)?;
    let stationary = arguments
        .stationary
        .then(|| model.stationary(parameters, &flight).map_err(restless));
    let stoppable = Stoppable::new(progress.control());
    let sampled = sample(vehicle, &experiment, arguments.members, progress.control());
    drop(stoppable);
    drop(progress);
    let (members, sampled) = sampled?;
    let outcome = Outcome {
        linear,
        stationary,
        members,
        sampled,
        place: vehicle.at(&steady),
        start: [flight.start, flight.input],
        scheme,
        vehicle,
        arguments,
    };
    // Whatever fails, the rest is reported; the picture comes last.
    let written = folder.map_or(Ok(()), |folder| outcome.write(folder));
    let rest = match &outcome.stationary {
        Some(Err(why)) => Err(Failure::Numeric(format!("{}: {why}", vehicle.name()))),
        _ => Ok(()),
    };
    let printed = if arguments.json {
        output::print_json(&outcome.json())
    } else {
        print(&outcome.text())
    };
    let drawn = folder.map_or(Ok(()), |folder| {
        output::picture(&folder.join("covariance.svg"), figure::draw(&outcome))
    });
    all([written, printed, drawn, rest])?;
    if outcome.is_complete() {
        return Ok(());
    }
    Err(Failure::Interrupted(format!(
        "interrupted: {members} of {} flights were flown, and are reported",
        arguments.members
    )))
}

/// Flies the ensemble: how many members, and their snapshots.
fn sample(
    vehicle: &Vehicle,
    experiment: &Experiment,
    members: u64,
    control: &Control,
) -> Result<(u64, Vec<Snapshot>), Failure> {
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let engine = vehicle.model.engine(experiment);
    let outcome = engine
        .and_then(|engine| engine.run(members, threads, control))
        .map_err(|error| Failure::Numeric(format!("{}: {error}", vehicle.name())))?;
    if outcome.members < members.min(FEWEST) {
        return Err(Failure::Interrupted(format!(
            "interrupted before {FEWEST} flights ended"
        )));
    }
    match outcome.snapshots.iter().find(|it| it.members < FEWEST) {
        None => Ok((outcome.members, outcome.snapshots)),
        Some(Snapshot {
            time,
            members: left,
            ..
        }) => Err(Failure::Numeric(format!(
            "{}: at {} s {left} of {} flights are left, too few for a standard deviation: the others are no longer \
             finite",
            vehicle.name(),
            Shown(*time),
            outcome.members
        ))),
    }
}
