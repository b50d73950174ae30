//! `ahv simulate`: from a trim, with held inputs, into a CSV file.

mod flight;
mod grid;
mod report;

use std::path::PathBuf;

use ahv_analysis::erased::Stepper;
use ahv_integrate::NormalStream;
use clap::{Args, ValueEnum};

use crate::failure::Failure;
use crate::flight_condition::FlightCondition;
use crate::registry::needs_noise;
use crate::vehicle::{Vehicle, VehicleArgs};
use flight::Flight;
use grid::grid;

/// Run of the noise: a single simulation is the first member of its ensemble.
const MEMBER: u64 = 0;

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

    /// Step size in s
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    dt: f64,

    /// Drive a model without coloured noise with its noise too
    #[arg(long)]
    stochastic: bool,

    /// Stepper [default: rk4 without noise, euler-maruyama with it]
    #[arg(long, value_enum)]
    scheme: Option<Scheme>,

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

/// A stepper with a fixed step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Scheme {
    /// Euler, of order 1; without noise
    Euler,
    /// Heun, of order 2 without noise; with noise in the sense of Ito, of order 1
    Heun,
    /// The classical method of Runge and Kutta, of order 4; without noise
    Rk4,
    /// Euler-Maruyama, Ito; with noise
    EulerMaruyama,
    /// Heun in the sense of Stratonovich; with noise
    StratonovichHeun,
}

/// What to say of a scheme that is not for such a flight.
fn other_scheme(scheme: Scheme, flight: &str, known: &str) -> Failure {
    let name = scheme.to_possible_value();
    let name = name.as_ref().map_or("this", |it| it.get_name());
    Failure::Request(format!(
        "--scheme: {name} is not for a flight {flight}; {known} are"
    ))
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if the
/// trim or the simulation fails. The output file is then as it was.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    if arguments.stochastic || vehicle.model.coloured_states() > 0 {
        noisy(arguments, &vehicle)
    } else {
        calm(arguments, &vehicle)
    }
}

/// Without noise.
fn calm(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let scheme = arguments.scheme.unwrap_or(Scheme::Rk4);
    let stepper = match scheme {
        Scheme::Euler => Stepper::Euler,
        Scheme::Heun => Stepper::Heun,
        Scheme::Rk4 => Stepper::Rk4,
        Scheme::EulerMaruyama | Scheme::StratonovichHeun => {
            return Err(other_scheme(scheme, "without noise", "rk4, heun and euler"));
        }
    };
    let grid = grid(arguments.t_end, arguments.dt)?;
    let flight = Flight {
        vehicle,
        seed: None,
    };
    let model = vehicle.model.flight(&vehicle.parameters);
    flight.simulate(arguments, &grid, |x, u, _, dt| {
        model.step(stepper, dt, x, u, &[])
    })
}

/// With noise.
fn noisy(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let scheme = arguments.scheme.unwrap_or(Scheme::EulerMaruyama);
    let stepper = match scheme {
        Scheme::Heun => Stepper::ItoHeun,
        Scheme::StratonovichHeun => Stepper::StratonovichHeun,
        Scheme::EulerMaruyama => Stepper::ItoEulerMaruyama,
        Scheme::Rk4 | Scheme::Euler => {
            let known = "euler-maruyama, heun and stratonovich-heun";
            return Err(other_scheme(scheme, "with noise", known));
        }
    };
    needs_noise("--stochastic", vehicle.model, "")?;
    let grid = grid(arguments.t_end, arguments.dt)?;
    let channels = 0..vehicle.model.channels() as u64;
    let normals = channels.map(|channel| NormalStream::new(arguments.seed, MEMBER, channel));
    let mut normals: Vec<NormalStream> = normals.collect();
    let flight = Flight {
        vehicle,
        seed: Some(arguments.seed),
    };
    let model = vehicle.model.flight(&vehicle.parameters);
    flight.simulate(arguments, &grid, |x, u, step, dt| {
        let normals = normals.iter_mut().map(|it| it.normal(step.into()));
        let dw: Vec<f64> = normals.map(|normal| normal * dt.sqrt()).collect();
        model.step(stepper, dt, x, u, &dw)
    })
}
