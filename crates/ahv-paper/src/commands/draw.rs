//! `ahv draw`: the vehicle of the first-principles model in its flow, as a picture.

use std::path::PathBuf;

use ahv_cli::failure::{Failure, print};
use ahv_cli::output;
use ahv_fpm::drawing::drawing;
use ahv_fpm::{Input, Model, NOMINAL, State};
use clap::Args;

use crate::reproduce::printed::TABLE_2;

/// Draws the vehicle of the first-principles model with its shocks, turns and pressures.
///
/// Without arguments at the trim of Table 2.
#[derive(Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct Arguments {
    /// Velocity in ft/s
    #[arg(long, default_value_t = TABLE_2.velocity)]
    velocity: f64,

    /// Altitude in ft
    #[arg(long, default_value_t = TABLE_2.altitude)]
    altitude: f64,

    /// Angle of attack in deg
    #[arg(long, default_value_t = TABLE_2.alpha_deg)]
    alpha: f64,

    /// Fuel equivalence ratio
    #[arg(long, default_value_t = TABLE_2.phi)]
    phi: f64,

    /// Elevator in deg
    #[arg(long, default_value_t = TABLE_2.delta_e_deg)]
    delta_e: f64,

    /// The picture, an SVG file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for a state outside the validity box or without flow, and for a file that cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let model = Model::new(&NOMINAL);
    let [alpha, delta_e] = [arguments.alpha, arguments.delta_e].map(f64::to_radians);
    let x = State {
        velocity: arguments.velocity,
        altitude: arguments.altitude,
        alpha,
        ..State::from_array([0.0; 9])
    };
    let u = Input {
        phi: arguments.phi,
        delta_e,
    };
    let flow = model
        .forces(&x, &u)
        .map_err(|fault| Failure::Request(format!("fpm: {fault}")))?;
    let title = format!(
        "{:.1} ft/s, {:.0} ft, α {:.4}°, φ {:.4}, δe {:.4}°",
        x.velocity, x.altitude, arguments.alpha, u.phi, arguments.delta_e
    );
    output::picture(
        &arguments.out,
        drawing(&model, &flow, alpha, delta_e, &title),
    )?;
    print(&format!("written to {}", arguments.out.display()))
}
