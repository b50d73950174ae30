//! The Milstein method for commutative noise.

use ahv_core::{CommutativeNoise, Real, Vector};

use crate::StepError;
use crate::error::{accept, step_size};
use crate::vector::component;

/// The Milstein method for Itô equations with commutative noise, with a fixed step and a held input.
///
/// x ← x + f dt + G dW + ½ Σ_j Σ_k L^j b^k (dW_j dW_k − δ_jk dt): where L^j b^k = L^k b^j the iterated integrals occur in
/// pairs whose sum is known from dW. Strong order 1, weak order 1 (Milstein 1974; Kloeden and Platen 1992).
///
/// A model whose columns do not commute needs the Lévy areas as well and is refused at compile time;
/// [`CommutativeChannels`](crate::CommutativeChannels) admits those of its channels that do.
///
/// ```compile_fail,E0277
/// fn step<M: ahv_core::DifferentiableNoise>(m: &M, x: &mut M::State, u: &M::Input, dw: &M::Noise) {
///     // ERROR: nothing says that the noise of M commutes
///     let _ = ahv_integrate::ItoMilstein::new(0.01).step(m, x, u, dw);
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoMilstein {
    pub(crate) dt: f64,
}

impl ItoMilstein {
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
    pub fn step<M: CommutativeNoise>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let drift = model.drift(x, u);
        let noise = model.noise_increment(x, u, dw);
        let iterated = model.iterated_increment(x, u, |j, k| {
            let product = component(dw, j) * component(dw, k);
            M::Scalar::HALF * if j == k { product - dt } else { product }
        });
        let next = x
            .zip_with(drift, |x, f| x + f * dt)
            .zip_with(noise, |x, g| x + g)
            .zip_with(iterated, |x, g| x + g);
        accept(x, next)
    }
}
