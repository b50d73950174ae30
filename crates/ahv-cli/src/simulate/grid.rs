//! The points in time of a simulation.

use ahv_integrate::TimeGrid;

use crate::failure::Failure;
use crate::steps::{MOST_STEPS, allowed};

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
