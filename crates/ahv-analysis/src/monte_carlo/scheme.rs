//! The schemes of `ahv-integrate` by name, and how each steps a member of a batch.

use ahv_core::{ColouredNoise, DifferentiableNoise, ItoCorrected, StochasticModel};
use ahv_integrate::{
    Checked, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting,
    SdeScheme, StepError, StratonovichHeun,
};

use super::arithmetic::Arithmetic;
use super::lanes::Packed;

/// Normal numbers that a step of a member takes at most.
pub(super) const MOST_NORMALS: usize = 32;

/// By which stepper of `ahv-integrate` members are flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// `ItoStrangSplitting` with `ItoHeun`: coloured noise exactly; for models that have it.
    Splitting,
    /// `ItoHeun`.
    Heun,
    /// `ItoEulerMaruyama`.
    EulerMaruyama,
    /// `StratonovichHeun`: reads the equations in the Stratonovich sense.
    StratonovichHeun,
    /// `ItoMilstein`, if the channels that are on commute.
    Milstein,
    /// `ItoSra1`, if the channels that are on are additive.
    Sra1,
    /// `ItoDri1`.
    Dri1,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Self; 7] = [
        Self::Splitting,
        Self::Heun,
        Self::EulerMaruyama,
        Self::StratonovichHeun,
        Self::Milstein,
        Self::Sra1,
        Self::Dri1,
    ];

    /// Its name on command lines and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Splitting => "splitting",
            Self::Heun => "heun",
            Self::EulerMaruyama => "euler-maruyama",
            Self::StratonovichHeun => "stratonovich-heun",
            Self::Milstein => "milstein",
            Self::Sra1 => "sra1",
            Self::Dri1 => "dri1",
        }
    }
}

/// A scheme that was set up for the members of a batch, and steps one of them.
pub(super) trait Steps<M>: Copy + Send + Sync
where
    M: StochasticModel<Scalar: Arithmetic>,
{
    /// Steps one member; `pick` takes its number from those of the batch, `normal` gives its normal numbers. `dt`, in s, is the
    /// step of the set-up: where the caller knows it to be positive, the loop over members has no check.
    fn step(
        &self,
        dt: f64,
        pick: impl Fn(&Packed) -> M::Scalar + Copy,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<M::Scalar>>;
}

/// Schemes with no number but the step.
macro_rules! plain {
    ($($scheme:ident: $bound:ident;)+) => {$(
        impl<M: $bound<Scalar: Arithmetic>> Steps<M> for $scheme {
            #[inline(always)]
            fn step(
                &self,
                dt: f64,
                _: impl Fn(&Packed) -> M::Scalar + Copy,
                model: &M,
                x: &mut M::State,
                u: &M::Input,
                normal: impl Fn(usize) -> f64,
            ) -> Result<(), StepError<M::Scalar>> {
                Self::new(dt).step_from_normals(model, x, u, normal)
            }
        }
    )+};
}

plain! {
    ItoEulerMaruyama: StochasticModel;
    ItoHeun: ItoCorrected;
}

impl<M, const N: usize> Steps<M> for ItoStrangSplitting<Packed, N>
where
    M: ColouredNoise<Scalar: Arithmetic> + ItoCorrected,
{
    #[inline(always)]
    fn step(
        &self,
        dt: f64,
        pick: impl Fn(&Packed) -> M::Scalar + Copy,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<M::Scalar>> {
        let member = self.map_ref(pick).with_step(dt);
        member.step_from_normals(model, x, u, normal)
    }
}

/// A scheme whose members are stepped one by one: one loop serves them all, for each takes long to compile.
#[derive(Clone, Copy)]
pub(super) enum OneByOne {
    StratonovichHeun(StratonovichHeun),
    Milstein(Checked<ItoMilstein>),
    Sra1(Checked<ItoSra1>),
    Dri1(ItoDri1),
}

macro_rules! one_by_one {
    ($($variant:ident($scheme:ty);)+) => {$(
        impl From<$scheme> for OneByOne {
            fn from(scheme: $scheme) -> Self {
                Self::$variant(scheme)
            }
        }
    )+};
}

one_by_one! {
    StratonovichHeun(StratonovichHeun);
    Milstein(Checked<ItoMilstein>);
    Sra1(Checked<ItoSra1>);
    Dri1(ItoDri1);
}

impl<M: DifferentiableNoise<Scalar: Arithmetic>> Steps<M> for OneByOne {
    fn step(
        &self,
        _: f64,
        _: impl Fn(&Packed) -> M::Scalar + Copy,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<M::Scalar>> {
        match self {
            Self::StratonovichHeun(scheme) => scheme.step_from_normals(model, x, u, normal),
            Self::Milstein(scheme) => scheme.step_from_normals(model, x, u, normal),
            Self::Sra1(scheme) => scheme.step_from_normals(model, x, u, normal),
            Self::Dri1(scheme) => scheme.step_from_normals(model, x, u, normal),
        }
    }
}
