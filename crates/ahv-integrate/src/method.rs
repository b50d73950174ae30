//! What a method with an error estimate can do.

use ahv_core::{Model, Real, Vector};

use crate::error::{accept, step_size};
use crate::{Constant, Dense, InputSource, StepError};

/// Greatest number of stages.
pub(crate) const STAGES: usize = 7;

/// Where a step starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<X> {
    /// Time in s.
    pub time: f64,
    /// The state.
    pub state: X,
    /// The drift there, if it is known already.
    pub slope: Option<X>,
}

/// A step that is yet to be judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt<X> {
    /// Time in s at its start.
    pub time: f64,
    /// Its length in s.
    pub step: f64,
    /// The state at its start.
    pub state: X,
    /// The drift at its start, if the method computed it.
    pub first_slope: Option<X>,
    /// The state at its end.
    pub next: X,
    /// The drift at its end, if the method computed it.
    pub last_slope: Option<X>,
    /// Estimate of the local error.
    pub error: X,
    /// What the dense output is made of.
    pub(crate) stages: [X; STAGES],
}

/// A one-step method with an estimate of its error, for models of type `M`.
pub trait Method<M: Model> {
    /// The power of the step size with which the error estimate falls.
    const ERROR_ORDER: u8;

    /// A step of size `step`, in s. Whether it is good is for the caller to say; it may be infinite or NaN.
    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State>;

    /// The state over the step.
    fn dense(&self, attempt: &Attempt<M::State>) -> Dense<M::State>;
}

/// A method with a fixed step and a held input; its error estimate goes unused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed<S> {
    method: S,
    dt: f64,
}

impl<S> Fixed<S> {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(method: S, dt: f64) -> Self {
        Self { method, dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline]
    pub fn step<M: Model>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
    ) -> Result<(), StepError<M::Scalar>>
    where
        S: Method<M>,
    {
        let _: M::Scalar = step_size(self.dt)?;
        let start = Start {
            time: 0.0,
            state: *x,
            slope: None,
        };
        let attempt = self.method.attempt(model, &Constant(*u), &start, self.dt);
        accept(x, attempt.next)
    }
}

/// The first component that is infinite or NaN.
#[inline]
pub(crate) fn non_finite<R: Real, X: Vector<R>>(x: &X) -> Option<(&'static str, f64)> {
    x.find(|component| !component.is_finite())
        .map(|(name, value)| (name, value.to_f64()))
}
