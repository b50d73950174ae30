//! `ahv rare`: how likely an event is that hardly ever happens.

use std::fmt::Write;

use ahv_analysis::monte_carlo::{
    FEWEST_REPETITIONS, MonteCarloError, RareError, RareEstimate, RareEvent,
};
use ahv_analysis::statistics::Estimate;
use clap::Args;
use serde::Serialize;

use crate::assignment::Assignments;
use crate::failure::{Failure, print};
use crate::flights::{Flights, Ready, Settings, watched};
use crate::number::Shown;
use crate::output;
use crate::progress::{Progress, Work};
use crate::registry::needs_noise;
use crate::show::show;
use crate::signals::interrupted;
use crate::vehicle::Heading;

/// Estimates the probability that a state passes a limit before the flight ends, however small it is.
///
/// By importance splitting: members that pass a level on the way to the limit are copied, and the copies fly on with noise of
/// their own. A pilot sets the levels. The flights are those of `ahv montecarlo`, which counts what happens often enough to
/// be counted. The same seed gives the same numbers whatever the threads. Ctrl-C or SIGTERM ends the work; the repetitions flown
/// so far are reported if they make an estimate.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    flights: Flights,

    /// State and limit, above or below where the flights start, e.g. alpha=4deg
    #[arg(long, value_name = "NAME=VALUE")]
    passes: String,

    /// Members that start from each level
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(2..=1_000_000))]
    effort: u64,

    /// Independent repetitions, whose spread gives the interval
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(FEWEST_REPETITIONS..=10_000))]
    repetitions: u64,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input, [`Failure::Numeric`] if there is no trim or no member comes near the limit,
/// [`Failure::Interrupted`].
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.run()
}

impl Arguments {
    fn run(&self) -> Result<(), Failure> {
        let model = self.flights.vehicle.model()?;
        needs_noise("--model", model, ", by which copies part")?;
        let mut ready = self.flights.ready()?;
        // The validity box is not reported.
        ready.experiment.watched.clear();
        let states = ready.vehicle.states;
        let (state, limit) = Assignments::one("--passes", &self.passes, states)?;
        let event = RareEvent {
            state,
            limit,
            effort: self.effort,
            levels: None,
            repetitions: self.repetitions,
        };
        let progress = Progress::start(Work {
            command: "rare",
            unit: "member-steps",
            total: None,
        });
        let threads = ready.threads(self.effort);
        let found = watched(progress, |control| {
            let engine = model.engine(&ready.experiment)?;
            match engine.first_passage(&event, threads, control) {
                Err(MonteCarloError::Rare(error)) => Ok(Err(error)),
                other => other.map(Ok),
            }
        })?;
        // There it was found.
        let (name, unit) = states.iter().nth(state).unwrap_or_default();
        let estimate = found.map_err(|error| failure(&error, self.effort, unit))?;
        let told = Summary {
            ready,
            name,
            unit,
            event,
            estimate,
        };
        if self.json {
            output::print_json(&told.json())?;
        } else {
            print(&told.text())?;
        }
        let flown = told.estimate.repetitions;
        if told.is_complete() {
            return Ok(());
        }
        Err(Failure::Interrupted(format!(
            "interrupted: {flown} of {} repetitions were flown, and are reported",
            self.repetitions
        )))
    }
}

fn failure(error: &RareError, effort: u64, unit: &str) -> Failure {
    match error {
        RareError::Stopped {
            levels,
            repetitions,
            asked,
            member_steps,
        } => {
            let levels: Vec<String> = levels.iter().map(|level| show(*level, unit)).collect();
            let pilot = match levels.as_slice() {
                [] => "the pilot had set no level".to_owned(),
                levels => format!("the pilot had set the levels {}", levels.join(", ")),
            };
            Failure::Interrupted(format!(
                "interrupted: {pilot}; {repetitions} of {asked} repetitions of {effort} members a level were flown, \
                 {member_steps} member-steps in all; there is no estimate, which takes {FEWEST_REPETITIONS} repetitions that \
                 differ"
            ))
        }
        RareError::OutOfReach { level } => Failure::Numeric(format!(
            "the members come no nearer to the limit than {}; a greater --effort may",
            show(*level, unit)
        )),
        RareError::NoSpread { .. } | RareError::Lost => Failure::Numeric(error.to_string()),
        _ => Failure::Request(format!("--passes: {error}")),
    }
}

/// What was asked, and what came of it.
struct Summary {
    ready: Ready,
    /// Name and unit of the state.
    name: &'static str,
    unit: &'static str,
    event: RareEvent,
    estimate: RareEstimate,
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    state: &'static str,
    unit: &'static str,
    limit: f64,
    time: f64,
    #[serde(flatten)]
    estimate: &'a RareEstimate,
    ratio: f64,
    effort: u64,
    asked: u64,
    complete: bool,
    #[serde(flatten)]
    settings: Settings,
}

impl Summary {
    /// Whether all repetitions were flown that were asked for.
    fn is_complete(&self) -> bool {
        self.estimate.repetitions == self.event.repetitions
    }

    /// Steps of plain sampling to one of splitting, for an interval as wide.
    fn ratio(&self) -> f64 {
        self.estimate.plain_member_steps / self.estimate.member_steps as f64
    }

    fn json(&self) -> Json<'_> {
        Json {
            heading: self.ready.vehicle.heading(),
            state: self.name,
            unit: self.unit,
            limit: self.event.limit,
            time: self.ready.duration(),
            estimate: &self.estimate,
            ratio: self.ratio(),
            effort: self.event.effort,
            asked: self.event.repetitions,
            complete: self.is_complete(),
            settings: self.ready.settings(self.event.effort),
        }
    }

    fn text(&self) -> String {
        let Ready {
            vehicle,
            place,
            experiment,
            ..
        } = &self.ready;
        let (name, unit) = (self.name, self.unit);
        let Estimate { value, low, high } = self.estimate.probability;
        let [value, low, high] = [value, low, high].map(Shown);
        let (flown, asked) = (self.estimate.repetitions, self.event.repetitions);
        let repetitions = if self.is_complete() {
            format!("{flown} repetitions")
        } else {
            interrupted(flown, asked, "repetitions")
        };
        let mut text = format!(
            "{}: {place}, {}\n{name} passes {} within {} s with probability {value:.3e} [{low:.3e}, {high:.3e}]\nlevels, and the share that passes each from the one before",
            vehicle.name(),
            vehicle.described(),
            show(self.event.limit, unit),
            Shown(self.ready.duration()),
        );
        // Writing into a String cannot fail.
        for level in &self.estimate.levels {
            let _ = write!(
                text,
                "\n  {}: {:.3}",
                show(level.value, unit),
                Shown(level.share)
            );
        }
        let _ = write!(
            text,
            "\n{repetitions} of {} members a level, {} {} s, {}, seed {}\n{:.3e} member-steps; for an interval as wide, plain sampling takes {:.3e}, {:.2e} times as many\nlost, with a state that was no longer finite, or parameters that break a rule: {}",
            self.event.effort,
            experiment.scheme.name(),
            Shown(experiment.dt),
            experiment.mode.name(),
            experiment.seed,
            self.estimate.member_steps as f64,
            Shown(self.estimate.plain_member_steps),
            Shown(self.ratio()),
            self.estimate.lost,
        );
        text
    }
}
