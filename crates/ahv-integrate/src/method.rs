//! What a method with an error estimate can do.

use ahv_core::{Model, Real, Vector};

use crate::error::{accept, step_size};
use crate::{Constant, Dense, InputSource, StepError};

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

/// A step of a method that keeps `S` for its dense output; the step is not accepted yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt<X, S> {
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
    /// What the method keeps for its dense output.
    pub stages: S,
}

/// A one-step method with an estimate of its error, for models of type `M`.
///
/// [`Adaptive`](crate::Adaptive) and [`Fixed`] run any implementation; the example `own_method` has one.
pub trait Method<M: Model> {
    /// The power of the step size with which the error estimate falls.
    const ERROR_ORDER: u8;

    /// What the method keeps of a step for its dense output: usually the slopes of its stages.
    type Stages;

    /// A step of size `step`, in s. Whether it is good is for the caller to say; it may be infinite or NaN.
    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State, Self::Stages>;

    /// The size of the error estimate; a step is accepted if it is at most 1. `norm` is the size of a vector in units of
    /// the tolerances. By default that of [`Attempt::error`]; a method with two estimates combines their sizes here.
    #[inline]
    fn error_size(
        &self,
        attempt: &Attempt<M::State, Self::Stages>,
        norm: impl Fn(&M::State) -> f64,
    ) -> f64 {
        norm(&attempt.error)
    }

    /// The state over the step.
    ///
    /// The method may compute further stages, and store the drift at the end of the step in
    /// [`Attempt::last_slope`], where the next step starts.
    fn dense<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        attempt: &mut Attempt<M::State, Self::Stages>,
    ) -> Dense<M::State>;
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
