//! `ahv simulate`: from a trim, with held inputs, into a CSV file.

mod flight;
mod grid;
mod progress;
mod report;
mod table;

use std::path::PathBuf;

use ahv_analysis::noise::WienerSource;
use ahv_core::Vector;
use ahv_integrate::{EulerMaruyama, Rk4};
use ahv_models::{dcom, sdcom};
use clap::{Args, ValueEnum};

use crate::failure::Failure;
use flight::Flight;
use grid::Grid;

/// Run of the noise: a single simulation is the first member of its ensemble.
const MEMBER: u64 = 0;

/// Simulates a model with held inputs and writes the trajectory as CSV.
///
/// The run starts at the trim of level flight at 7702.0808 ft/s and 85000 ft, for the chosen canard,
/// and holds the trim's inputs. The airframe is unstable: off its trim it diverges within seconds.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Model: dcom is deterministic (Runge-Kutta of order 4), sdcom stochastic (Euler-Maruyama, Ito)
    #[arg(long)]
    model: ModelName,

    /// End of the simulation in s; the last step is shortened to end there
    #[arg(long, value_name = "S", value_parser = grid::positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Step size in s
    #[arg(long, value_name = "S", value_parser = grid::positive, allow_negative_numbers = true)]
    dt: f64,

    /// Seed of the noise of sdcom: the same seed gives the same numbers on every machine
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

    /// Canard: slaved to the elevator (delta_c is then an offset), free (delta_c is an input) or none
    /// [default: as the table has it]
    #[arg(long)]
    canard: Option<Canard>,

    /// Earth: flat, or spherical with gravity that falls with altitude [default: as the table has it]
    #[arg(long)]
    earth: Option<Earth>,

    /// CSV file to write; it is replaced when the run has succeeded, and else left as it was
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Print the outcome as JSON, in the units of the CSV file
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum ModelName {
    Dcom,
    Sdcom,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Canard {
    Slaved,
    Free,
    None,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Earth {
    Flat,
    Spherical,
}

impl Arguments {
    /// The table's parameters with what the command line chooses.
    fn parameters(&self) -> dcom::Parameters<f64> {
        let mut parameters = dcom::NOMINAL;
        if let Some(canard) = self.canard {
            parameters.canard_slaving = f64::from(u8::from(canard == Canard::Slaved));
        }
        if let Some(earth) = self.earth {
            parameters.spherical_earth = f64::from(u8::from(earth == Earth::Spherical));
        }
        parameters
    }

    /// Whether there is a canard for delta_c to move.
    fn has_canard(&self) -> bool {
        match self.canard {
            Some(canard) => canard != Canard::None,
            None => dcom::NOMINAL.canard_slaving != 0.0,
        }
    }
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if the
/// trim or the simulation fails. The output file is then as it was.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let grid = Grid::new(arguments.t_end, arguments.dt)?;
    let parameters = arguments.parameters();
    match arguments.model {
        ModelName::Dcom => {
            let model = dcom::Model::new(&parameters);
            let flight = Flight {
                name: "dcom",
                model: &model,
                state_bounds: dcom::STATE_BOUNDS,
                input_bounds: dcom::INPUT_BOUNDS,
                seed: None,
            };
            flight.simulate(arguments, &grid, |x, u, step| {
                Rk4::new(grid.step_length(step)).step(&model, x, u)
            })
        }
        ModelName::Sdcom => {
            let model = sdcom::Model::new(&parameters);
            let channels = <sdcom::Noise<f64> as Vector<f64>>::LEN;
            let mut wiener = WienerSource::new(arguments.seed, MEMBER, channels);
            let flight = Flight {
                name: "sdcom",
                model: &model,
                state_bounds: sdcom::STATE_BOUNDS,
                input_bounds: sdcom::INPUT_BOUNDS,
                seed: Some(arguments.seed),
            };
            flight.simulate(arguments, &grid, |x, u, step| {
                let dt = grid.step_length(step);
                EulerMaruyama::new(dt).step(&model, x, u, &wiener.increments(step, dt))
            })
        }
    }
}
