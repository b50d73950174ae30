//! Why there is no estimate of a rare event.

use ahv_core::Shown;

use super::FEWEST_REPETITIONS;

/// Why a rare event cannot be looked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RareError {
    /// A state that the model does not have.
    #[error("there is no state number {state}; there are {states} of them, from 0 on")]
    State {
        /// Its number.
        state: usize,
        /// How many states there are.
        states: usize,
    },
    /// A limit that is met at the start, or no number.
    #[error("the limit {} of {state} must be a number other than {}, where the flight starts", Shown(*limit), Shown(*start))]
    Limit {
        /// The state.
        state: &'static str,
        /// The limit.
        limit: f64,
        /// Where the flight starts.
        start: f64,
    },
    /// Levels that do not lie between the start and the limit, in order.
    #[error("the level {} does not lie between {} and the limit {}", Shown(*level), Shown(*after), Shown(*limit))]
    Level {
        /// The level.
        level: f64,
        /// The level before, or the start.
        after: f64,
        /// The limit.
        limit: f64,
    },
    /// No members.
    #[error("no members start from each level; it takes 1 at least")]
    Effort,
    /// Too few repetitions for an interval.
    #[error(
        "{repetitions} repetitions are too few for an interval; it takes {FEWEST_REPETITIONS} at least"
    )]
    Repetitions {
        /// How many.
        repetitions: u64,
    },
    /// A flight of no steps.
    #[error("a flight of no steps goes nowhere")]
    Flight,
    /// Members that do not come nearer to the limit.
    #[error("the members come no nearer to the limit than {}; more members from each level may", Shown(*level))]
    OutOfReach {
        /// The level that was not passed, or beyond which none could be set.
        level: f64,
    },
    /// Stopped before there was an estimate.
    #[error(
        "stopped after {repetitions} of {asked} repetitions, before there was an estimate: it takes {FEWEST_REPETITIONS} at least"
    )]
    Stopped {
        /// Levels that were given or that the pilot had set, that of the limit included if it came so far.
        levels: Vec<f64>,
        /// Repetitions that were flown.
        repetitions: u64,
        /// Repetitions that were asked for.
        asked: u64,
        /// Steps of members, the pilot's included.
        member_steps: u64,
    },
    /// Members that are all lost on their way.
    #[error(
        "all members are lost, by parameters that break a rule or a state that is no longer finite"
    )]
    Lost,
    /// Repetitions that say nothing of their error.
    #[error("every repetition gave {}; more members from each level, or more repetitions, tell them apart", Shown(*value))]
    NoSpread {
        /// What they gave.
        value: f64,
    },
}
