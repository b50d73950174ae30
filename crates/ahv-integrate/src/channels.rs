//! Models with some of their noise channels switched off, and why a scheme refuses a model.

use core::fmt;

use ahv_core::{
    AdditiveNoise, CommutativeNoise, DifferentiableNoise, ItoCorrected, Model, NoiseClass, Real,
    Shown, StochasticModel, Vector,
};

use crate::vector::component;

/// Why a scheme does not apply to the noise of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseError {
    /// The scheme needs additive noise.
    NotAdditive {
        /// Name of the first active channel whose column of G is not constant.
        channel: &'static str,
        /// How that column depends on the state.
        class: NoiseClass,
    },
    /// The scheme needs commutative noise.
    NotCommuting {
        /// Name of the first channel of a pair whose columns of G do not commute.
        first: &'static str,
        /// Name of the second.
        second: &'static str,
    },
    /// One channel moves coloured noise and other states too: they cannot be stepped one after the other.
    SharedChannel {
        /// Name of the channel.
        channel: &'static str,
        /// Name of a state that is no coloured noise and that the channel moves.
        state: &'static str,
    },
    /// The model has another number of coloured-noise states than the scheme was made for.
    ColouredStates {
        /// The number that the scheme was made for.
        expected: usize,
        /// The number that the model has.
        found: usize,
    },
    /// The step size is not a positive, finite number.
    StepSize {
        /// The step size in s.
        dt: f64,
    },
}

impl fmt::Display for NoiseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAdditive { channel, class } => {
                let depends = match class {
                    NoiseClass::Constant => "is not known to be constant",
                    NoiseClass::Diagonal => "depends on the states that it drives",
                    NoiseClass::General => "may depend on any state",
                };
                write!(
                    f,
                    "the scheme needs additive noise, but what {channel} does {depends}"
                )
            }
            Self::NotCommuting { first, second } => write!(
                f,
                "the scheme needs commutative noise, but {first} and {second} do not commute"
            ),
            Self::SharedChannel { channel, state } => write!(
                f,
                "coloured noise cannot be stepped by itself: {channel} drives it and {state} too"
            ),
            Self::ColouredStates { expected, found } => write!(
                f,
                "the splitting is for {expected} states of coloured noise, the model has {found}"
            ),
            Self::StepSize { dt } => {
                let dt = Shown(*dt);
                write!(f, "the step size must be positive and finite, not {dt} s")
            }
        }
    }
}

impl core::error::Error for NoiseError {}

/// The name of channel `index`.
fn name<M: StochasticModel>(index: usize) -> &'static str {
    M::Noise::NAMES.get(index).copied().unwrap_or("")
}

/// The channels for whose name `active` is true, one a bit; 64 channels at most, or it does not compile.
fn numbers<M: StochasticModel>(mut active: impl FnMut(&'static str) -> bool) -> u64 {
    const { assert!(M::Noise::LEN <= 64, "at most 64 channels") };
    (0..M::Noise::LEN)
        .filter(|&index| active(name::<M>(index)))
        .fold(0, |on, index| on | bit(index))
}

/// The bit of channel `index`, which is below 64.
#[inline(always)]
pub(crate) fn bit(index: usize) -> u64 {
    1_u64.wrapping_shl(index as u32)
}

/// Whether channel `index` is one of `on`.
#[inline(always)]
fn is_on(on: u64, index: usize) -> bool {
    on & bit(index) != 0
}

/// 1 for each channel of `on`, 0 for the others.
#[inline(always)]
fn mask<M: StochasticModel>(on: u64) -> M::Noise {
    M::Noise::from_fn(|index| {
        if is_on(on, index) {
            M::Scalar::ONE
        } else {
            M::Scalar::ZERO
        }
    })
}

/// A model with only some of its channels on, which all are additive: what
/// [`ItoSra1`](crate::ItoSra1) asks for.
///
/// For a model whose type does not say that its noise is additive, such as SDCOM with only the flexible modes and the
/// pitch rate disturbed.
#[derive(Clone, Copy, Debug)]
pub struct AdditiveChannels<'m, M: StochasticModel> {
    model: &'m M,
    mask: M::Noise,
}

impl<'m, M: StochasticModel> AdditiveChannels<'m, M> {
    /// `model` with the channels on for whose name `active` is true.
    ///
    /// # Errors
    ///
    /// [`NoiseError::NotAdditive`] if the column of such a channel may depend on the state.
    pub fn new(model: &'m M, active: impl FnMut(&'static str) -> bool) -> Result<Self, NoiseError> {
        Self::numbered(model, numbers::<M>(active))
    }

    /// The same for the channels `on`, one a bit.
    pub(crate) fn numbered(model: &'m M, on: u64) -> Result<Self, NoiseError> {
        for index in 0..M::Noise::LEN {
            let (channel, class) = (name::<M>(index), M::noise_class(index));
            if is_on(on, index) && class != NoiseClass::Constant {
                return Err(NoiseError::NotAdditive { channel, class });
            }
        }
        Ok(Self::masked(model, on))
    }
}

