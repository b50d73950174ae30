//! One simulation, for any model.

use ahv_core::{Vector, first_outside};
use ahv_integrate::StepError;

use super::Arguments;
use super::grid::Grid;
use super::progress::Progress;
use super::report::{Departure, Report, describe};
use super::table::Table;
use crate::assignment::Assignments;
use crate::condition::Vehicle;
use crate::failure::Failure;
use crate::units::Units;
use crate::vehicle::FlightModel;

/// A vehicle with how it is to fly.
pub(super) struct Flight<'a, M: FlightModel> {
    pub(super) vehicle: &'a Vehicle<M>,
    /// `None` without noise.
    pub(super) seed: Option<u64>,
}

impl<M: FlightModel> Flight<'_, M> {
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
        let vehicle = self.vehicle;
        let (start, u) = self.start(arguments)?;
        let mut x = start;
        let mut table = Table::create(&arguments.out)?;
        table.header(&columns::<M::State>(vehicle.units))?;
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
                departure = first_outside(&x, &vehicle.state_bounds)
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
            model: M::NAME,
            set: vehicle.set,
            choices: &vehicle.choices,
            units: vehicle.units,
            grid,
            seed: self.seed,
            initial_state: start,
            final_state: x,
            input: u,
            out: &arguments.out,
            departure,
            input_outside: first_outside(&u, &vehicle.input_bounds),
        };
        report.tell(arguments.json)
    }

    /// Initial state and held input: the trim, with what the arguments put in its place.
    fn start(&self, arguments: &Arguments) -> Result<(M::State, M::Input), Failure> {
        let units = self.vehicle.units;
        let inputs = Assignments::parse::<M::Input>("--input", &arguments.input, units)?;
        let initial = Assignments::parse::<M::State>("--initial", &arguments.initial, units)?;
        let trim = self.vehicle.trim(&inputs)?;
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
            M::NAME,
            grid.time(step + 1),
            out.display(),
            grid.time(step),
            describe(last_good, self.vehicle.units)
        ))
    }
}

fn columns<X: Vector<f64>>(units: Units) -> Vec<String> {
    let states = X::NAMES
        .iter()
        .zip(units.labels::<X>())
        .map(|(name, unit)| format!("{name} [{unit}]"));
    std::iter::once("time [s]".to_owned())
        .chain(states)
        .collect()
}
