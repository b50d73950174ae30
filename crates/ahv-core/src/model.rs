//! What a model can do.

use crate::{NoiseClass, Pattern, Real, Vector};

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

    /// Where entries of ∂f/∂x can differ from 0; those elsewhere may go unread.
    const STATE_JACOBIAN_PATTERN: Pattern<2>;

    /// ∂f/∂x and ∂f/∂u at (x, u); the unit of an entry is that of its row per second, over that of its column.
    fn jacobians(
        &self,
        x: &Self::State,
        u: &Self::Input,
    ) -> (Self::StateJacobian, Self::InputJacobian);

    /// f, ∂f/∂x and ∂f/∂u at (x, u), for less than one after the other where the model has a way.
    #[inline]
    fn drift_and_jacobians(
        &self,
        x: &Self::State,
        u: &Self::Input,
    ) -> (Self::State, Self::StateJacobian, Self::InputJacobian) {
        let (by_state, by_input) = self.jacobians(x, u);
        (self.drift(x, u), by_state, by_input)
    }
}

/// dx = f(x, u) dt + G(x, u) dW, read in the Itô sense.
pub trait StochasticModel: Model {
    /// Wiener increments dW of independent channels, each with variance dt: the model's own intensities
    /// stand in G. In s^½.
    type Noise: Vector<Self::Scalar>;

    /// G(x, u) dW, in the units of the state. Itô: x is the state before the increment.
    fn noise_increment(&self, x: &Self::State, u: &Self::Input, dw: &Self::Noise) -> Self::State;

    /// f(x, u) and G(x, u) dW, for less than one after the other where the model has a way.
    #[inline(always)]
    fn drift_and_noise_increment(
        &self,
        x: &Self::State,
        u: &Self::Input,
        dw: &Self::Noise,
    ) -> (Self::State, Self::State) {
        (self.drift(x, u), self.noise_increment(x, u, dw))
    }

    /// How column `channel` of G depends on the state. Without an implementation of its own a model makes no
    /// promise: every column is general.
    #[inline]
    fn noise_class(channel: usize) -> NoiseClass {
        let _ = channel;
        NoiseClass::General
    }

    /// Whether L^j b^k = L^k b^j for columns j = `first` and k = `second` of G at every state and input, with
    /// L^j = Σ_i b^j_i ∂/∂x_i. Without an implementation of its own a model makes no promise.
    #[inline]
    fn noise_commutes(first: usize, second: usize) -> bool {
        first == second
    }
}

/// A model that knows what its drift in the Itô sense has over that in the Stratonovich sense.
pub trait ItoCorrected: StochasticModel {
    /// ½ Σ_k L^k b^k at (x, u), in the units of the state per second: the Itô equation with drift f is the
    /// Stratonovich equation with drift f less this.
    fn ito_correction(&self, x: &Self::State, u: &Self::Input) -> Self::State;
}

/// A model with the exact derivatives of its diffusion along the columns.
pub trait DifferentiableNoise: ItoCorrected {
    /// Σ_j Σ_k L^j b^k(x, u) I_jk for the iterated integrals I_jk = `integral(j, k)`, dW_j inside and dW_k outside,
    /// in s. In the units of the state; columns by their index.
    fn iterated_increment(
        &self,
        x: &Self::State,
        u: &Self::Input,
        integral: impl FnMut(usize, usize) -> Self::Scalar,
    ) -> Self::State;
}

/// A model whose columns of G all are constant over the state: the Itô and the Stratonovich sense agree.
#[diagnostic::on_unimplemented(
    message = "the noise of `{Self}` is not known to be additive",
    note = "`ahv_integrate::AdditiveChannels` admits those of its channels that are"
)]
pub trait AdditiveNoise: StochasticModel {}

/// A model of which every two columns of G commute, [`StochasticModel::noise_commutes`].
#[diagnostic::on_unimplemented(
    message = "the noise of `{Self}` is not known to commute",
    note = "`ahv_integrate::CommutativeChannels` admits those of its channels that do"
)]
pub trait CommutativeNoise: DifferentiableNoise {}

/// A model of which it is known which states are Ornstein–Uhlenbeck processes by themselves: dχ = −a χ dt + b·dW with a rate a
/// and a row b of G that depend on parameters alone.
pub trait ColouredNoise: StochasticModel {
    /// The rate a of state number `state`, in 1/s; `None` where the state is no such process, whatever the parameters.
    #[inline(always)]
    fn decay(&self, state: usize) -> Option<Self::Scalar> {
        let _ = state;
        None
    }
}
