//! The Euler–Maruyama method.

use ahv_core::{StochasticModel, Vector};

use crate::StepError;
use crate::error::{accept, step_size};

/// The Euler–Maruyama method for Itô equations, with a fixed step and a held input.
///
/// x ← x + f(x, u) dt + G(x, u) dW with f and G at the start of the step, which is what makes the
/// limit the Itô integral. Strong order 1/2 (1 for additive noise), weak order 1
/// (Kloeden and Platen 1992, section 10.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoEulerMaruyama {
    pub(crate) dt: f64,
}

impl ItoEulerMaruyama {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// `dw` are the Wiener increments over the step: the caller draws them with mean 0 and variance
    /// dt, in s^½, so that it owns seeds, streams and reuse of noise.
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
        let dt: M::Scalar = step_size(self.dt)?;
        let (drift, noise) = model.drift_and_noise_increment(x, u, dw);
        let next = x
            .zip_with(drift, |x, f| x + f * dt)
            .zip_with(noise, |x, g| x + g);
        accept(x, next)
    }
}
