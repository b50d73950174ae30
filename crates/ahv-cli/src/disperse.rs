//! `ahv disperse`: how uncertain parameters spread trim, poles and zeros.

mod figure;
mod group;
mod report;

use std::path::{Path, PathBuf};

use ahv_analysis::disperse::{
    Distribution, Draws, Member, Nominal, Slopes, SolutionError, Spread, spreads,
};
use clap::{Args, ValueEnum};

use crate::failure::{Failure, all, print};
use crate::flight_condition::FlightCondition;
use crate::output;
use crate::progress::{Progress, Work};
use crate::signals::{Stoppable, interrupted};
use crate::vehicle::{Vehicle, VehicleArgs};

/// Draws parameters within their uncertainty and reports how trim, poles and zeros spread.
///
/// Uncertainties are those of the table, relative to the value. Each member is trimmed inside the bounds of phi and delta_e;
/// one that does not trim is counted, with the reason. Beside the spread of the members stands that to first order, and
/// the parameters it comes from. Ctrl-C or SIGTERM ends the work, and the members drawn so far are reported.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// Vehicles to draw
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(30..=1_000_000))]
    members: u64,

    /// Seed of the draws: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// How a parameter lies within its uncertainty
    #[arg(long, value_enum, default_value = "uniform")]
    distribution: Shape,

    /// Parameters to draw: names, or what names begin with, e.g. c_l,c_m_alpha [default: all that are uncertain]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    vary: Vec<String>,

    /// Parameters that move together, with their correlation (1 if not given), e.g. lift=c_l_alpha,c_l_delta_e:0.8
    /// or moment=c_m:0.5
    #[arg(long, value_name = "NAME=NAMES:CORRELATION")]
    group: Vec<String>,

    /// Parameters to print for each quantity, those that matter most
    #[arg(long, value_name = "N", default_value_t = 8)]
    top: usize,

    /// Folder for members.csv, trim.svg, roots.svg and sensitivities.svg
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,
}

/// A distribution, on the command line.
#[derive(Clone, Copy, ValueEnum)]
enum Shape {
    /// Uniform between value (1 - uncertainty) and value (1 + uncertainty)
    Uniform,
    /// Normal; the uncertainty is three standard deviations
    Normal,
}

/// What came of the draws.
struct Outcome<'a> {
    vehicle: &'a Vehicle,
    arguments: &'a Arguments,
    draws: Draws,
    nominal: Nominal,
    members: Vec<Member>,
    spreads: Vec<Option<Spread>>,
    slopes: Slopes,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or files that cannot be written, [`Failure::Numeric`] if the vehicle of the table
/// does not trim.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    let model = vehicle.model;
    let draws = draws(&vehicle, arguments)?;
    let flight = arguments.condition.flight(&vehicle)?;
    let place = vehicle.at(&flight);
    let failed = |error: SolutionError| {
        let why = match &error {
            SolutionError::Trim(error) => vehicle.no_trim(error),
            other => other.to_string(),
        };
        Failure::Numeric(format!("{}: {why} ({place})", vehicle.name()))
    };
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let nominal = model.nominal(&vehicle.parameters, flight).map_err(failed)?;
    let slopes = model.slopes(&draws, &nominal).map_err(failed)?;
    let progress = Progress::start(Work {
        command: "disperse",
        unit: "members",
        total: Some(arguments.members),
    });
    let stoppable = Stoppable::new(progress.control());
    let members = model.disperse(&draws, &nominal, arguments.members, progress.control());
    drop(stoppable);
    drop(progress);
    if members.is_empty() {
        return Err(Failure::Interrupted(
            "interrupted before the first member".to_owned(),
        ));
    }
    let outcome = Outcome {
        spreads: spreads(&members, nominal.quantities.len()),
        vehicle: &vehicle,
        arguments,
        draws,
        nominal,
        members,
        slopes,
    };
    // Whatever fails, the rest is reported; pictures come last.
    let listed = folder.map_or(Ok(()), |folder| outcome.csv(&folder.join("members.csv")));
    let printed = if arguments.json {
        output::print_json(&outcome.json())
    } else {
        print(&outcome.text())
    };
    let drawn = folder.map_or(Ok(()), |folder| outcome.draw(folder));
    all([listed, printed, drawn])?;
    if outcome.is_complete() {
        return Ok(());
    }
    Err(Failure::Interrupted(format!(
        "interrupted: {} of {} members were drawn, and are reported",
        outcome.members.len(),
        arguments.members
    )))
}

/// What is drawn, as the arguments have it.
fn draws(vehicle: &Vehicle, arguments: &Arguments) -> Result<Draws, Failure> {
    let names = vehicle.model.parameters().names;
    let mut uncertainty = vehicle.uncertainty.clone();
    if !arguments.vary.is_empty() {
        let chosen = group::parameters("--vary", &arguments.vary, names)?;
        let all = uncertainty.iter_mut().enumerate();
        for (_, it) in all.filter(|(index, _)| !chosen.contains(index)) {
            *it = 0.0;
        }
    }
    let groups = group::parse(&arguments.group, names)?;
    let distribution = match arguments.distribution {
        Shape::Uniform => Distribution::Uniform,
        Shape::Normal => Distribution::Normal,
    };
    Draws::of_values(
        names,
        vehicle.parameters.clone(),
        uncertainty,
        distribution,
        groups,
        arguments.seed,
    )
    .map_err(|error| Failure::Request(error.to_string()))
}

impl Outcome<'_> {
    /// Whether all members were drawn that were asked for.
    fn is_complete(&self) -> bool {
        self.members.len() as u64 == self.arguments.members
    }

    /// The mark of the pictures of a part.
    fn mark(&self) -> String {
        interrupted(self.members.len() as u64, self.arguments.members, "members")
    }

    /// Draws the pictures.
    fn draw(&self, folder: &Path) -> Result<(), Failure> {
        all([
            output::picture(&folder.join("trim.svg"), figure::trim(self)),
            output::picture(&folder.join("roots.svg"), figure::roots(self)),
            output::picture(
                &folder.join("sensitivities.svg"),
                figure::sensitivities(self),
            ),
        ])
    }
}
