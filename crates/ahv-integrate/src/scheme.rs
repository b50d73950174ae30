//! What stochastic schemes have in common: set-up for a model, and steps from normal numbers.

use ahv_core::{
    AdditiveNoise, ColouredNoise, CommutativeNoise, DifferentiableNoise, ItoCorrected, Real,
    StochasticModel, Vector,
};

use crate::channels::bit;
use crate::vector::{component, unit};
use crate::{
    AdditiveChannels, CommutativeChannels, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein,
    ItoSra1, ItoStrangSplitting, NoiseError, StepError, StratonovichHeun, WeakIncrements,
    WienerIntegrals,
};

/// Which stochastic integral the limit of a scheme has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Itô's.
    Ito,
    /// Stratonovich's.
    Stratonovich,
}

/// For which noise a scheme is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Admits {
    /// Any.
    Any,
    /// Noise whose columns commute.
    Commutative,
    /// Noise whose columns do not depend on the state.
    Additive,
    /// Models some of whose states are coloured noise with channels of its own.
    Coloured,
}

/// A stochastic scheme with a fixed step and a held input that takes its noise as standard normal numbers.
///
/// Code over this trait runs every scheme: it sets the scheme up once, draws [`normals`](Self::normals) independent
/// numbers a step, and steps. The example `own_scheme` implements it.
pub trait SdeScheme<M: StochasticModel>: Sized {
    /// Which integral its limit has.
    const SENSE: Sense;

    /// For which noise it is; [`set_up`](Self::set_up) checks it.
    const ADMITS: Admits;

    /// The scheme for `model` with steps of `dt`, in s. (`x`, `u`) is any point in the model's domain at which no column
    /// of G that is on vanishes.
    ///
    /// # Errors
    ///
    /// [`NoiseError`] for noise that the scheme does not admit.
    fn set_up(model: &M, x: &M::State, u: &M::Input, dt: f64) -> Result<Self, NoiseError>;

    /// How many normal numbers a step takes. The first ones, one a channel, are the Wiener increments over √`dt` if the
    /// scheme follows a Wiener path.
    #[inline]
    fn normals(&self) -> usize {
        M::Noise::LEN
    }

    /// Whether the result depends on normal number `index` for this model; (`x`, `u`) is as in [`set_up`](Self::set_up).
    #[inline]
    fn uses(&self, model: &M, x: &M::State, u: &M::Input, index: usize) -> bool {
        let _ = (model, x, u);
        index < self.normals()
    }

    /// Advances `x` by one step; `u` is held over the step. `normal(index)` is normal number `index` of the step: asked twice, it
    /// answers the same.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    fn step_from_normals(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<M::Scalar>>;
}

/// Wiener increments over a step of `dt`, in s, from the normal numbers from 0 on.
#[inline(always)]
fn increments<R: Real, W: Vector<R>>(dt: f64, normal: impl Fn(usize) -> f64) -> W {
    let root = Real::sqrt(dt);
    W::from_fn(|channel| R::from_f64(root * normal(channel)))
}

/// Those and their integrals over the step; the second numbers of the channels follow the first.
#[inline(always)]
fn integrals<R: Real, W: Vector<R>>(dt: f64, normal: impl Fn(usize) -> f64) -> WienerIntegrals<W> {
    let numbers = |first| W::from_fn(|channel| R::from_f64(normal(first + channel)));
    WienerIntegrals::from_normals(dt, numbers(0), numbers(W::LEN))
}

/// Schemes whose noise, `$noise` of the step size and the normal numbers, is all that they need to step. The count is how many
/// numbers a channel takes.
macro_rules! by_noise {
    ($($scheme:ident: $bound:ident, $sense:ident, $admits:ident, $noise:path, $count:literal;)+) => {$(
        impl<M: $bound> SdeScheme<M> for $scheme {
            const SENSE: Sense = Sense::$sense;
            const ADMITS: Admits = Admits::$admits;

            fn set_up(_: &M, _: &M::State, _: &M::Input, dt: f64) -> Result<Self, NoiseError> {
                Ok(Self::new(dt))
            }

            #[inline]
            fn normals(&self) -> usize {
                $count * M::Noise::LEN
            }

            #[inline(always)]
            fn step_from_normals(
                &self,
                model: &M,
                x: &mut M::State,
                u: &M::Input,
                normal: impl Fn(usize) -> f64,
            ) -> Result<(), StepError<M::Scalar>> {
                self.step(model, x, u, &$noise(self.dt, normal))
            }
        }
    )+};
}

