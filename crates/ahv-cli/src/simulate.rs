//! `ahv simulate`: from a trim, with held inputs, into a CSV file.

mod flight;
mod grid;
mod report;

use std::path::PathBuf;

use ahv_core::StochasticModel;
use ahv_integrate::{ItoEulerMaruyama, Rk4, WienerSource};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};
use clap::Args;

use crate::condition::{Condition, Vehicle};
use crate::failure::Failure;
use crate::vehicle::{FlightModel, ModelName};
use flight::Flight;
use grid::grid;

/// Run of the noise: a single simulation is the first member of its ensemble.
const MEMBER: u64 = 0;

/// Simulates a model with held inputs and writes the trajectory as CSV.
///
/// The run starts at the trim of level flight at 7702.0808 ft/s and 85000 ft in the chosen condition,
/// and holds the trim's inputs. com, com_rigid and dcom are deterministic (Runge-Kutta of order 4),
/// sdcom, sdcom_printed and sdcom_gust stochastic (Euler-Maruyama, Ito).
/// The airframe is unstable: off its trim it diverges within seconds.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    /// End of the simulation in s; the last step is shortened to end there
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Step size in s
    #[arg(long, value_name = "S", value_parser = crate::number::positive, allow_negative_numbers = true)]
    dt: f64,

    /// Drive dcom with its noise too (Euler-Maruyama, Ito)
    #[arg(long)]
    stochastic: bool,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Held inputs, e.g. phi=0.28,delta_e=13.1deg; those of the trim where not given.
    /// The trim itself is sought over phi and delta_e with delta_c as given
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input: Vec<String>,

    /// Components of the initial state, e.g. alpha=1.5deg: they replace those of the trim,
    /// which stays the one at the standard velocity and altitude
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    initial: Vec<String>,

    /// CSV file to write; it is replaced when the run has succeeded, and else left as it was
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Print the outcome as JSON, in the units of the CSV file
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if the
/// trim or the simulation fails. The output file is then as it was.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.condition.model {
        ModelName::Com => calm::<com::Model<f64>>(arguments),
        ModelName::ComRigid => calm::<com_rigid::Model<f64>>(arguments),
        ModelName::Dcom if arguments.stochastic => {
            noisy::<dcom::Model<f64>, { dcom::Noise::<()>::LEN }>(arguments)
        }
        ModelName::Dcom => calm::<dcom::Model<f64>>(arguments),
        ModelName::Sdcom => noisy::<sdcom::Model<f64>, { sdcom::Noise::<()>::LEN }>(arguments),
        ModelName::SdcomPrinted => {
            noisy::<sdcom_printed::Model<f64>, { sdcom_printed::Noise::<()>::LEN }>(arguments)
        }
        ModelName::SdcomGust => {
            noisy::<sdcom_gust::Model<f64>, { sdcom_gust::Noise::<()>::LEN }>(arguments)
        }
    }
}

/// Without noise, by Runge-Kutta.
fn calm<M: FlightModel>(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.stochastic {
        return Err(Failure::Request(format!(
            "--stochastic: {} has no noise; dcom has, and the sdcom models always fly with theirs",
            M::NAME
        )));
    }
    let grid = grid(arguments.t_end, arguments.dt)?;
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let flight = Flight {
        vehicle: &vehicle,
        seed: None,
    };
    flight.simulate(arguments, &grid, |x, u, _, dt| {
        Rk4::new(dt).step(&vehicle.model, x, u)
    })
}

/// With noise of `N` channels, by Euler-Maruyama.
fn noisy<M: FlightModel + StochasticModel, const N: usize>(
    arguments: &Arguments,
) -> Result<(), Failure> {
    let grid = grid(arguments.t_end, arguments.dt)?;
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let mut wiener = WienerSource::<N>::new(arguments.seed, MEMBER);
    let flight = Flight {
        vehicle: &vehicle,
        seed: Some(arguments.seed),
    };
    flight.simulate(arguments, &grid, |x, u, step, dt| {
        let dw = wiener.increments(step.into(), dt);
        ItoEulerMaruyama::new(dt).step(&vehicle.model, x, u, &dw)
    })
}
