//! A Runge–Kutta method of strong order 3/2 for additive noise.

use ahv_core::{AdditiveNoise, Real, Vector};

use crate::error::{accept, step_size};
use crate::{StepError, WienerIntegrals};

/// SRA1 for Itô equations with additive noise, with a fixed step and a held input.
///
/// Strong order 3/2, order 2 without noise; two drifts a step (Rößler 2010, "Runge–Kutta methods for the strong
/// approximation of solutions of stochastic differential equations"). For additive noise the Itô and the Stratonovich
/// solution are the same.
///
/// A model whose G depends on the state is refused at compile time;
/// [`AdditiveChannels`](crate::AdditiveChannels) admits those of its channels on which it does not.
///
/// ```compile_fail,E0277
/// use ahv_integrate::{ItoSra1, WienerIntegrals};
/// fn step<M: ahv_core::StochasticModel>(m: &M, x: &mut M::State, u: &M::Input, w: &WienerIntegrals<M::Noise>) {
///     // ERROR: nothing says that the noise of M is additive
///     let _ = ItoSra1::new(0.01).step(m, x, u, w);
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoSra1 {
    pub(crate) dt: f64,
}

impl ItoSra1 {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// `integrals` are ΔW and ΔZ of the Wiener processes over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: AdditiveNoise>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        integrals: &WienerIntegrals<M::Noise>,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let c = |value: f64| M::Scalar::from_f64(value);
        let lag = c(1.5) / dt;

        let k1 = model.drift(x, u);
        let mean = model.noise_increment(x, u, &integrals.dz);
        let inner = x
            .zip_with(k1, |x, k| x + c(0.75) * dt * k)
            .zip_with(mean, |x, g| x + lag * g);
        let k2 = model.drift(&inner, u);

        let noise = model.noise_increment(x, u, &integrals.dw);
        let slope = k1.zip_with(k2, |a, b| c(1.0 / 3.0) * a + c(2.0 / 3.0) * b);
        let next = x
            .zip_with(slope, |x, k| x + dt * k)
            .zip_with(noise, |x, g| x + g);
        accept(x, next)
    }
}
