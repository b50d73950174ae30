//! Many flights of a stochastic model, as fast as the machine goes.
//!
//! Members fly [`LANES`] at a time: numbers lie member by member, a step is a loop over members around code without
//! branches, and `pulp` runs the loop with the vector instructions that the machine has. Batches go to threads by `rayon`.
//! Noise is a function of (seed, member, channel, step), and sums run in an order of their own (`sums.rs`): a result has the same
//! bits whatever the threads and the parts that members are flown in, and a member the bits that it has alone.

mod arithmetic;
mod batch;
mod bits;
mod companion;
mod control_variate;
mod engine;
mod experiment;
mod feedback;
mod lanes;
mod observe;
mod outcome;
mod passage;
mod propagator;
mod rare;
mod scheme;
mod spread;
mod sums;

use ahv_core::Shown;
use ahv_integrate::NoiseError;
use scheme::MOST_NORMALS;

pub use arithmetic::Mode;
pub use batch::Loss;
pub use control_variate::Remains;
pub use engine::{Engine, Point};
pub use experiment::{Experiment, MemberRecord, Particle};
pub use feedback::{Feedback, Unsteady};
pub use lanes::{LANES, Packed};
pub use outcome::{Outcome, Snapshot, StateSpread, Tally};
pub use propagator::generic_point;
pub use rare::{FEWEST_REPETITIONS, Level, RareError, RareEstimate, RareEvent};
pub use scheme::Scheme;
pub use spread::{Bin, QUANTILES};
pub use sums::{BLOCK, Part, Reference};

/// Why members cannot be flown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MonteCarloError {
    /// A scheme that is not for this model's noise.
    #[error("the scheme {scheme} does not go: {reason}")]
    Scheme {
        /// The scheme.
        scheme: &'static str,
        /// What its stepper says.
        reason: NoiseError,
    },
    /// The splitting of a model that has no coloured noise.
    #[error(
        "the scheme splitting needs coloured noise, and {model} has none; heun and the others do not"
    )]
    NoColouredNoise {
        /// The model.
        model: &'static str,
    },
    /// A scheme that takes more normal numbers a step than there is room for.
    #[error("a step would take {normals} normal numbers; {MOST_NORMALS} can be drawn")]
    Normals {
        /// How many it takes.
        normals: usize,
    },
    /// A step that is not positive and finite.
    #[error("the step must be positive and finite, not {} s", Shown(*.0))]
    StepSize(f64),
    /// Stopped before a member had flown.
    #[error("stopped before the first members had flown")]
    Stopped,
    /// A rare event that cannot be looked for.
    #[error(transparent)]
    Rare(#[from] RareError),
    /// Threads that cannot be started.
    #[error("cannot start the threads: {0}")]
    Threads(String),
}
