//! `ahv simulate`: from a trim, with held inputs, into a CSV file.

mod flight;
mod grid;
mod report;

use std::path::PathBuf;

use ahv_analysis::erased::{DeterministicScheme, StepperError};
use ahv_analysis::monte_carlo::Scheme;
use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::failure::Failure;
use crate::flight_condition::FlightCondition;
use crate::names;
use crate::registry::needs_noise;
use crate::vehicle::VehicleArgs;
use flight::{Flight, Motion};
use grid::grid;

/// Simulates a model with held inputs and writes the trajectory as CSV.
///
/// The run starts at the trim of the flight condition and holds the trim's inputs. Models with coloured noise are stochastic, others
/// deterministic unless asked otherwise. An unstable vehicle diverges
/// within seconds once it is off its trim.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    /// End of the simulation in s; the last step is shortened to end there
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Step size in s; with --tolerance the interval of the rows, and no step is longer
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    dt: f64,

    /// Drive a model without coloured noise with its noise too
    #[arg(long)]
    stochastic: bool,

    /// Stepper [default: rk4 without noise, dormand-prince853 with --tolerance, euler-maruyama with noise]. With noise, the schemes of `ahv montecarlo`; heun is one of both
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(scheme_names()))]
    scheme: Option<String>,

    /// Take steps as long as their error allows: of each state at most this part of its value and of the width of its validity
    /// box. Boundaries where the drift has a kink or jumps are located and told. Without noise
    #[arg(long, value_name = "PART", value_parser = tolerance, allow_negative_numbers = true)]
    tolerance: Option<f64>,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    #[command(flatten)]
    condition: FlightCondition,

    /// Components of the initial state, e.g. alpha=1.5deg: they replace those of the trim, which stays the one of the flight
    /// condition
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    initial: Vec<String>,

    /// CSV file to write; it is replaced when the run has succeeded, and else left as it was
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Print the outcome as JSON, in the units of the CSV file
    #[arg(long)]
    json: bool,
}

/// Reads a tolerance: rounding hides smaller ones, and greater ones are none.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (1e-14..=0.1).contains(&value) => Ok(value),
        _ => Err("is not a number from 1e-14 to 0.1".to_owned()),
    }
}

/// The steppers without noise, then the schemes of `ahv montecarlo`, each name once.
fn scheme_names() -> Vec<&'static str> {
    let mut names = Vec::from(DeterministicScheme::ALL.map(DeterministicScheme::name));
    let noisy = Scheme::ALL.map(Scheme::name);
    names.extend(noisy.iter().filter(|name| {
        !DeterministicScheme::ALL
            .map(DeterministicScheme::name)
            .contains(name)
    }));
    names
}

/// The steps of the one of `all` that is asked for.
///
/// # Errors
///
/// [`Failure::Request`] with those that this flight can have.
fn steps<T: Copy>(
    asked: &str,
    all: &[T],
    name: fn(T) -> &'static str,
    flight: &str,
    make: impl Fn(T) -> Result<Motion, StepperError>,
) -> Result<Motion, Failure> {
    let why = match all.iter().find(|&&it| name(it) == asked) {
        None => format!("{asked} is not for a flight {flight}"),
        Some(&it) => match make(it) {
            Ok(motion) => return Ok(motion),
            Err(error) => error.to_string(),
        },
    };
    let others = all.iter().filter(|&&it| make(it).is_ok());
    let others: Vec<&str> = others.map(|&it| name(it)).collect();
    Err(Failure::Request(format!(
        "--scheme: {why}; {} are for this one",
        names::list(&others)
    )))
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if the
/// trim or the simulation fails. The output file is then as it was.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    let (model, parameters) = (vehicle.model, &vehicle.parameters);
    let asked = arguments.scheme.as_deref();
    let noisy = arguments.stochastic || model.coloured_states() > 0;
    if let (true, Some(_)) = (noisy, arguments.tolerance) {
        return Err(Failure::Request(
            "--tolerance: a flight with noise has steps of fixed length".to_owned(),
        ));
    }
    let default = match (noisy, arguments.tolerance) {
        (true, _) => Scheme::EulerMaruyama.name(),
        (false, None) => DeterministicScheme::Rk4.name(),
        (false, Some(_)) => DeterministicScheme::DormandPrince853.name(),
    };
    let asked = asked.unwrap_or(default);
    let motion = if noisy {
        needs_noise("--stochastic", model, "")?;
        let make = |scheme| {
            let steps = model.stochastic(parameters, scheme, arguments.seed);
            steps.map(Motion::Fixed)
        };
        steps(asked, &Scheme::ALL, Scheme::name, "with noise", make)?
    } else {
        let make = |scheme| match arguments.tolerance {
            None => model.deterministic(parameters, scheme).map(Motion::Fixed),
            Some(tolerance) => model
                .adaptive(parameters, scheme, tolerance)
                .map(Motion::Adaptive),
        };
        let name = DeterministicScheme::name;
        steps(
            asked,
            &DeterministicScheme::ALL,
            name,
            "without noise",
            make,
        )?
    };
    let grid = grid(arguments.t_end, arguments.dt)?;
    let flight = Flight {
        vehicle: &vehicle,
        scheme: asked,
        seed: noisy.then_some(arguments.seed),
    };
    flight.simulate(arguments, &grid, motion)
}
