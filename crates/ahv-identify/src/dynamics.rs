//! What identification asks of a model.

use ahv_analysis::erased::{AnyModel, Components};
use nalgebra::DMatrix;

/// A model with its derivatives; p, x and u stand for parameters, state and input in the order of their names.
pub trait Dynamics: Sync {
    /// Its name.
    fn name(&self) -> &'static str;
    /// Its parameters.
    fn parameters(&self) -> Components;
    /// Its states.
    fn states(&self) -> Components;
    /// The quantities that people look at.
    fn outputs(&self) -> Components;
    /// Number of its Wiener processes.
    fn channels(&self) -> usize;
    /// The drift f(x, u), in the units of the states per s.
    fn drift(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64>;
    /// ∂f/∂x.
    fn state_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// ∂f/∂p.
    fn parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// The diffusion, with a column for each Wiener process.
    fn diffusion(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// The outputs.
    fn output_values(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64>;
    /// The derivatives of these outputs or states by the states; `None` where they are not finite.
    fn output_slopes(
        &self,
        p: &[f64],
        x: &[f64],
        u: &[f64],
        names: &[&str],
    ) -> Option<DMatrix<f64>>;
    /// The derivatives of all outputs by the parameters.
    fn output_parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
}

impl Dynamics for &dyn AnyModel {
    fn name(&self) -> &'static str {
        (**self).name()
    }

    fn parameters(&self) -> Components {
        (**self).parameters()
    }

    fn states(&self) -> Components {
        (**self).states()
    }

    fn outputs(&self) -> Components {
        (**self).outputs()
    }

    fn channels(&self) -> usize {
        (**self).channels()
    }

    fn drift(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        (**self).drift(p, x, u)
    }

    fn state_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let [by_state, _] = (**self).jacobians(p, x, u);
        by_state
    }

    fn parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        (**self).parameter_jacobian(p, x, u)
    }

    fn diffusion(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        (**self).diffusion(p, x, u)
    }

    fn output_values(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        (**self).output_values(p, x, u)
    }

    fn output_slopes(
        &self,
        p: &[f64],
        x: &[f64],
        u: &[f64],
        names: &[&str],
    ) -> Option<DMatrix<f64>> {
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        Some(self.linearize(p, (x, u), &[], &names).ok()?.c)
    }

    fn output_parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        (**self).output_parameter_jacobian(p, x, u)
    }
}
