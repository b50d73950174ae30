//! Why a step failed.

use core::fmt;

use ahv_core::{Real, Shown, Vector};

use crate::Failure;

/// Why a step failed. The state is then the one before the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepError<R> {
    /// The step size is not a positive, finite number.
    StepSize {
        /// The step size in s.
        dt: f64,
    },
    /// A component of the new state is infinite or NaN.
    NonFinite {
        /// Name of the first such component.
        name: &'static str,
        /// Its value, in its own unit.
        value: R,
    },
}

impl<R: Real> StepError<R> {
    /// The failure of a run whose step from `time`, in s, ended like this.
    #[must_use]
    pub fn at(self, time: f64) -> Failure {
        match self {
            Self::StepSize { dt } => Failure::Setting {
                name: "step",
                value: dt,
            },
            Self::NonFinite { name, value } => Failure::NonFinite {
                time,
                name,
                value: value.to_f64(),
            },
        }
    }
}

impl<R: Real> fmt::Display for StepError<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { dt } => write!(
                f,
                "the step size must be positive and finite, not {} s",
                Shown(*dt)
            ),
            Self::NonFinite { name, value } => {
                write!(f, "{name} became {}", Shown(value.to_f64()))
            }
        }
    }
}

impl<R: Real> core::error::Error for StepError<R> {}

/// `dt` as a scalar.
///
/// Checked at every step, not in the constructor: a stepper can then be a constant, and the
/// comparison costs nothing beside a drift.
///
/// # Errors
///
/// [`StepError::StepSize`] unless `dt` is positive and finite.
#[inline(always)]
pub(crate) fn step_size<R: Real>(dt: f64) -> Result<R, StepError<R>> {
    if dt > 0.0 && dt.is_finite() {
        Ok(R::from_f64(dt))
    } else {
        Err(StepError::StepSize { dt })
    }
}

/// Replaces `x` by `next`.
///
/// # Errors
///
/// [`StepError::NonFinite`], with `x` as it was, if a component of `next` is infinite or NaN.
#[inline(always)]
pub(crate) fn accept<R: Real, X: Vector<R>>(x: &mut X, next: X) -> Result<(), StepError<R>> {
    match next.find(|component| !component.is_finite()) {
        Some((name, value)) => Err(StepError::NonFinite { name, value }),
        None => {
            *x = next;
            Ok(())
        }
    }
}
