//! `ahv montecarlo`: many flights with noise and dispersions.

#[cfg(feature = "parquet")]
pub(crate) mod campaign;
mod causes;
mod figure;
mod members;
mod report;
mod tables;
mod text;
mod trajectories;

use std::path::PathBuf;

use ahv_analysis::monte_carlo::{MemberRecord, Outcome};
use ahv_core::Bounds;
use clap::Args;

use crate::assignment::Assignments;
use crate::failure::{Failure, all, complain, print};
use crate::flights::{Flights, Ready, watched};
use crate::output;
use crate::progress::{Progress, Work};
use crate::show::show;
use crate::vehicle::Vehicle;
use causes::{Cause, Kept};
use members::MemberList;
use trajectories::Format;

/// Flies a stochastic model many times and tells how the flights spread.
///
/// Members start at the trim and hold its inputs, or follow a state feedback. They fly eight at a time with the vector
/// instructions of the machine. The same seed gives the same numbers whatever the threads, and with the mode exact on every
/// machine. A member whose state is no longer finite is lost: it is counted, and left out of what is reported from then on. One
/// that leaves the validity box is counted and flies on. Ctrl-C or SIGTERM ends the work, and the members flown so far are reported.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    flights: Flights,

    /// Flights
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000_000))]
    members: u64,

    /// Fly a linear companion beside each member, whose mean and variance are known, and take from the means and standard deviations
    /// what chance did to both: their intervals get much narrower where the flights are nearly linear
    #[arg(long)]
    control_variate: bool,

    /// Limits of states whose violation is told, e.g. alpha=-2deg..6deg
    #[arg(
        long,
        value_name = "NAME=LOW..HIGH",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    limit: Vec<String>,

    /// Times at which the spread is told, in equal parts of the flight
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    snapshots: u64,

    /// Members whose whole flights are written, e.g. 0,7,100
    #[arg(long, value_name = "MEMBERS", value_delimiter = ',')]
    trajectories: Vec<u64>,

    /// File format of the trajectories; parquet is there in a program built with the feature `parquet`
    #[arg(long, value_enum, default_value_t = Format::Csv, requires = "trajectories")]
    trajectory_format: Format,

    /// Folder for montecarlo.svg, summary.json, snapshots.csv, histograms.csv, limits.csv, members.csv and trajectories
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,

    #[cfg(feature = "parquet")]
    #[command(flatten)]
    campaign: campaign::CampaignArguments,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim,
/// [`Failure::Interrupted`] once the part is reported that was flown.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.run()
}

/// What was flown, and what came of it.
struct Summary<'a> {
    arguments: &'a Arguments,
    ready: Ready,
    outcome: Outcome,
    causes: Vec<Cause>,
}

