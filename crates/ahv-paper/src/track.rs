//! Closed loops: DCOM as the truth, flown by a sampled controller that was designed on SDCOM.
//!
//! The controllers are [`Backstepping`](crate::backstepping::Backstepping) and [`LinearTracker`].

mod ensemble;
mod flight;
mod linear;
mod manoeuvre;
mod poles;
mod statistics;

use ahv_models::sdcom;

pub use ensemble::{ACTUATORS, ErrorSize, Flight, LimitedShare, Sample, TrackError, Trial, silent};
pub use flight::{ClosedLoop, Increments, LoopState, SUBSTEPS};
pub use linear::{LinearTracker, LinearTrackerError};
pub use manoeuvre::{Manoeuvre, Reference, Step};
pub use statistics::{Band, Count, Figure, Statistics, bands};

/// Sampling period of the controllers, in s.
pub const PERIOD: f64 = 0.01;

/// A sampled controller. What it remembers is kept outside, so that one controller flies many members.
pub trait Controller: Sync {
    /// What it remembers from one sample to the next.
    type Memory: Copy + AsRef<[f64]> + AsMut<[f64]> + Send + Sync;

    /// The memory after a long flight at the trim (x, u).
    fn start(&self, x: &sdcom::State<f64>, u: &sdcom::Input<f64>) -> Self::Memory;

    /// The input to command until the next sample.
    ///
    /// Measured are the rigid states of `x`, whose χ are 0, and the positions `u` of the actuators.
    fn command(
        &self,
        memory: &mut Self::Memory,
        reference: &Reference,
        x: &sdcom::State<f64>,
        u: &sdcom::Input<f64>,
    ) -> sdcom::Input<f64>;
}
