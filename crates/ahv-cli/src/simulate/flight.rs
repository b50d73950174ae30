//! One simulation, for any model.

use ahv_analysis::erased::{Advance, Fly};
use ahv_integrate::{self as integrate, TimeGrid};

use super::Arguments;
use super::report::{Adaptive, Departure, Report};

use crate::assignment::Assignments;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::labels::Labels;
use crate::number::Shown;
use crate::progress::{Progress, Work};
use crate::vehicle::Vehicle;

/// How the state moves from row to row.
pub(super) enum Motion {
    /// By one step.
    Fixed(Advance),
    /// By steps as long as a tolerance allows.
    Adaptive(Fly),
}

/// A vehicle with how it is to fly.
pub(super) struct Flight<'a> {
    pub(super) vehicle: &'a Vehicle,
    /// Name of the stepper.
    pub(super) scheme: &'a str,
    /// `None` without noise.
    pub(super) seed: Option<u64>,
}

impl Flight<'_> {
    /// Simulates over `grid`.
    ///
    /// # Errors
    ///
    /// As [`run`](super::run).
    pub(super) fn simulate(
        &self,
        arguments: &Arguments,
        grid: &TimeGrid,
        mut motion: Motion,
    ) -> Result<(), Failure> {
        let vehicle = self.vehicle;
        let (start, u) = self.start(arguments)?;
        let mut run = integrate::Progress::new(0.0, start.clone());
        let mut table = CsvFile::create(&arguments.out)?;
        table.row(&columns(vehicle.states))?;
        let progress = Progress::start(Work {
            command: "simulate",
            unit: "steps",
            total: Some(grid.steps().into()),
        });
        let (mut departure, mut passages) = (None, Vec::new());
        let mut row = Vec::with_capacity(start.len() + 1);
        for step in 0..=grid.steps() {
            let (time, x) = (run.time, &run.state);
            row.clear();
            row.push(time);
            row.extend(x);
            table.numbers(&row)?;
            if departure.is_none() {
                let mut outside = vehicle.states.outside(x, &vehicle.state_bounds);
                departure = outside.next().map(|outside| Departure { time, outside });
            }
            progress.reach(step.into());
            if step == grid.steps() {
                break;
            }
            let moved = match &mut motion {
                Motion::Fixed(advance) => {
                    let moved = grid.step(&mut run, |x, step, dt| advance(x, &u, step, dt));
                    moved.map(drop)
                }
                Motion::Adaptive(fly) => {
                    let next = grid.time(step + 1);
                    fly(&mut run, &u, next, &mut |passage| passages.push(passage))
                }
            };
            moved.map_err(|failure| self.broken(&failure, &run, &u, &arguments.out))?;
        }
        drop(progress);
        table.finish()?;
        let input_outside = vehicle.inputs.outside(&u, &vehicle.input_bounds).next();
        let report = Report {
            vehicle,
            grid,
            scheme: self.scheme,
            adaptive: arguments.tolerance.map(|tolerance| Adaptive {
                tolerance,
                accepted: run.accepted,
                refused: run.refused,
                boundaries: passages,
            }),
            seed: self.seed,
            initial_state: start,
            final_state: run.state,
            input_outside,
            input: u,
            out: &arguments.out,
            departure,
        };
        report.tell(arguments.json)
    }

    /// Initial state and held input: the trim, with what the arguments put in its place.
    fn start(&self, arguments: &Arguments) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let states = self.vehicle.states;
        let initial = Assignments::parse("--initial", &arguments.initial, states)?;
        let (flight, inputs) = arguments.condition.flight_and_inputs(self.vehicle)?;
        let trim = self.vehicle.trim(&flight)?;
        let (mut x, mut u) = (trim.state, trim.input);
        inputs.apply(&mut u);
        initial.apply(&mut x);
        self.vehicle
            .moves(&x)
            .map_err(|why| Failure::Request(format!("--initial: {why}")))?;
        Ok((x, u))
    }

    fn broken(
        &self,
        failure: &integrate::Failure,
        last_good: &integrate::Progress<Vec<f64>>,
        u: &[f64],
        out: &std::path::Path,
    ) -> Failure {
        Failure::Numeric(format!(
            "{}: {failure}{}; {} was not written\nthe last good state, at {} s:\n{}",
            self.vehicle.name(),
            self.vehicle.fault_after(&last_good.state, u),
            out.display(),
            Shown(last_good.time),
            self.vehicle.states.describe(&last_good.state)
        ))
    }
}

fn columns(states: Labels) -> Vec<String> {
    let states = states.iter().map(|(name, unit)| format!("{name} [{unit}]"));
    std::iter::once("time [s]".to_owned())
        .chain(states)
        .collect()
}
