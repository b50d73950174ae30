//! The steppers of `ahv-integrate`, each as one way to step a member.

use ahv_core::{
    ColouredNoise, DifferentiableNoise, GeneratedModel, ItoCorrected, Real, StochasticModel, Vector,
};
use ahv_integrate::{
    AdditiveChannels, CommutativeChannels, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein,
    ItoSra1, ItoStrangSplitting, NoiseError, StepError, StratonovichHeun, WeakIncrements,
    WienerIntegrals,
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

/// A scheme, made ready for the members of a batch.
pub(super) trait Stepping<F: GeneratedModel>: Sized + Copy + Send + Sync {
    /// The stepper `scheme` for `model` at (x, u), with steps of `dt`, in s.
    fn new(
        scheme: Scheme,
        model: &F::With<Packed>,
        x: &F::StateOf<Packed>,
        u: &F::InputOf<Packed>,
        dt: f64,
    ) -> Result<Self, NoiseError>;

    /// Normal numbers that a step takes beside one for each Wiener process.
    fn extra(&self) -> usize;

    /// Whether a step uses the number of the Wiener process that moves `column`.
    fn uses(model: &F::With<Packed>, column: &F::StateOf<Packed>) -> bool {
        let _ = (model, column);
        true
    }
}

/// A scheme that steps a model.
pub(super) trait Steps<F, M>: Stepping<F>
where
    F: GeneratedModel,
    M: StochasticModel<Scalar: Arithmetic>,
{
    /// Steps one member over `dt`, in s; `pick` takes its number from those of the batch, `normal` gives its normal numbers.
    fn step(
        &self,
        dt: f64,
        pick: impl Fn(&Packed) -> M::Scalar + Copy,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64 + Copy,
    ) -> Result<(), StepError<M::Scalar>>;
}

/// Wiener increments from normal numbers, of which the first belongs to the channel number `first`.
#[inline(always)]
fn increments<M: StochasticModel<Scalar: Arithmetic>>(
    root: f64,
    normal: impl Fn(usize) -> f64,
) -> M::Noise {
    M::Noise::from_fn(|channel| M::Scalar::of(root * normal(channel)))
}

macro_rules! plain {
    ($($name:ident, $stepper:ident, $bound:ident;)+) => {$(
        #[derive(Clone, Copy)]
        pub(super) struct $name {
            root: f64,
        }

        impl<F: GeneratedModel> Stepping<F> for $name {
            fn new(
                _: Scheme,
                _: &F::With<Packed>,
                _: &F::StateOf<Packed>,
                _: &F::InputOf<Packed>,
                dt: f64,
            ) -> Result<Self, NoiseError> {
                Ok(Self { root: dt.sqrt() })
            }

            fn extra(&self) -> usize {
                0
            }
        }

        impl<F: GeneratedModel, M: $bound<Scalar: Arithmetic>> Steps<F, M> for $name {
            #[inline(always)]
            fn step(
                &self,
                dt: f64,
                _: impl Fn(&Packed) -> M::Scalar + Copy,
                model: &M,
                x: &mut M::State,
                u: &M::Input,
                normal: impl Fn(usize) -> f64 + Copy,
            ) -> Result<(), StepError<M::Scalar>> {
                let dw = increments::<M>(self.root, normal);
                $stepper::new(dt).step(model, x, u, &dw)
            }
        }
    )+};
}

plain! {
    EulerMaruyama, ItoEulerMaruyama, StochasticModel;
    Heun, ItoHeun, ItoCorrected;
}

/// The exact transitions of `N` states of coloured noise around a step of Heun's.
#[derive(Clone, Copy)]
pub(super) struct Splitting<const N: usize> {
    splitting: ItoStrangSplitting<Packed, N>,
    root: f64,
}

impl<F: GeneratedModel, const N: usize> Stepping<F> for Splitting<N> {
    fn new(
        _: Scheme,
        model: &F::With<Packed>,
        x: &F::StateOf<Packed>,
        u: &F::InputOf<Packed>,
        dt: f64,
    ) -> Result<Self, NoiseError> {
        Ok(Self {
            splitting: ItoStrangSplitting::new(model, x, u, dt)?,
            root: dt.sqrt(),
        })
    }

    fn extra(&self) -> usize {
        2 * N
    }

    fn uses(model: &F::With<Packed>, column: &F::StateOf<Packed>) -> bool {
        (0..F::StateOf::<Packed>::LEN).any(|state| {
            let moves = column.get(state).is_some_and(is_on);
            moves && model.decay(state).is_none()
        })
    }
}

impl<F, M, const N: usize> Steps<F, M> for Splitting<N>
where
    F: GeneratedModel,
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
        normal: impl Fn(usize) -> f64 + Copy,
    ) -> Result<(), StepError<M::Scalar>> {
        let dw = increments::<M>(self.root, normal);
        let mut normals = [[M::Scalar::ZERO; N]; 2];
        for (half, normals) in normals.iter_mut().enumerate() {
            for (index, place) in normals.iter_mut().enumerate() {
                *place = M::Scalar::of(normal(M::Noise::LEN + half * N + index));
            }
        }
        let splitting = self.splitting.map_ref(pick).with_step(dt);
        splitting.step_heun(model, x, u, &dw, &normals)
    }
}

