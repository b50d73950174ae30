//! A splitting that steps coloured noise exactly.

use core::array::from_fn;

use ahv_core::{ColouredNoise, ItoCorrected, Model, NoiseClass, Real, StochasticModel, Vector};

use crate::error::accept;
use crate::vector::{component, unit};
use crate::{ItoHeun, LinearTransition, NoiseError, StepError};

/// Strang's splitting for Itô equations with `N` states of coloured noise, with a fixed step and a held input.
///
/// Half a step of the Ornstein–Uhlenbeck processes by their exact transition, a step of the other states by a scheme of
/// the caller's with the processes held, half a step of the processes again (Strang 1968). The processes have their exact
/// law, with the covariance of those that share white noise, at any step size. The step has to resolve the processes'
/// decay only as far as the other states feel it.
///
/// The weak order is 2 with a scheme of weak order 2 for the other states, else 1. [`step_heun`](Self::step_heun) has order
/// 2 if the columns of the other states are additive, and order 1 if they are not; [`step`](Self::step) with
/// [`ItoDri1`](crate::ItoDri1) has order 2 for any columns. There is no strong order: the normal numbers stand for no Wiener
/// path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoStrangSplitting<R, const N: usize> {
    half: LinearTransition<R, N>,
    pub(crate) dt: f64,
}

impl<R: Real, const N: usize> ItoStrangSplitting<R, N> {
    /// The splitting of `model` for a step size `dt`, in s. `x` and `u` are any state and input in the model's domain; the
    /// transition does not depend on them.
    ///
    /// # Errors
    ///
    /// [`NoiseError`]: the model has not `N` states of coloured noise; a channel that drives them is not additive, or
    /// moves other states at (x, u) too; `dt` is not positive and finite.
    pub fn new<M: ColouredNoise<Scalar = R>>(
        model: &M,
        x: &M::State,
        u: &M::Input,
        dt: f64,
    ) -> Result<Self, NoiseError> {
        let found = coloured(model).count();
        if found != N {
            return Err(NoiseError::ColouredStates { expected: N, found });
        }
        let mut intensity = [[R::ZERO; N]; N];
        for channel in 0..M::Noise::LEN {
            let column = model.noise_increment(x, u, &unit(channel));
            if moves(&column, |state| model.decay(state).is_some()).is_none() {
                continue;
            }
            let name = M::Noise::NAMES.get(channel).copied().unwrap_or("");
            let class = M::noise_class(channel);
            if class != NoiseClass::Constant {
                return Err(NoiseError::NotAdditive {
                    channel: name,
                    class,
                });
            }
            if let Some(state) = moves(&column, |state| model.decay(state).is_none()) {
                return Err(NoiseError::SharedChannel {
                    channel: name,
                    state,
                });
            }
            let part: [R; N] = gathered(model, &column);
            for (row, &a) in intensity.iter_mut().zip(&part) {
                for (entry, &b) in row.iter_mut().zip(&part) {
                    *entry = *entry + a * b;
                }
            }
        }
        let mut rates = coloured(model).filter_map(|state| model.decay(state));
        let rates: [R; N] = from_fn(|_| rates.next().unwrap_or(R::ZERO));
        let mut a = [[R::ZERO; N]; N];
        for (index, (row, rate)) in a.iter_mut().zip(rates).enumerate() {
            if let Some(entry) = row.get_mut(index) {
                *entry = -rate;
            }
        }
        let half = LinearTransition::new(a, intensity, 0.5 * dt)
            .map_err(|_| NoiseError::StepSize { dt })?;
        Ok(Self { half, dt })
    }

    /// The splitting with another scalar: `f` applied to every entry of the transition.
    #[inline(always)]
    pub fn map_ref<U: Real>(&self, f: impl Fn(&R) -> U + Copy) -> ItoStrangSplitting<U, N> {
        ItoStrangSplitting {
            half: self.half.map_ref(f),
            dt: self.dt,
        }
    }

