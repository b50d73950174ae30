//! How many steps a flight may have.

use crate::failure::Failure;
use crate::number::Shown;

/// Most steps of one flight.
pub const MOST_STEPS: f64 = 1e8;

/// Holds the number of steps that `t_end` and `dt` make, both in s, against the most that there may be.
///
/// # Errors
///
/// [`Failure::Request`] for none and for more; it names the flags.
pub fn allowed(t_end: f64, dt: f64, steps: f64, most: f64) -> Result<u64, Failure> {
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