/// Whether a number is not 0 for every member.
fn is_on(value: Packed) -> bool {
    !value.all(|value| value == 0.0)
}

/// The column of the diffusion that belongs to channel number `channel`.
pub(super) fn column<M>(model: &M, x: &M::State, u: &M::Input, channel: usize) -> M::State
where
    M: StochasticModel<Scalar = Packed>,
{
    let unit = |index| Packed::splat(f64::from(u8::from(index == channel)));
    model.noise_increment(x, u, &M::Noise::from_fn(unit))
}

/// Channels that move the state, by their number.
fn channels<M>(model: &M, x: &M::State, u: &M::Input) -> [bool; MOST_NORMALS]
where
    M: StochasticModel<Scalar = Packed>,
{
    let mut on = [false; MOST_NORMALS];
    for (channel, on) in on.iter_mut().enumerate().take(M::Noise::LEN) {
        *on = column(model, x, u, channel).find(is_on).is_some();
    }
    on
}

/// Whether the channel of this name is on.
fn is_active<M: StochasticModel>(on: &[bool; MOST_NORMALS], name: &str) -> bool {
    let names = M::Noise::NAMES.iter().zip(on);
    names.into_iter().any(|(own, &on)| on && *own == name)
}

macro_rules! restricted {
    ($($name:ident, $channels:ident, $bound:ident;)+) => {$(
        #[derive(Clone, Copy)]
        pub(super) struct $name {
            on: [bool; MOST_NORMALS],
        }

        impl $name {
            fn made<M: $bound<Scalar = Packed>>(
                model: &M,
                x: &M::State,
                u: &M::Input,
            ) -> Result<Self, NoiseError> {
                let on = channels(model, x, u);
                $channels::new(model, |name| is_active::<M>(&on, name))?;
                Ok(Self { on })
            }

            /// The channels of a member's model; `made` has refused those that do not go.
            fn channels<'m, M: $bound>(
                &self,
                model: &'m M,
                dt: f64,
            ) -> Result<$channels<'m, M>, StepError<M::Scalar>> {
                $channels::new(model, |name| is_active::<M>(&self.on, name))
                    .map_err(|_| StepError::StepSize { dt })
            }
        }
    )+};
}

restricted! {
    Milstein, CommutativeChannels, DifferentiableNoise;
    Sra1, AdditiveChannels, StochasticModel;
}

/// A scheme whose members are stepped one by one: one loop serves them all, for each takes long to compile.
#[derive(Clone, Copy)]
pub(super) enum OneByOne {
    StratonovichHeun,
    Milstein(Milstein),
    Sra1(Sra1),
    Dri1,
}

impl<F: GeneratedModel> Stepping<F> for OneByOne {
    fn new(
        scheme: Scheme,
        model: &F::With<Packed>,
        x: &F::StateOf<Packed>,
        u: &F::InputOf<Packed>,
        _: f64,
    ) -> Result<Self, NoiseError> {
        Ok(match scheme {
            Scheme::Milstein => Self::Milstein(Milstein::made(model, x, u)?),
            Scheme::Sra1 => Self::Sra1(Sra1::made(model, x, u)?),
            Scheme::Dri1 => Self::Dri1,
            _ => Self::StratonovichHeun,
        })
    }

    fn extra(&self) -> usize {
        match self {
            Self::Sra1(_) => <F::NoiseOf<()> as Vector<()>>::LEN,
            Self::StratonovichHeun | Self::Milstein(_) | Self::Dri1 => 0,
        }
    }
}

impl<F: GeneratedModel, M: DifferentiableNoise<Scalar: Arithmetic>> Steps<F, M> for OneByOne {
    fn step(
        &self,
        dt: f64,
        _: impl Fn(&Packed) -> M::Scalar + Copy,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64 + Copy,
    ) -> Result<(), StepError<M::Scalar>> {
        match self {
            Self::StratonovichHeun => {
                let dw = increments::<M>(dt.sqrt(), normal);
                StratonovichHeun::new(dt).step(model, x, u, &dw)
            }
            Self::Milstein(scheme) => {
                let dw = increments::<M>(dt.sqrt(), normal);
                ItoMilstein::new(dt).step(&scheme.channels(model, dt)?, x, u, &dw)
            }
            Self::Sra1(scheme) => {
                let first = increments::<M>(1.0, normal);
                let second = increments::<M>(1.0, |channel| normal(M::Noise::LEN + channel));
                let integrals = WienerIntegrals::from_normals(dt, first, second);
                ItoSra1::new(dt).step(&scheme.channels(model, dt)?, x, u, &integrals)
            }
            Self::Dri1 => {
                let increments = WeakIncrements::from_normals(dt, normal);
                ItoDri1::new(dt).step(model, x, u, &increments)
            }
        }
    }
}
