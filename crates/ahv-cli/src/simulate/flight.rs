//! One simulation, for any model.

use ahv_analysis::trim::{LevelFlight, SOUGHT_INPUTS, trim};
use ahv_core::{Bounds, DifferentiableModel, Vector, first_outside};
use ahv_integrate::StepError;

use super::Arguments;
use super::grid::Grid;
use super::progress::Progress;
use super::report::{Departure, Report, describe};
use super::table::Table;
use crate::assignment::Assignments;
use crate::failure::Failure;

/// Velocity in ft/s of the trim from which a run starts.
const TRIM_VELOCITY: f64 = 7702.0808;

/// Altitude in ft of the trim from which a run starts.
const TRIM_ALTITUDE: f64 = 85_000.0;

/// A model with what a simulation needs to know of it.
pub(super) struct Flight<'a, M, SB, IB> {
    pub(super) name: &'static str,
    pub(super) model: &'a M,
    pub(super) state_bounds: SB,
    pub(super) input_bounds: IB,
    /// `None` for a deterministic model.
    pub(super) seed: Option<u64>,
}

impl<M, SB, IB> Flight<'_, M, SB, IB>
where
    M: DifferentiableModel<Scalar = f64>,
    SB: Vector<Bounds>,
    IB: Vector<Bounds>,
{
    /// Simulates over `grid`; `advance` takes the step whose number it is given.
    ///
    /// # Errors
    ///
    /// As [`run`](super::run).
    pub(super) fn simulate(
        &self,
        arguments: &Arguments,
        grid: &Grid,
        mut advance: impl FnMut(&mut M::State, &M::Input, u64) -> Result<(), StepError<f64>>,
    ) -> Result<(), Failure> {
        let (mut x, u) = self.start(arguments)?;
        let mut table = Table::create(&arguments.out)?;
        table.header(&columns::<M::State>())?;
        let mut progress = Progress::new(grid.steps);
        let mut departure = None;
        let mut row = Vec::with_capacity(M::State::LEN + 1);
        for step in 0..=grid.steps {
            let time = grid.time(step);
            row.clear();
            row.push(time);
            row.extend((0..M::State::LEN).filter_map(|index| x.get(index)));
            table.row(&row)?;
            if departure.is_none() {
                departure = first_outside(&x, &self.state_bounds)
                    .map(|outside| Departure { time, outside });
            }
            if step < grid.steps {
                advance(&mut x, &u, step)
                    .map_err(|error| self.broken(&error, grid, step, &x, &arguments.out))?;
            }
            progress.tell(step);
        }
        drop(progress);
        table.finish()?;
        let report = Report {
            model: self.name,
            grid,
            seed: self.seed,
            final_state: x,
            input: u,
            out: &arguments.out,
            departure,
            input_outside: first_outside(&u, &self.input_bounds),
        };
        report.tell(arguments.json)
    }

    /// Initial state and held input: the trim, with what the arguments put in its place.
    fn start(&self, arguments: &Arguments) -> Result<(M::State, M::Input), Failure> {
        let inputs = Assignments::parse::<M::Input>("--input", &arguments.input)?;
        let initial = Assignments::parse::<M::State>("--initial", &arguments.initial)?;
        let delta_c = inputs.get::<M::Input>("delta_c").unwrap_or(0.0);
        if !arguments.has_canard() && delta_c != 0.0 {
            return Err(Failure::Request(
                "--input: delta_c moves a canard, and there is none; add --canard free or --canard slaved"
                    .to_owned(),
            ));
        }
        let mut level = LevelFlight::new(TRIM_VELOCITY, TRIM_ALTITUDE);
        inputs.apply(&mut level.input, &SOUGHT_INPUTS);
        let trim = trim(self.model, &level).map_err(|error| {
            Failure::Numeric(format!(
                "{}: {error} (level flight at {TRIM_VELOCITY} ft/s and {TRIM_ALTITUDE} ft)",
                self.name
            ))
        })?;
        let (mut x, mut u) = (trim.state, trim.input);
        inputs.apply(&mut u, &[]);
        initial.apply(&mut x, &[]);
        Ok((x, u))
    }

    fn broken(
        &self,
        error: &StepError<f64>,
        grid: &Grid,
        step: u64,
        last_good: &M::State,
        out: &std::path::Path,
    ) -> Failure {
        Failure::Numeric(format!(
            "{}: {error} at {} s; {} was not written\nthe last good state, at {} s:\n{}",
            self.name,
            grid.time(step + 1),
            out.display(),
            grid.time(step),
            describe(last_good)
        ))
    }
}

fn columns<X: Vector<f64>>() -> Vec<String> {
    let states = X::NAMES
        .iter()
        .zip(X::UNITS)
        .map(|(name, unit)| format!("{name} [{unit}]"));
    std::iter::once("time [s]".to_owned())
        .chain(states)
        .collect()
}
