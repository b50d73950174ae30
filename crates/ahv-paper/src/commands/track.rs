//! `ahv track`: closed loops that track a manoeuvre.

mod figure;
mod tables;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ahv_analysis::ordered::Control;
use ahv_cli::failure::{Failure, print};
use ahv_cli::number::Shown;
use ahv_cli::output;
use ahv_cli::progress::{Progress, Work};
use ahv_cli::signals::{Stoppable, interrupted};
use ahv_models::dcom;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::track::{Controller, Flight, PERIOD, Statistics, TrackError, Trial};

/// Most flights.
const MOST_RUNS: u64 = 100_000;

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
    // Before the work: what cannot be written is not found out after it.
    output::folder(&arguments.out)?;
    let trial = Trial::standard(dcom::NOMINAL, arguments.runs, arguments.seed);
    let chosen = |choice| arguments.controller == Choice::Both || arguments.controller == choice;
    let controllers = [Choice::Backstepping, Choice::Lqr]
        .into_iter()
        .filter(|&choice| chosen(choice));
    let asked = arguments.runs * controllers.clone().count() as u64;
    let progress = Progress::start(Work {
        command: "track",
        unit: "flights",
        total: Some(asked),
    });
    let control = progress.control();
    let stoppable = Stoppable::new(control);
    let mut outcomes = Vec::new();
    for choice in controllers {
        let outcome = match choice {
            Choice::Lqr => fly(&trial, "lqr", &trial.linear().map_err(numeric)?, control)?,
            _ => fly(&trial, "backstepping", &trial.backstepping(), control)?,
        };
        outcomes.extend(outcome);
    }
    drop(stoppable);
    drop(progress);
    let flown: usize = outcomes.iter().map(|outcome| outcome.flights.len()).sum();
    let mark = interrupted(flown as u64, asked, "flights");
    let complete = mark.is_empty();
    if flown == 0 {
        return Err(Failure::Interrupted(
            "interrupted before the first flight ended".to_owned(),
        ));
    }
    // Whatever fails, the rest is reported; the picture comes last.
    let written = write_tables(&arguments.out, &outcomes, complete);
    let printed = if arguments.json {
        output::print_json(&Json::new(&trial, &outcomes, complete))
    } else {
        let heading = if complete {
            ""
        } else {
            "interrupted: a part of the "
        };
        print(&format!(
            "{heading}{}",
            text(&trial, &outcomes, &arguments.out)
        ))
    };
    let drawn = output::picture(
        &arguments.out.join("tracking.svg"),
        figure::draw(&outcomes, mark),
    );
    written.and(printed).and(drawn)?;
    if complete {
        return Ok(());
    }
    Err(Failure::Interrupted(format!(
        "interrupted: {flown} of {asked} flights were flown, and are reported"
    )))
}

/// The flights of a controller; `None` if a signal came before the first of them.
fn fly<C: Controller>(
    trial: &Trial,
    name: &'static str,
    controller: &C,
    control: &Control,
) -> Result<Option<Outcome>, Failure> {
    let flights = trial.fly(controller, control).map_err(numeric)?;
    let Some(statistics) = Statistics::of(&flights) else {
        return Ok(None);
    };
    let model = dcom::Model::new(&trial.truth);
    let (closed, rest) = trial.closed(&model, controller).map_err(numeric)?;
    let poles = closed
        .poles(&rest)
        .map_err(|error| Failure::Numeric(error.to_string()))?;
    Ok(Some(Outcome {
        controller: name,
        statistics,
        flights,
        poles: poles.iter().map(|pole| [pole.re, pole.im]).collect(),
    }))
}

fn numeric(error: TrackError) -> Failure {
    Failure::Numeric(error.to_string())
}

fn write_tables(folder: &Path, outcomes: &[Outcome], complete: bool) -> Result<(), Failure> {
    let flown = |name: &str| outcomes.iter().any(|it| it.controller == name);
    for other in ["backstepping", "lqr"].iter().filter(|name| !flown(name)) {
        output::warn_of_earlier(folder, &[&format!("{other}.csv")]);
    }
    tables::statistics(&folder.join("statistics.csv"), outcomes, complete)?;
    for outcome in outcomes {
        if let Some(flight) = outcome.flights.first() {
            let path = folder.join(format!("{}.csv", outcome.controller));
            tables::flight(&path, flight)?;
        }
    }
    Ok(())
}

/// The outcome as JSON.
#[derive(Serialize)]
struct Json<'a> {
    runs: u64,
    /// Flights of all controllers.
    flown: usize,
    complete: bool,
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
    fn new(trial: &Trial, outcomes: &'a [Outcome], complete: bool) -> Self {
        let controllers = outcomes.iter().map(|outcome| JsonOutcome {
            controller: outcome.controller,
            poles: &outcome.poles,
            statistics: &outcome.statistics,
        });
        Self {
            runs: trial.runs,
            flown: outcomes.iter().map(|outcome| outcome.flights.len()).sum(),
            complete,
            seed: trial.seed,
            duration: trial.duration,
            sampling_period: PERIOD,
            controllers: controllers.collect(),
        }
    }
}

fn text(trial: &Trial, outcomes: &[Outcome], folder: &Path) -> String {
    let mut text = format!(
        "{} flights of {} s{}, seed {}; picture and tables are in {}\n\
         mean over the flights [its interval of 95 %], 5 % and 95 % points, least and largest",
        trial.runs,
        trial.duration,
        if outcomes.len() > 1 {
            " for each controller"
        } else {
            ""
        },
        trial.seed,
        folder.display()
    );
    // Writing into a String cannot fail.
    for outcome in outcomes {
        let statistics = &outcome.statistics;
        let rightmost = Shown(outcome.poles.first().map_or(f64::NAN, |pole| pole[0]));
        let _ = write!(
            text,
            "\n\n{}: {} flights, {} lost, {} left the validity box; rightmost pole at the trim {rightmost:.3}/s",
            outcome.controller,
            statistics.runs,
            statistics.lost.flights,
            statistics.left_validity_box.flights
        );
        for figure in &statistics.figures {
            let (mean, spread) = (&figure.mean, &figure.spread);
            let unit = if figure.unit == "1" { "" } else { figure.unit };
            let _ = write!(
                text,
                "\n  {:<26}{:>9.4} [{:.4}, {:.4}]  {:.4} {:.4}  {:.4} {:.4} {unit}",
                figure.name,
                Shown(mean.value),
                Shown(mean.low),
                Shown(mean.high),
                Shown(spread.low),
                Shown(spread.high),
                Shown(figure.least),
                Shown(figure.largest)
            );
        }
    }
    text
}
