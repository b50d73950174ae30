//! What members are computed with.

use std::marker::PhantomData;

use ahv_core::{
    ColouredNoise, Fused, ItoCorrected, Model, NoiseClass, Outlined, Real, StochasticModel,
    Straight,
};

use super::batch::Member;
use super::family::{Family, Packed};

/// Which arithmetic the members are flown with. All but the first change last bits, or more, for speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Doubles; every operation is rounded by itself, so that results are the same on every machine.
    #[default]
    Exact,
    /// Doubles; products are added in one rounding. Asks for a processor with the instruction.
    Fma,
    /// Doubles, with the normal numbers of the noise in single precision.
    F32Noise,
    /// Drift and noise increment in single precision, states in double; noise as in `F32Noise`.
    F32Drift,
}

impl Mode {
    /// All modes.
    pub const ALL: [Self; 4] = [Self::Exact, Self::Fma, Self::F32Noise, Self::F32Drift];

    /// Its name on command lines and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Fma => "fma",
            Self::F32Noise => "f32-noise",
            Self::F32Drift => "f32-drift",
        }
    }
}

/// A scalar that members are flown with.
pub(super) trait Arithmetic: Real {
    fn of(value: f64) -> Self;
    fn value(self) -> f64;
}

impl Arithmetic for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

impl Arithmetic for Straight<f64> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.0
    }
}

impl Arithmetic for Fused<f64> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::new(value)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        Self::value(self)
    }
}

impl Arithmetic for Fused<Straight<f64>> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::new(Straight(value))
    }

    #[inline(always)]
    fn value(self) -> f64 {
        Self::value(self).0
    }
}

impl Arithmetic for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn value(self) -> f64 {
        f64::from(self)
    }
}

impl Arithmetic for Straight<f32> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self(value as f32)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        f64::from(self.0)
    }
}

/// Members flown with the scalar `R`.
#[derive(Clone, Copy)]
pub(super) struct In<R>(PhantomData<R>);

impl<F: Family, R: Arithmetic> Member<F> for In<R> {
    type Scalar = R;
    type Model = F::Model<R>;

    #[inline(always)]
    fn model(model: &F::Model<Packed>, lane: usize) -> Self::Model {
        F::map_model(model, |numbers: &Packed| R::of(numbers.0[lane]))
    }
}

/// As `K`, with models that are called, not inlined.
#[derive(Clone, Copy)]
pub(super) struct Called<K>(PhantomData<K>);

impl<F: Family, K: Member<F>> Member<F> for Called<K> {
    type Scalar = K::Scalar;
    type Model = Outlined<K::Model>;

    #[inline(always)]
    fn model(model: &F::Model<Packed>, lane: usize) -> Self::Model {
        Outlined(K::model(model, lane))
    }
}

/// Members flown with the scalar `R`, whose models are evaluated with `N`.
#[derive(Clone, Copy)]
pub(super) struct Narrowed<R, N>(PhantomData<(R, N)>);

impl<F: Family, R: Arithmetic, N: Arithmetic> Member<F> for Narrowed<R, N> {
    type Scalar = R;
    type Model = Narrow<F, R, N>;

    #[inline(always)]
    fn model(model: &F::Model<Packed>, lane: usize) -> Self::Model {
        Narrow {
            model: F::map_model(model, |numbers: &Packed| N::of(numbers.0[lane])),
            scalar: PhantomData,
        }
    }
}

/// A model that is evaluated with the scalar `N`, for a state of the scalar `R`.
#[derive(Clone, Copy)]
pub(super) struct Narrow<F: Family, R, N: Real> {
    model: F::Model<N>,
    scalar: PhantomData<R>,
}

#[inline(always)]
fn narrow<R: Arithmetic, N: Arithmetic>(value: &R) -> N {
    N::of(value.value())
}

impl<F: Family, R: Arithmetic, N: Arithmetic> Narrow<F, R, N> {
    #[inline(always)]
    fn wide(x: F::State<N>) -> F::State<R> {
        F::map_state(&x, narrow)
    }
}

impl<F: Family, R: Arithmetic, N: Arithmetic> Model for Narrow<F, R, N> {
    type Scalar = R;
    type State = F::State<R>;
    type Input = F::Input<R>;

    #[inline(always)]
    fn drift(&self, x: &Self::State, u: &Self::Input) -> Self::State {
        let (x, u) = (F::map_state(x, narrow), F::map_input(u, narrow));
        Self::wide(self.model.drift(&x, &u))
    }
}

impl<F: Family, R: Arithmetic, N: Arithmetic> StochasticModel for Narrow<F, R, N> {
    type Noise = F::Noise<R>;

    #[inline(always)]
    fn noise_increment(&self, x: &Self::State, u: &Self::Input, dw: &Self::Noise) -> Self::State {
        let (x, u) = (F::map_state(x, narrow), F::map_input(u, narrow));
        let dw = F::map_noise(dw, narrow);
        Self::wide(self.model.noise_increment(&x, &u, &dw))
    }

    #[inline(always)]
    fn drift_and_noise_increment(
        &self,
        x: &Self::State,
        u: &Self::Input,
        dw: &Self::Noise,
    ) -> (Self::State, Self::State) {
        let (x, u) = (F::map_state(x, narrow), F::map_input(u, narrow));
        let dw = F::map_noise(dw, narrow);
        let (drift, noise) = self.model.drift_and_noise_increment(&x, &u, &dw);
        (Self::wide(drift), Self::wide(noise))
    }

    fn noise_class(channel: usize) -> NoiseClass {
        F::Model::<N>::noise_class(channel)
    }

    fn noise_commutes(first: usize, second: usize) -> bool {
        F::Model::<N>::noise_commutes(first, second)
    }
}

impl<F: Family, R: Arithmetic, N: Arithmetic> ItoCorrected for Narrow<F, R, N> {
    #[inline(always)]
    fn ito_correction(&self, x: &Self::State, u: &Self::Input) -> Self::State {
        let (x, u) = (F::map_state(x, narrow), F::map_input(u, narrow));
        Self::wide(self.model.ito_correction(&x, &u))
    }
}

impl<F: Family, R: Arithmetic, N: Arithmetic> ColouredNoise for Narrow<F, R, N>
where
    F::Model<N>: ColouredNoise,
{
    #[inline(always)]
    fn decay(&self, state: usize) -> Option<R> {
        self.model.decay(state).as_ref().map(narrow)
    }
}

#[cfg(test)]
mod tests {
    use super::Mode;

    /// Command lines and files of earlier versions hold them.
    #[test]
    fn modes_keep_their_names() {
        let names = Mode::ALL.map(Mode::name);
        assert_eq!(names, ["exact", "fma", "f32-noise", "f32-drift"]);
    }
}
