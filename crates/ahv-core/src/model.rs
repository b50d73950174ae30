//! What a model can do.

use crate::{Real, Vector};

/// dx/dt = f(x, u) of a time-invariant model.
pub trait Model {
    /// Number that the model computes with.
    type Scalar: Real;
    /// State x; units by [`Vector::UNITS`].
    type State: Vector<Self::Scalar>;
    /// Input u; units by [`Vector::UNITS`].
    type Input: Vector<Self::Scalar>;

    /// f(x, u), in the units of the state per second.
    ///
    /// IEEE throughout: outside the model's domain (velocity > 0) a component may be infinite or NaN.
    fn drift(&self, x: &Self::State, u: &Self::Input) -> Self::State;
}

/// A model with the exact derivatives of its drift.
pub trait DifferentiableModel: Model {
    /// ∂f/∂x: a vector over the rows of f; each row is a vector over the states.
    type StateJacobian: Vector<Self::State>;
    /// ∂f/∂u: a vector over the rows of f; each row is a vector over the inputs.
    type InputJacobian: Vector<Self::Input>;

    /// ∂f/∂x and ∂f/∂u at (x, u); the unit of an entry is that of its row per second, over that of its column.
    fn jacobians(
        &self,
        x: &Self::State,
        u: &Self::Input,
    ) -> (Self::StateJacobian, Self::InputJacobian);

    /// f, ∂f/∂x and ∂f/∂u at (x, u), for less than one after the other.
    fn drift_and_jacobians(
        &self,
        x: &Self::State,
        u: &Self::Input,
    ) -> (Self::State, Self::StateJacobian, Self::InputJacobian);
}

/// dx = f(x, u) dt + G(x, u) dW, read in the Itô sense.
pub trait StochasticModel: Model {
    /// Wiener increments dW of independent channels, each with variance dt: the model's own intensities
    /// stand in G. In s^½.
    type Noise: Vector<Self::Scalar>;

    /// G(x, u) dW, in the units of the state. Itô: x is the state before the increment.
    fn noise_increment(&self, x: &Self::State, u: &Self::Input, dw: &Self::Noise) -> Self::State;
}