    /// The same transition; the other states are stepped by `dt`, in s.
    #[must_use]
    #[inline(always)]
    pub const fn with_step(self, dt: f64) -> Self {
        Self { dt, ..self }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// `normals` are independent standard normal numbers for the two half steps of the coloured noise. `others` steps
    /// the other states over the given time, in s, by any scheme for stochastic or deterministic models: it gets the model
    /// without the coloured noise's motion. Increments that it uses must be independent of `normals`: a
    /// [`WienerSource<C>`](crate::WienerSource) uses channels 0 to C − 1 of its member, so that streams of channels C to
    /// C + 2`N` − 1 give `normals`.
    ///
    /// # Errors
    ///
    /// [`StepError`], also that of `others`; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: ColouredNoise<Scalar = R>>(
        &self,
        model: &M,
        x: &mut M::State,
        normals: &[[R; N]; 2],
        others: impl FnOnce(&HeldColoured<'_, M>, &mut M::State, f64) -> Result<(), StepError<R>>,
    ) -> Result<(), StepError<R>> {
        let [first, second] = normals;
        let mut next = self.coloured_half(model, *x, first);
        others(&HeldColoured { model }, &mut next, self.dt)?;
        accept(x, self.coloured_half(model, next, second))
    }

    /// The same with [`ItoHeun`] for the other states: weak order 2 if their noise is additive, else 1. `dw` are the Wiener
    /// increments over the step, in s^½, of which those that drive coloured noise are not used. They are independent of
    /// `normals`, as in [`step`](Self::step).
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step_heun<M: ColouredNoise<Scalar = R> + ItoCorrected>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        dw: &M::Noise,
        normals: &[[R; N]; 2],
    ) -> Result<(), StepError<R>> {
        // As `step`, without its closure: one that holds a model is too large to be inlined.
        let [first, second] = normals;
        let mut next = self.coloured_half(model, *x, first);
        ItoHeun::new(self.dt).step(&HeldColoured { model }, &mut next, u, dw)?;
        accept(x, self.coloured_half(model, next, second))
    }

    #[inline(always)]
    fn coloured_half<M: ColouredNoise<Scalar = R>>(
        &self,
        model: &M,
        x: M::State,
        normals: &[R; N],
    ) -> M::State {
        let after = self.half.free_step(&gathered(model, &x), normals);
        let (mut next, mut values) = (x, after.iter());
        for state in 0..M::State::LEN {
            if model.decay(state).is_some()
                && let Some(&value) = values.next()
            {
                // The index is one of the state's own.
                let _ = next.set(state, value);
            }
        }
        next
    }
}

/// A model whose coloured noise stands still: the equation of the other states alone.
#[derive(Clone, Copy, Debug)]
pub struct HeldColoured<'m, M> {
    model: &'m M,
}

impl<M: ColouredNoise> HeldColoured<'_, M> {
    #[inline(always)]
    fn held(&self, rate: M::State) -> M::State {
        M::State::from_fn(|state| match self.model.decay(state) {
            Some(_) => M::Scalar::ZERO,
            None => component(&rate, state),
        })
    }
}

impl<M: ColouredNoise> Model for HeldColoured<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;
    type Input = M::Input;

    #[inline(always)]
    fn drift(&self, x: &M::State, u: &M::Input) -> M::State {
        self.held(self.model.drift(x, u))
    }
}

impl<M: ColouredNoise> StochasticModel for HeldColoured<'_, M> {
    type Noise = M::Noise;

    #[inline(always)]
    fn noise_increment(&self, x: &M::State, u: &M::Input, dw: &M::Noise) -> M::State {
        self.held(self.model.noise_increment(x, u, dw))
    }

    #[inline(always)]
    fn drift_and_noise_increment(
        &self,
        x: &M::State,
        u: &M::Input,
        dw: &M::Noise,
    ) -> (M::State, M::State) {
        let (drift, noise) = self.model.drift_and_noise_increment(x, u, dw);
        (self.held(drift), self.held(noise))
    }

    fn noise_class(channel: usize) -> NoiseClass {
        M::noise_class(channel)
    }

    fn noise_commutes(first: usize, second: usize) -> bool {
        M::noise_commutes(first, second)
    }
}

impl<M: ColouredNoise + ItoCorrected> ItoCorrected for HeldColoured<'_, M> {
    /// That of the model: the columns of coloured noise are constant and add nothing to it.
    #[inline(always)]
    fn ito_correction(&self, x: &M::State, u: &M::Input) -> M::State {
        self.held(self.model.ito_correction(x, u))
    }
}

/// The states of coloured noise.
fn coloured<M: ColouredNoise>(model: &M) -> impl Iterator<Item = usize> + '_ {
    (0..M::State::LEN).filter(|&state| model.decay(state).is_some())
}

/// The components of coloured noise.
#[inline(always)]
fn gathered<M: ColouredNoise, const N: usize>(model: &M, x: &M::State) -> [M::Scalar; N] {
    let mut parts = [M::Scalar::ZERO; N];
    let mut places = parts.iter_mut();
    for state in 0..M::State::LEN {
        if model.decay(state).is_some()
            && let Some(place) = places.next()
        {
            *place = component(x, state);
        }
    }
    parts
}

/// The name of the first of these states that a column moves.
fn moves<R: Real, X: Vector<R>>(column: &X, among: impl Fn(usize) -> bool) -> Option<&'static str> {
    (0..X::LEN)
        .filter(|&state| among(state))
        .find(|&state| component(column, state).to_f64() != 0.0)
        .and_then(|state| X::NAMES.get(state).copied())
}
