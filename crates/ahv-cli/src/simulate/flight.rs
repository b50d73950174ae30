//! One simulation, for any model.

use ahv_core::{GeneratedModel, Vector, first_outside};
use ahv_integrate::{self as integrate, TimeGrid};

use super::Arguments;
use super::report::{Departure, Report};
use super::steppers::Advance;

use crate::assignment::Assignments;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::number::Shown;
use crate::output::describe;
use crate::progress::{Progress, Work};
use crate::units::Units;
use crate::vehicle::Vehicle;

/// A vehicle with how it is to fly.
pub(super) struct Flight<'a, M: GeneratedModel> {
    pub(super) vehicle: &'a Vehicle<M>,
    /// `None` without noise.
    pub(super) seed: Option<u64>,
}

impl<M: GeneratedModel> Flight<'_, M> {
    /// Simulates over `grid`; `advance` takes the step of the number and the length in s that it is given.
    ///
    /// # Errors
    ///
    /// As [`run`](super::run).
    pub(super) fn simulate(
        &self,
        arguments: &Arguments,
        grid: &TimeGrid,
        mut advance: Advance<'_, M>,
    ) -> Result<(), Failure> {
        let vehicle = self.vehicle;
        let (start, u) = self.start(arguments)?;
        let mut run = integrate::Progress::new(0.0, start);
        let mut table = CsvFile::create(&arguments.out)?;
        table.row(&columns::<M::State>(vehicle.units))?;
        let progress = Progress::start(Work {
            command: "simulate",
            unit: "steps",
            total: Some(grid.steps().into()),
        });
        let mut departure = None;
        let mut row = Vec::with_capacity(M::State::LEN + 1);
        loop {
            let (time, x) = (run.time, run.state);
            row.clear();
            row.push(time);
            row.extend((0..M::State::LEN).filter_map(|index| x.get(index)));
            table.numbers(&row)?;
            if departure.is_none() {
                departure = first_outside(&x, &vehicle.state_bounds)
                    .map(|outside| Departure { time, outside });
            }
            progress.reach(run.accepted.into());
            let stepped = grid.step(&mut run, |x, step, dt| advance(x, &u, step, dt));
            if !stepped.map_err(|failure| self.broken(&failure, &run, &arguments.out))? {
                break;
            }
        }
        drop(progress);
        table.finish()?;
        let report = Report {
            vehicle,
            grid,
            seed: self.seed,
            initial_state: start,
            final_state: run.state,
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
        let initial = Assignments::parse::<M::State>("--initial", &arguments.initial, units)?;
        let (flight, inputs) = arguments.condition.flight_and_inputs(self.vehicle)?;
        let trim = self.vehicle.trim(&flight)?;
        let (mut x, mut u) = (trim.state, trim.input);
        inputs.apply(&mut u, &[]);
        initial.apply(&mut x, &[]);
        self.vehicle
            .moves(&x)
            .map_err(|why| Failure::Request(format!("--initial: {why}")))?;
        Ok((x, u))
    }

    fn broken(
        &self,
        failure: &integrate::Failure,
        last_good: &integrate::Progress<M::State>,
        out: &std::path::Path,
    ) -> Failure {
        Failure::Numeric(format!(
            "{}: {failure}; {} was not written\nthe last good state, at {} s:\n{}",
            M::NAME,
            out.display(),
            Shown(last_good.time),
            describe(&last_good.state, self.vehicle.units)
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
