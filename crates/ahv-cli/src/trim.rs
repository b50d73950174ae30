//! `ahv trim`: steady flight at a point, or over the box of velocity and altitude.

mod map;
mod report;

use std::path::PathBuf;

use clap::Args;

use crate::failure::{Failure, all, print};
use crate::flight_condition::FlightCondition;
use crate::output;
use crate::vehicle::{Vehicle, VehicleArgs};
use map::{Map, Size};
use report::Report;

/// Finds a steady state, such as level flight, and the inputs that hold it.
///
/// A damped Newton method with the model's own Jacobian, from a cold start, the sought inputs inside their validity box.
/// Where there is no trim, it reports the nearest point and the bounds that block, and ends with code 3.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// Trim at VxH points over the validity box of the first two given states, e.g. 20x20 of velocity and altitude
    #[arg(long, value_name = "VxH", requires = "out")]
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
    let vehicle = arguments.vehicle.vehicle()?;
    let (Some(size), Some(folder)) = (arguments.map, &arguments.out) else {
        return at_a_point(arguments, &vehicle);
    };
    let flight = arguments.condition.flight(&vehicle)?;
    let map = Map::new(&vehicle, &flight, size, arguments.condition.names())?;
    output::folder(folder)?;
    // Whatever fails, the rest is reported; the picture comes last.
    let written = map.write(folder);
    let printed = match arguments.json {
        true => output::print_json(&map.json()),
        false => print(&map.text(folder)),
    };
    all([written, printed, map.draw(folder)])
}

fn at_a_point(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let flight = arguments.condition.flight(vehicle)?;
    let result = vehicle.model.trim(&vehicle.parameters, &flight);
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
            let fault = vehicle.fault_at_start(&error, &flight);
            Err(Failure::Numeric(format!(
                "{}: {why}{fault} ({place})",
                vehicle.name()
            )))
        }
    }
}
