//! Why a run ended before its time, and what to do at the edge of the validity box.

use core::fmt;

use ahv_core::{Bounds, Outside, Real, Shown, Vector, first_outside};

/// Why a run ended before its time. The progress then holds the last good time and state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// A setting, or a time that was asked for, makes no sense.
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A component, or its rate, became infinite or NaN however short the step.
    NonFinite {
        /// Time in s at the start of the step.
        time: f64,
        /// Name of the first such component.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The tolerances ask for a step that the time cannot resolve.
    StepUnderflow {
        /// Time in s at the start of the step.
        time: f64,
        /// The step in s.
        step: f64,
        /// Name of the component with the greatest error relative to its tolerance.
        name: &'static str,
        /// Its value at the start of the step.
        value: f64,
    },
    /// More steps than the settings allow.
    TooManySteps {
        /// Time in s that was reached.
        time: f64,
        /// Number of steps, refused ones included.
        steps: u32,
    },
    /// A component left the validity box, and the user chose to stop there.
    OutsideValidity {
        /// Time in s at which it was found outside.
        time: f64,
        /// The component, its value and its interval.
        outside: Outside,
    },
    /// An event cannot be located: its function is not finite, or a limit is passed at the start already.
    EventNotBracketed {
        /// Time in s.
        time: f64,
        /// Name of the event.
        event: &'static str,
        /// Value of its function.
        value: f64,
    },
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Setting { name, value } => write!(f, "{name} cannot be {}", Shown(value)),
            Self::NonFinite { time, name, value } => write!(
                f,
                "after {} s {name} or its rate became {}",
                Shown(time),
                Shown(value)
            ),
            Self::StepUnderflow {
                time,
                step,
                name,
                value,
            } => write!(
                f,
                "at {} s, where {name} is {}, its tolerance asks for a step of {} s",
                Shown(time),
                Shown(value),
                Shown(step)
            ),
            Self::TooManySteps { time, steps } => {
                let time = Shown(time);
                write!(f, "{steps} steps were not enough; {time} s were reached")
            }
            Self::OutsideValidity {
                time,
                outside:
                    Outside {
                        name,
                        value,
                        bounds,
                    },
            } => write!(
                f,
                "at {} s {name} is {}, outside {}..{}",
                Shown(time),
                Shown(value),
                Shown(bounds.min),
                Shown(bounds.max)
            ),
            Self::EventNotBracketed { time, event, value } => write!(
                f,
                "the event `{event}` cannot be located: its function is {} at {} s",
                Shown(value),
                Shown(time)
            ),
        }
    }
}

impl core::error::Error for Failure {}

/// What to do when a state leaves the validity box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaving {
    /// Tell the observer once, and go on.
    Warn,
    /// End the run with [`Failure::OutsideValidity`].
    Stop,
}

/// Where a model is meant to be used.
pub trait Validity<R, X> {
    /// The first component of `x` outside, if there is one.
    fn outside(&self, x: &X) -> Option<Outside>;

    /// What to do then.
    fn leaving(&self) -> Leaving;
}

/// No validity box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Anywhere;

impl<R, X> Validity<R, X> for Anywhere {
    #[inline]
    fn outside(&self, _: &X) -> Option<Outside> {
        None
    }

    #[inline]
    fn leaving(&self) -> Leaving {
        Leaving::Warn
    }
}

/// A validity box, such as the `STATE_BOUNDS` of a model, checked at every accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within<B> {
    bounds: B,
    leaving: Leaving,
}

impl<B> Within<B> {
    /// The box `bounds`; `leaving` says what happens at its edge.
    pub const fn new(bounds: B, leaving: Leaving) -> Self {
        Self { bounds, leaving }
    }
}

impl<R: Real, X: Vector<R>, B: Vector<Bounds>> Validity<R, X> for Within<B> {
    #[inline]
    fn outside(&self, x: &X) -> Option<Outside> {
        first_outside(x, &self.bounds)
    }

    #[inline]
    fn leaving(&self) -> Leaving {
        self.leaving
    }
}
