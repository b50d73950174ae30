//! A model whose functions stand once in the code.

use crate::{
    AdditiveNoise, ColouredNoise, CommutativeNoise, DifferentiableModel, DifferentiableNoise,
    ItoCorrected, Model, NoiseClass, Pattern, StochasticModel,
};

/// A model whose functions are called, never inlined.
///
/// Generated models are inlined wherever they are evaluated, which is fast and lets loops over members become vector
/// instructions. A scheme with many stages then holds the model as often; with this around the model it holds calls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoInline<M>(pub M);

impl<M: Model> Model for NoInline<M> {
    type Scalar = M::Scalar;
    type State = M::State;
    type Input = M::Input;

    #[inline(never)]
    fn drift(&self, x: &M::State, u: &M::Input) -> M::State {
        self.0.drift(x, u)
    }
}

impl<M: DifferentiableModel> DifferentiableModel for NoInline<M> {
    type StateJacobian = M::StateJacobian;
    type InputJacobian = M::InputJacobian;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = M::STATE_JACOBIAN_PATTERN;

    #[inline(never)]
    fn jacobians(&self, x: &M::State, u: &M::Input) -> (M::StateJacobian, M::InputJacobian) {
        self.0.jacobians(x, u)
    }

    #[inline(never)]
    fn drift_and_jacobians(
        &self,
        x: &M::State,
        u: &M::Input,
    ) -> (M::State, M::StateJacobian, M::InputJacobian) {
        self.0.drift_and_jacobians(x, u)
    }
}

impl<M: StochasticModel> StochasticModel for NoInline<M> {
    type Noise = M::Noise;

    #[inline(never)]
    fn noise_increment(&self, x: &M::State, u: &M::Input, dw: &M::Noise) -> M::State {
        self.0.noise_increment(x, u, dw)
    }

    #[inline(never)]
    fn drift_and_noise_increment(
        &self,
        x: &M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> (M::State, M::State) {
        self.0.drift_and_noise_increment(x, u, dw)
    }

    fn noise_class(channel: usize) -> NoiseClass {
        M::noise_class(channel)
    }

    fn noise_commutes(first: usize, second: usize) -> bool {
        M::noise_commutes(first, second)
    }
}

impl<M: ItoCorrected> ItoCorrected for NoInline<M> {
    #[inline(never)]
    fn ito_correction(&self, x: &M::State, u: &M::Input) -> M::State {
        self.0.ito_correction(x, u)
    }
}

impl<M: DifferentiableNoise> DifferentiableNoise for NoInline<M> {
    #[inline(never)]
    fn iterated_increment(
        &self,
        x: &M::State,
        u: &M::Input,
        integral: impl FnMut(usize, usize) -> M::Scalar,
    ) -> M::State {
        self.0.iterated_increment(x, u, integral)
    }
}

impl<M: AdditiveNoise> AdditiveNoise for NoInline<M> {}

impl<M: CommutativeNoise> CommutativeNoise for NoInline<M> {}

impl<M: ColouredNoise> ColouredNoise for NoInline<M> {
    #[inline]
    fn decay(&self, state: usize) -> Option<M::Scalar> {
        self.0.decay(state)
    }
}