impl Arguments {
    fn run(&self) -> Result<(), Failure> {
        let mut ready = self.flights.ready()?;
        let experiment = &mut ready.experiment;
        experiment.snapshots = snapshots(experiment.steps(), self.snapshots);
        experiment.control_variate = self.control_variate;
        experiment
            .watched
            .extend(limits(&self.limit, &ready.vehicle)?);
        // Before the work: what cannot be written is not found out after it.
        trajectories::check(self)?;
        #[cfg(feature = "parquet")]
        if self.part_of_campaign(&ready)?.is_some() {
            return Ok(());
        }
        if let Some(folder) = &self.out {
            output::folder(folder)?;
        }
        let folder = self.out.as_deref();
        if self.trajectories.is_empty()
            && let Some(folder) = folder
        {
            output::warn_of_earlier(folder, &["trajectories.csv", "trajectories.parquet"]);
        }
        #[cfg(feature = "parquet")]
        let campaign = folder.filter(|_| self.campaign.resume);
        #[cfg(feature = "parquet")]
        let campaign = campaign.map(|folder| campaign::Campaign::lead(self, &ready, folder));
        #[cfg(feature = "parquet")]
        let campaign = campaign.transpose()?;
        let list = folder.map(|folder| MemberList::create(&ready, folder, self.members));
        let mut list = list.transpose()?;
        let progress = Progress::start(Work {
            command: "montecarlo",
            unit: "member-steps",
            total: Some(self.members.saturating_mul(ready.experiment.steps())),
        });
        let threads = ready.threads(self.members);
        let mut kept = Kept::default();
        let outcome = watched(progress, |control| {
            let engine = ready.vehicle.model.engine(&ready.experiment)?;
            let mut listed = |first, seen: &[MemberRecord]| {
                kept.add(&ready, first, seen);
                if let Some(list) = &mut list {
                    list.add(first, seen);
                }
            };
            #[cfg(feature = "parquet")]
            if let Some(campaign) = &campaign {
                return Ok(campaign.gather(&engine, control, listed));
            }
            let flown = engine.run_and_list(self.members, threads, control, &mut listed)?;
            Ok(Ok(flown))
        })??;
        let complete = outcome.members == outcome.asked;
        let listed = list.map_or(Ok(()), |list| list.finish(complete));
        let told = Summary {
            arguments: self,
            causes: kept.causes(&ready),
            ready,
            outcome,
        };
        if let Some(warning) = told.warning() {
            complain(&warning);
        }
        // Whatever fails, the rest is reported; pictures come last.
        let numbers = folder.map_or(Ok(()), |folder| told.write(folder));
        let printed = if self.json {
            output::print_json(&told.json())
        } else {
            print(&told.text())
        };
        let drawn = folder.map_or(Ok(()), |folder| told.draw(folder));
        all([listed, numbers, printed, drawn])?;
        if told.is_complete() {
            return Ok(());
        }
        Err(Failure::Interrupted(format!(
            "interrupted: {} of {} members were flown, and are reported",
            told.outcome.members, told.outcome.asked
        )))
    }
}

/// Numbers of steps: 0, and the ends of equal parts, as far as steps allow.
fn snapshots(steps: u64, parts: u64) -> Vec<u64> {
    let parts = parts.min(steps);
    (0..=parts)
        .map(|part| (u128::from(steps) * u128::from(part) / u128::from(parts)) as u64)
        .collect()
}

/// Limits of the user's; `None` if there are none. States without are not limited.
fn limits(texts: &[String], vehicle: &Vehicle) -> Result<Option<Vec<Bounds>>, Failure> {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for text in texts {
        let form = || {
            Failure::Request(format!(
                "--limit: `{text}` is not of the form NAME=LOW..HIGH, e.g. alpha=-2deg..6deg"
            ))
        };
        let (name, ends) = text.split_once('=').ok_or_else(form)?;
        let (min, max) = ends.split_once("..").ok_or_else(form)?;
        let unit = vehicle.states.unit(name.trim());
        if unit.starts_with("rad") && [min, max].iter().any(|it| it.trim().parse::<f64>().is_ok()) {
            return Err(Failure::Request(format!(
                "--limit: {name} is an angle, and each end needs a unit: {name}={}deg..{}deg",
                min.trim_end_matches("deg"),
                max.trim_end_matches("deg")
            )));
        }
        low.push(format!("{name}={min}"));
        high.push(format!("{name}={max}"));
    }
    if texts.is_empty() {
        return Ok(None);
    }
    let states = vehicle.states;
    let parse = |texts: &[String], infinite: f64| -> Result<Vec<f64>, Failure> {
        let mut ends = vec![infinite; states.len()];
        Assignments::parse("--limit", texts, states)?.apply(&mut ends);
        Ok(ends)
    };
    let (low, high) = (
        parse(&low, f64::NEG_INFINITY)?,
        parse(&high, f64::INFINITY)?,
    );
    let ends = low.into_iter().zip(high);
    let bounds: Vec<Bounds> = ends.map(|(low, high)| Bounds::new(low, high)).collect();
    let mut named = states.iter().zip(&bounds);
    match named.find(|(_, it)| it.min >= it.max) {
        Some(((name, unit), &Bounds { min, max })) => Err(Failure::Request(format!(
            "--limit: of {name} the lower limit {} is not below the upper one {}",
            show(min, unit),
            show(max, unit)
        ))),
        None => Ok(Some(bounds)),
    }
}
