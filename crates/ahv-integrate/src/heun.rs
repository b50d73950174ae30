//! The stochastic Heun method, in the Stratonovich and in the Itô sense.

use ahv_core::{ItoCorrected, Real, StochasticModel, Vector};

use crate::StepError;
use crate::error::{accept, step_size};

/// The stochastic Heun method for Stratonovich equations, with a fixed step and a held input.
///
/// Reads dx = f dt + G ∘ dW: drift and diffusion as the model has them, but in the Stratonovich sense. A model whose
/// f and G are meant in the Itô sense wants [`ItoHeun`]; for additive noise the two agree.
///
/// Strong order 1 where the columns of G commute, 1/2 elsewhere; weak order 1; order 2 without noise
/// (Rümelin 1982; Kloeden and Platen 1992).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StratonovichHeun {
    dt: f64,
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
    #[inline]
    pub fn step<M: StochasticModel>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> Result<(), StepError<M::Scalar>> {
        heun(self.dt, model, x, u, dw, |x| model.drift(x, u))
    }
}

/// The stochastic Heun method for Itô equations, with a fixed step and a held input.
///
/// The Heun method converges to the Stratonovich solution; this one takes the correction ½ Σ L^k b^k off the
/// drift first, at both ends of the step, and so converges to the Itô solution of dx = f dt + G dW. For any noise.
///
/// Strong order 1 where the columns of G commute, 1/2 elsewhere; weak order 1; order 2 without noise
/// (Rümelin 1982; Kloeden and Platen 1992).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoHeun {
    dt: f64,
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
    #[inline]
    pub fn step<M: ItoCorrected>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> Result<(), StepError<M::Scalar>> {
        heun(self.dt, model, x, u, dw, |x| {
            model
                .drift(x, u)
                .zip_with(model.ito_correction(x, u), |f, c| f - c)
        })
    }
}

/// One step for the Stratonovich equation of this drift.
#[inline]
fn heun<M: StochasticModel>(
    dt: f64,
    model: &M,
    x: &mut M::State,
    u: &M::Input,
    dw: &M::Noise,
    drift: impl Fn(&M::State) -> M::State,
) -> Result<(), StepError<M::Scalar>> {
    let dt: M::Scalar = step_size(dt)?;
    let half = M::Scalar::HALF;
    let change =
        |x: &M::State| drift(x).zip_with(model.noise_increment(x, u, dw), |f, g| f * dt + g);
    let first = change(x);
    let second = change(&x.zip_with(first, |x, d| x + d));
    let mean = first.zip_with(second, |a, b| half * (a + b));
    accept(x, x.zip_with(mean, |x, d| x + d))
}
