//! `ahv trim`: steady flight at a point, or over the box of velocity and altitude.

mod map;
mod report;

use std::path::PathBuf;

use ahv_analysis::trim::trim;
use clap::Args;

use crate::condition::{Condition, Vehicle};
use crate::failure::{Failure, print};
use crate::output;
use crate::place::Place;
use crate::vehicle::{FlightModel, for_model};
use map::{Map, Size};
use report::Report;

/// Finds the state and input of steady flight.
///
/// A damped Newton method with the model's own Jacobian, from a cold start, phi and delta_e inside their validity box.
/// Where there is no trim, it reports the nearest point and the bounds that block, and ends with code 3.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

    /// Trim at VxH points over the validity box of velocity and altitude, e.g. 20x20
    #[arg(long, value_name = "VxH", requires = "out", conflicts_with_all = ["velocity", "altitude"])]
    map: Option<Size>,

    /// Folder for trim_map.csv and trim_map.svg
    #[arg(long, value_name = "DIR", requires = "map")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim; the
/// JSON is printed then all the same.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    for_model!(arguments.condition.model, Model => {
        let vehicle: Vehicle<Model> = arguments.condition.vehicle()?;
        match (arguments.map, &arguments.out) {
            (Some(size), Some(folder)) => {
                let flight = arguments.place.flight(&vehicle)?;
                output::folder(folder)?;
                let map = Map::new(&vehicle, &flight, size);
                // Whatever fails, the rest is reported; the picture comes last.
                let written = map.write(folder);
                let printed =
                    if arguments.json { output::print_json(&map.json()) } else { print(&map.text(folder)) };
                written.and(printed).and(map.draw(folder))
            }
            _ => at_a_point(arguments, &vehicle),
        }
    })
}

fn at_a_point<M: FlightModel>(arguments: &Arguments, vehicle: &Vehicle<M>) -> Result<(), Failure> {
    let flight = arguments.place.flight(vehicle)?;
    let result = trim(&vehicle.model, &flight);
    let report = Report::new(vehicle, &flight, &result);
    if arguments.json {
        output::print_json(&report.json())?;
    } else {
        print(&report.text())?;
    }
    match result {
        Ok(_) => Ok(()),
        Err(error) => {
            let (why, place) = (vehicle.no_trim(&error), vehicle.at(&flight));
            Err(Failure::Numeric(format!("{}: {why} ({place})", M::NAME)))
        }
    }
}
