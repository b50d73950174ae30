//! `ahv simulate`: from a trim, with held inputs, into a CSV file.

mod flight;
mod grid;
mod report;

use std::path::PathBuf;

use ahv_core::{GeneratedModel, Vector};
use ahv_integrate::{Euler, Heun, ItoEulerMaruyama, ItoHeun, NormalStream, Rk4, StratonovichHeun};
use clap::{Args, ValueEnum};

use crate::failure::Failure;
use crate::flight_condition::FlightCondition;
use crate::registry::without_noise;
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
pub(crate) fn run<M: GeneratedModel>(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.stochastic || M::coloured_states() > 0 {
        noisy::<M>(arguments)
    } else {
        calm::<M>(arguments)
    }
}

/// Without noise.
fn calm<M: GeneratedModel>(arguments: &Arguments) -> Result<(), Failure> {
    let scheme = arguments.scheme.unwrap_or(Scheme::Rk4);
    if matches!(scheme, Scheme::EulerMaruyama | Scheme::StratonovichHeun) {
        return Err(other_scheme(scheme, "without noise", "rk4, heun and euler"));
    }
    let grid = grid(arguments.t_end, arguments.dt)?;
    let vehicle: Vehicle<M> = arguments.vehicle.vehicle()?;
    let flight = Flight {
        vehicle: &vehicle,
        seed: None,
    };
    flight.simulate(arguments, &grid, |x, u, _, dt| match scheme {
        Scheme::Euler => Euler::new(dt).step(&vehicle.model, x, u),
        Scheme::Heun => Heun::new(dt).step(&vehicle.model, x, u),
        _ => Rk4::new(dt).step(&vehicle.model, x, u),
    })
}

/// With noise.
fn noisy<M: GeneratedModel>(arguments: &Arguments) -> Result<(), Failure> {
    let scheme = arguments.scheme.unwrap_or(Scheme::EulerMaruyama);
    if matches!(scheme, Scheme::Rk4 | Scheme::Euler) {
        let known = "euler-maruyama, heun and stratonovich-heun";
        return Err(other_scheme(scheme, "with noise", known));
    }
    let channels = <M::Noise as Vector<f64>>::LEN;
    if channels == 0 {
        return Err(Failure::Request(format!(
            "--stochastic: {}",
            without_noise::<M>()
        )));
    }
    let grid = grid(arguments.t_end, arguments.dt)?;
    let vehicle: Vehicle<M> = arguments.vehicle.vehicle()?;
    let normals =
        (0..channels as u64).map(|channel| NormalStream::new(arguments.seed, MEMBER, channel));
    let mut normals: Vec<NormalStream> = normals.collect();
    let flight = Flight {
        vehicle: &vehicle,
        seed: Some(arguments.seed),
    };
    flight.simulate(arguments, &grid, |x, u, step, dt| {
        let mut normals = normals
            .iter_mut()
            .map(|normals| normals.normal(step.into()));
        let dw = M::Noise::from_fn(|_| normals.next().unwrap_or(0.0) * dt.sqrt());
        match scheme {
            Scheme::Heun => ItoHeun::new(dt).step(&vehicle.model, x, u, &dw),
            Scheme::StratonovichHeun => StratonovichHeun::new(dt).step(&vehicle.model, x, u, &dw),
            _ => ItoEulerMaruyama::new(dt).step(&vehicle.model, x, u, &dw),
        }
    })
}
