//! The points in time of a simulation.

use ahv_integrate::TimeGrid;

use crate::failure::Failure;
use crate::number::Shown;

/// Reads a positive, finite number.
///
/// # Errors
///
/// What is wrong, for clap to print.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        Ok(_) => Err("must be positive and finite".to_owned()),
        Err(_) => Err("is not a number of seconds".to_owned()),
    }
}

/// Most steps of one flight.
pub(crate) const MOST_STEPS: f64 = 1e8;

/// Holds the number of steps that `t_end` and `dt` make, both in s, against the most that there may be.
///
/// # Errors
///
/// [`Failure::Request`] for none and for more; it names the flags.
pub(crate) fn allowed(t_end: f64, dt: f64, steps: f64, most: f64) -> Result<u64, Failure> {
    if (1.0..=most).contains(&steps) {
        return Ok(steps as u64);
    }
    let (made, advice) = match steps < 1.0 {
        true => (Shown(steps).to_string(), "smaller"),
        false => (format!("{:.3e}", Shown(steps)), "larger"),
    };
    Err(Failure::Request(format!(
        "--t-end {} with --dt {} makes {made} steps; 1 to {most:e} are allowed, so take a {advice} --dt",
        Shown(t_end),
        Shown(dt),
    )))
}

/// The steps of a run from 0 to `t_end` with steps `dt`, both in s, positive and finite.
///
/// # Errors
///
/// [`Failure::Request`] if there would be more than [`MOST_STEPS`].
pub(super) fn grid(t_end: f64, dt: f64) -> Result<TimeGrid, Failure> {
    // The last step is shortened.
    let steps = allowed(t_end, dt, (t_end / dt).max(1.0), MOST_STEPS);
    TimeGrid::new(0.0, t_end, dt).map_err(|error| match steps {
        Err(failure) => failure,
        Ok(_) => Failure::Request(format!("--t-end and --dt: {error}")),
    })
}