/// A model with only some of its channels on, which all commute: what [`ItoMilstein`](crate::ItoMilstein) asks for.
#[derive(Clone, Copy, Debug)]
pub struct CommutativeChannels<'m, M: StochasticModel> {
    model: &'m M,
    mask: M::Noise,
}

impl<'m, M: DifferentiableNoise> CommutativeChannels<'m, M> {
    /// `model` with the channels on for whose name `active` is true.
    ///
    /// # Errors
    ///
    /// [`NoiseError::NotCommuting`] if the columns of two such channels do not commute.
    pub fn new(model: &'m M, active: impl FnMut(&'static str) -> bool) -> Result<Self, NoiseError> {
        Self::numbered(model, numbers::<M>(active))
    }

    /// The same for the channels `on`, one a bit.
    pub(crate) fn numbered(model: &'m M, on: u64) -> Result<Self, NoiseError> {
        // A column commutes with itself.
        let pairs = (0..M::Noise::LEN).flat_map(|j| (0..j).map(move |k| (k, j)));
        for (k, j) in pairs {
            let (first, second) = (name::<M>(k), name::<M>(j));
            if is_on(on, k) && is_on(on, j) && !M::noise_commutes(k, j) {
                return Err(NoiseError::NotCommuting { first, second });
            }
        }
        Ok(Self::masked(model, on))
    }
}

macro_rules! masked {
    ($name:ident, $bound:ident) => {
        impl<'m, M: $bound> $name<'m, M> {
            /// `model` with the channels `on`, one a bit, which are known to be admitted.
            #[inline(always)]
            pub(crate) fn masked(model: &'m M, on: u64) -> Self {
                Self {
                    model,
                    mask: mask::<M>(on),
                }
            }
        }

        impl<M: $bound> Model for $name<'_, M> {
            type Scalar = M::Scalar;
            type State = M::State;
            type Input = M::Input;

            #[inline(always)]
            fn drift(&self, x: &M::State, u: &M::Input) -> M::State {
                self.model.drift(x, u)
            }
        }

        impl<M: $bound> StochasticModel for $name<'_, M> {
            type Noise = M::Noise;

            #[inline(always)]
            fn noise_increment(&self, x: &M::State, u: &M::Input, dw: &M::Noise) -> M::State {
                let dw = dw.zip_with(self.mask, |dw, part| dw * part);
                self.model.noise_increment(x, u, &dw)
            }

            #[inline(always)]
            fn drift_and_noise_increment(
                &self,
                x: &M::State,
                u: &M::Input,
                dw: &M::Noise,
            ) -> (M::State, M::State) {
                let dw = dw.zip_with(self.mask, |dw, part| dw * part);
                self.model.drift_and_noise_increment(x, u, &dw)
            }

            fn noise_class(channel: usize) -> NoiseClass {
                M::noise_class(channel)
            }

            fn noise_commutes(first: usize, second: usize) -> bool {
                M::noise_commutes(first, second)
            }
        }
    };
}

masked!(AdditiveChannels, StochasticModel);
masked!(CommutativeChannels, DifferentiableNoise);

impl<M: StochasticModel> AdditiveNoise for AdditiveChannels<'_, M> {}

impl<M: StochasticModel> ItoCorrected for AdditiveChannels<'_, M> {
    #[inline(always)]
    fn ito_correction(&self, _: &M::State, _: &M::Input) -> M::State {
        M::State::splat(M::Scalar::ZERO)
    }
}

impl<M: DifferentiableNoise> CommutativeNoise for CommutativeChannels<'_, M> {}

impl<M: DifferentiableNoise> ItoCorrected for CommutativeChannels<'_, M> {
    #[inline(always)]
    fn ito_correction(&self, x: &M::State, u: &M::Input) -> M::State {
        self.model.iterated_increment(x, u, |j, k| {
            if j == k {
                M::Scalar::HALF * component(&self.mask, j)
            } else {
                M::Scalar::ZERO
            }
        })
    }
}

impl<M: DifferentiableNoise> DifferentiableNoise for CommutativeChannels<'_, M> {
    #[inline(always)]
    fn iterated_increment(
        &self,
        x: &M::State,
        u: &M::Input,
        mut integral: impl FnMut(usize, usize) -> M::Scalar,
    ) -> M::State {
        self.model.iterated_increment(x, u, |j, k| {
            component(&self.mask, j) * component(&self.mask, k) * integral(j, k)
        })
    }
}
