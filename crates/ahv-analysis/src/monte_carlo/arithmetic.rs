//! What members are computed with.

use std::marker::PhantomData;

use ahv_core::{Branchless, GeneratedModel, NoInline, Real};

use super::lanes::Packed;

/// Which arithmetic the members are flown with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Doubles; every operation is rounded by itself, so that results are the same on every machine.
    #[default]
    Exact,
    /// Doubles, with the normal numbers of the noise in single precision.
    F32Noise,
}

impl Mode {
    /// All modes.
    pub const ALL: [Self; 2] = [Self::Exact, Self::F32Noise];

    /// Its name on command lines and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::F32Noise => "f32-noise",
        }
    }
}

/// A scalar that members are flown with.
pub(super) trait Arithmetic: Real + PartialEq {
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

impl Arithmetic for Branchless<f64> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.0
    }
}

/// Members flown with the scalar `R`.
#[derive(Clone, Copy)]
pub(super) struct In<R>(PhantomData<R>);

impl<F: GeneratedModel, R: Arithmetic> Member<F> for In<R> {
    const SIDE_BY_SIDE: bool = true;

    type Scalar = R;
    type Model = F::With<R>;

    #[inline(always)]
    fn model(model: &F::With<Packed>, lane: usize) -> Self::Model {
        F::map_model(model, |numbers: &Packed| R::of(numbers.0[lane]))
    }
}

/// Makes a member's model of the batch's.
pub(super) trait Member<F: GeneratedModel>: Copy {
    /// Whether a loop over such members becomes vector instructions.
    const SIDE_BY_SIDE: bool;

    type Scalar: Arithmetic;
    type Model: ahv_core::StochasticModel<
            Scalar = Self::Scalar,
            State = F::StateOf<Self::Scalar>,
            Input = F::InputOf<Self::Scalar>,
            Noise = F::NoiseOf<Self::Scalar>,
        >;

    fn model(model: &F::With<Packed>, lane: usize) -> Self::Model;
}

/// As `K`, with models that are called, not inlined.
#[derive(Clone, Copy)]
pub(super) struct Called<K>(PhantomData<K>);

impl<F: GeneratedModel, K: Member<F>> Member<F> for Called<K> {
    const SIDE_BY_SIDE: bool = false;

    type Scalar = K::Scalar;
    type Model = NoInline<K::Model>;

    #[inline(always)]
    fn model(model: &F::With<Packed>, lane: usize) -> Self::Model {
        NoInline(K::model(model, lane))
    }
}

#[cfg(test)]
mod tests {
    use super::Mode;

    /// Command lines and files of earlier versions hold them.
    #[test]
    fn modes_keep_their_names() {
        let names = Mode::ALL.map(Mode::name);
        assert_eq!(names, ["exact", "f32-noise"]);
    }
}
