//! `ahv track`: closed loops that track a manoeuvre.

mod figure;
mod tables;

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use ahv_analysis::track::{Controller, Flight, PERIOD, Statistics, TrackError, Trial};
use ahv_models::dcom;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::failure::{Failure, print};
use crate::output;
use crate::progress::Progress;

/// Most flights.
const MOST_RUNS: u64 = 100_000;
/// Steps of the progress bar that a flight counts for.
const STEPS_PER_FLIGHT: u64 = 9000;

/// Flies a manoeuvre in closed loop, DCOM as the truth with its noise.
///
/// From the trim at 7702.0808 ft/s and 85000 ft (set section5.1, no canard, flat Earth) 300 ft/s and 1500 ft more are
/// commanded, through filters of third order, over 90 s. The controllers were designed on SDCOM: stochastic backstepping with
/// command filters on its strict-feedback form, and a linear-quadratic regulator on its linearisation. They sample
/// V, h, gamma, alpha, Q and the actuators' positions at 100 Hz. Both meet the same noise.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Controller
    #[arg(long, value_enum, default_value_t = Choice::Both)]
    controller: Choice,

    /// Flights of each controller, two at least: one tells nothing of a spread
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: u64,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Folder for tracking.svg, statistics.csv and the first flight of each controller, e.g. backstepping.csv
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Choice {
    /// Stochastic backstepping
    Backstepping,
    /// Linear-quadratic regulator
    Lqr,
    /// Both
    Both,
}

/// The flights of a controller.
struct Outcome {
    controller: &'static str,
    flights: Vec<Flight>,
    statistics: Statistics,
    /// Of the closed loop at the trim, in 1/s.
    poles: Vec<[f64; 2]>,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for files that cannot be written, [`Failure::Numeric`] if there is no trim or no controller.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let trial = Trial::standard(dcom::NOMINAL, arguments.runs, arguments.seed);
    let chosen = |choice| arguments.controller == Choice::Both || arguments.controller == choice;
    let controllers = [Choice::Backstepping, Choice::Lqr]
        .into_iter()
        .filter(|&choice| chosen(choice));
    let flights = arguments.runs * controllers.clone().count() as u64;
    let progress = Mutex::new((Progress::new(flights * STEPS_PER_FLIGHT), 0));
    let flown = || {
        if let Ok(mut held) = progress.lock() {
            held.1 += STEPS_PER_FLIGHT;
            let done = held.1;
            held.0.tell(done);
        }
    };
    let mut outcomes = Vec::new();
    for choice in controllers {
        outcomes.push(match choice {
            Choice::Lqr => fly(&trial, "lqr", &trial.linear().map_err(numeric)?, flown)?,
            _ => fly(&trial, "backstepping", &trial.backstepping(), flown)?,
        });
    }
    drop(progress);
    write_parts(&arguments.out, &outcomes)?;
    if arguments.json {
        output::print_json(&Json::new(&trial, &outcomes))
    } else {
        print(&text(&trial, &outcomes, &arguments.out))
    }
}

fn fly<C: Controller>(
    trial: &Trial,
    name: &'static str,
    controller: &C,
    flown: impl Fn() + Sync,
) -> Result<Outcome, Failure> {
    let flights = trial.fly(controller, flown).map_err(numeric)?;
    let statistics = Statistics::of(&flights);
    let model = dcom::Model::new(&trial.truth);
    let (closed, rest) = trial.closed(&model, controller).map_err(numeric)?;
    let poles = closed
        .poles(&rest)
        .map_err(|error| Failure::Numeric(error.to_string()))?;
    Ok(Outcome {
        controller: name,
        statistics: statistics.ok_or_else(|| Failure::Numeric("no flights".to_owned()))?,
        flights,
        poles: poles.iter().map(|pole| [pole.re, pole.im]).collect(),
    })
}

fn numeric(error: TrackError) -> Failure {
    Failure::Numeric(error.to_string())
}

/// Writes picture and tables.
fn write_parts(folder: &Path, outcomes: &[Outcome]) -> Result<(), Failure> {
    output::folder(folder)?;
    let svg = figure::draw(outcomes).map_err(|error| Failure::Numeric(error.to_string()))?;
    output::write(&folder.join("tracking.svg"), svg)?;
    output::write(&folder.join("statistics.csv"), tables::statistics(outcomes))?;
    for outcome in outcomes {
        if let Some(flight) = outcome.flights.first() {
            let path = folder.join(format!("{}.csv", outcome.controller));
            output::write(&path, tables::flight(flight))?;
        }
    }
    Ok(())
}

/// The outcome as JSON.
#[derive(Serialize)]
struct Json<'a> {
    runs: u64,
    seed: u64,
    duration: f64,
    sampling_period: f64,
    controllers: Vec<JsonOutcome<'a>>,
}

#[derive(Serialize)]
struct JsonOutcome<'a> {
    controller: &'static str,
    poles: &'a [[f64; 2]],
    statistics: &'a Statistics,
}

impl<'a> Json<'a> {
    fn new(trial: &Trial, outcomes: &'a [Outcome]) -> Self {
        let controllers = outcomes.iter().map(|outcome| JsonOutcome {
            controller: outcome.controller,
            poles: &outcome.poles,
            statistics: &outcome.statistics,
        });
        Self {
            runs: trial.runs,
            seed: trial.seed,
            duration: trial.duration,
            sampling_period: PERIOD,
            controllers: controllers.collect(),
        }
    }
}

fn text(trial: &Trial, outcomes: &[Outcome], folder: &Path) -> String {
    let mut text = format!(
        "{} flights of {} s for each controller, seed {}; picture and tables are in {}\n\
         mean over the flights [its interval of 95 %], 5 % and 95 % points, least and largest",
        trial.runs,
        trial.duration,
        trial.seed,
        folder.display()
    );
    // Writing into a String cannot fail.
    for outcome in outcomes {
        let statistics = &outcome.statistics;
        let rightmost = outcome.poles.first().map_or(f64::NAN, |pole| pole[0]);
        let _ = write!(
            text,
            "\n\n{}: {} lost, {} left the validity box; rightmost pole at the trim {rightmost:.3}/s",
            outcome.controller, statistics.lost.flights, statistics.left_validity_box.flights
        );
        for figure in &statistics.figures {
            let (mean, spread) = (&figure.mean, &figure.spread);
            let unit = if figure.unit == "1" { "" } else { figure.unit };
            let _ = write!(
                text,
                "\n  {:<26}{:>9.4} [{:.4}, {:.4}]  {:.4} {:.4}  {:.4} {:.4} {unit}",
                figure.name,
                mean.value,
                mean.low,
                mean.high,
                spread.low,
                spread.high,
                figure.least,
                figure.largest
            );
        }
    }
    text
}
