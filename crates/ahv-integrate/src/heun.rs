//! The stochastic Heun method, in the Stratonovich and in the Itô sense.

use ahv_core::{ItoCorrected, Model, Real, StochasticModel, Vector};

use crate::StepError;
use crate::error::{accept, step_size};

/// The stochastic Heun method for Stratonovich equations, with a fixed step and a held input.
///
/// Reads dx = f dt + G ∘ dW: drift and diffusion as the model has them, but in the Stratonovich sense. A model whose
/// f and G are meant in the Itô sense wants [`ItoHeun`]; for additive noise the two agree.
///
/// Strong order 1 where the columns of G commute, 1/2 elsewhere. Weak order 2 for additive noise, 1 elsewhere. Order 2
/// without noise (Rümelin 1982; Kloeden and Platen 1992).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StratonovichHeun {
    pub(crate) dt: f64,
}

impl StratonovichHeun {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// `dw` are the Wiener increments over the step, mean 0 and variance dt, in s^½.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: StochasticModel>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> Result<(), StepError<M::Scalar>> {
        heun(self.dt, model, x, u, dw)
    }
}

/// The stochastic Heun method for Itô equations, with a fixed step and a held input.
///
/// The Heun method converges to the Stratonovich solution; this one takes the correction ½ Σ L^k b^k off the
/// drift first, at both ends of the step, and so converges to the Itô solution of dx = f dt + G dW. For any noise.
///
/// Strong order 1 where the columns of G commute, 1/2 elsewhere. Weak order 2 for additive noise, 1 elsewhere. Order 2
/// without noise (Rümelin 1982; Kloeden and Platen 1992).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoHeun {
    pub(crate) dt: f64,
}

impl ItoHeun {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// `dw` are the Wiener increments over the step, mean 0 and variance dt, in s^½.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: ItoCorrected>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> Result<(), StepError<M::Scalar>> {
        heun(self.dt, &InStratonovichSense { model }, x, u, dw)
    }
}

/// The equations of a model as they read in the Stratonovich sense.
struct InStratonovichSense<'m, M> {
    model: &'m M,
}

impl<M: ItoCorrected> Model for InStratonovichSense<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;
    type Input = M::Input;

    #[inline(always)]
    fn drift(&self, x: &M::State, u: &M::Input) -> M::State {
        let correction = self.model.ito_correction(x, u);
        self.model.drift(x, u).zip_with(correction, |f, c| f - c)
    }
}

impl<M: ItoCorrected> StochasticModel for InStratonovichSense<'_, M> {
    type Noise = M::Noise;

    #[inline(always)]
    fn noise_increment(&self, x: &M::State, u: &M::Input, dw: &M::Noise) -> M::State {
        self.model.noise_increment(x, u, dw)
    }

    #[inline(always)]
    fn drift_and_noise_increment(
        &self,
        x: &M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> (M::State, M::State) {
        let (drift, noise) = self.model.drift_and_noise_increment(x, u, dw);
        let correction = self.model.ito_correction(x, u);
        (drift.zip_with(correction, |f, c| f - c), noise)
    }
}

/// One step for an equation in the Stratonovich sense.
#[inline(always)]
fn heun<M: StochasticModel>(
    dt: f64,
    model: &M,
    x: &mut M::State,
    u: &M::Input,
    dw: &M::Noise,
) -> Result<(), StepError<M::Scalar>> {
    let dt: M::Scalar = step_size(dt)?;
    let first = change(model, x, u, dw, dt);
    let second = change(model, &x.zip_with(first, |x, d| x + d), u, dw, dt);
    let mean = first.zip_with(second, |a, b| M::Scalar::HALF * (a + b));
    accept(x, x.zip_with(mean, |x, d| x + d))
}

/// f dt + G dW at x. No closure: one that holds a model is too large to be inlined.
#[inline(always)]
fn change<M: StochasticModel>(
    model: &M,
    x: &M::State,
    u: &M::Input,
    dw: &M::Noise,
    dt: M::Scalar,
) -> M::State {
    let (drift, noise) = model.drift_and_noise_increment(x, u, dw);
    drift.zip_with(noise, |f, g| f * dt + g)
}