by_noise! {
    ItoEulerMaruyama: StochasticModel, Ito, Any, increments, 1;
    ItoHeun: ItoCorrected, Ito, Any, increments, 1;
    StratonovichHeun: StochasticModel, Stratonovich, Any, increments, 1;
    ItoMilstein: CommutativeNoise, Ito, Commutative, increments, 1;
    ItoSra1: AdditiveNoise, Ito, Additive, integrals, 2;
    ItoDri1: StochasticModel, Ito, Any, WeakIncrements::from_normals, 2;
}

/// With [`ItoHeun`] for the other states.
impl<R, M, const N: usize> SdeScheme<M> for ItoStrangSplitting<R, N>
where
    R: Real + PartialEq,
    M: ColouredNoise<Scalar = R> + ItoCorrected,
{
    const SENSE: Sense = Sense::Ito;
    const ADMITS: Admits = Admits::Coloured;

    fn set_up(model: &M, x: &M::State, u: &M::Input, dt: f64) -> Result<Self, NoiseError> {
        Self::new(model, x, u, dt)
    }

    /// One a channel, and `N` for each half step of the coloured noise.
    #[inline]
    fn normals(&self) -> usize {
        M::Noise::LEN + 2 * N
    }

    /// The increments of channels that move coloured noise alone are not used.
    fn uses(&self, model: &M, x: &M::State, u: &M::Input, index: usize) -> bool {
        if index >= M::Noise::LEN {
            return index < SdeScheme::<M>::normals(self);
        }
        let column = model.noise_increment(x, u, &unit(index));
        (0..M::State::LEN)
            .any(|state| component(&column, state) != R::ZERO && model.decay(state).is_none())
    }

    #[inline(always)]
    fn step_from_normals(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<R>> {
        let dw = increments(self.dt, &normal);
        let mut normals = [[R::ZERO; N]; 2];
        for (half, normals) in normals.iter_mut().enumerate() {
            for (index, place) in normals.iter_mut().enumerate() {
                *place = R::from_f64(normal(M::Noise::LEN + half * N + index));
            }
        }
        self.step_heun(model, x, u, &dw, &normals)
    }
}

/// A scheme for commutative or additive noise, for models of whose type it is not known that they have such noise: set-up
/// finds the channels that are on, and refuses the model if one of these is not admitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked<S> {
    scheme: S,
    /// Channels that are on, one a bit.
    on: u64,
}

/// The channels whose columns do not vanish at (`x`, `u`), one a bit; 64 channels at most, or it does not compile.
fn channels<M>(model: &M, x: &M::State, u: &M::Input) -> u64
where
    M: StochasticModel<Scalar: PartialEq>,
{
    const { assert!(M::Noise::LEN <= 64, "at most 64 channels") };
    let moves = |channel: &usize| {
        let column = model.noise_increment(x, u, &unit(*channel));
        column.find(|value| value != M::Scalar::ZERO).is_some()
    };
    (0..M::Noise::LEN)
        .filter(moves)
        .fold(0, |on, channel| on | bit(channel))
}

macro_rules! checked {
    ($($scheme:ident: $channels:ident, $bound:ident, $admits:ident;)+) => {$(
        impl<M> SdeScheme<M> for Checked<$scheme>
        where
            M: $bound<Scalar: PartialEq>,
        {
            const SENSE: Sense = Sense::Ito;
            const ADMITS: Admits = Admits::$admits;

            fn set_up(
                model: &M,
                x: &M::State,
                u: &M::Input,
                dt: f64,
            ) -> Result<Self, NoiseError> {
                let on = channels(model, x, u);
                let scheme = $scheme::set_up(&$channels::numbered(model, on)?, x, u, dt)?;
                Ok(Self { scheme, on })
            }

            #[inline]
            fn normals(&self) -> usize {
                SdeScheme::<$channels<'_, M>>::normals(&self.scheme)
            }

            #[inline(always)]
            fn step_from_normals(
                &self,
                model: &M,
                x: &mut M::State,
                u: &M::Input,
                normal: impl Fn(usize) -> f64,
            ) -> Result<(), StepError<M::Scalar>> {
                let model = $channels::masked(model, self.on);
                self.scheme.step_from_normals(&model, x, u, normal)
            }
        }
    )+};
}

checked! {
    ItoMilstein: CommutativeChannels, DifferentiableNoise, Commutative;
    ItoSra1: AdditiveChannels, StochasticModel, Additive;
}
