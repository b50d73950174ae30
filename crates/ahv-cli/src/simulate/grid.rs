//! The points in time of a simulation.

use ahv_integrate::TimeGrid;

use crate::failure::Failure;
use crate::number::Shown;

/// The steps of a run from 0 to `t_end` with steps `dt`, both in s, positive and finite.
///
/// # Errors
///
/// [`Failure::Request`] if there would be more than 1e8 steps.
pub(super) fn grid(t_end: f64, dt: f64) -> Result<TimeGrid, Failure> {
    TimeGrid::new(0.0, t_end, dt).map_err(|_| {
        let steps = t_end / dt;
        Failure::Request(format!(
            "--t-end {} with --dt {} makes {:.3e} steps; at most 1e8 are allowed, so take a larger --dt",
            Shown(t_end),
            Shown(dt),
            Shown(steps)
        ))
    })
}
