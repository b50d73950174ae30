//! What kind of noise drives a model.

use core::marker::PhantomData;

use crate::Vector;

/// How a column of the diffusion depends on the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoiseClass {
    /// Not at all: additive noise.
    Constant,
    /// Each entry on the state of its own row alone.
    Diagonal,
    /// On any state.
    General,
}

/// The increments of a model without noise: a vector without components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoNoise<T>(PhantomData<T>);

impl<T> NoNoise<T> {
    /// With components of another type, of which there are none.
    #[inline(always)]
    pub fn map_ref<U>(&self, _: impl FnMut(&T) -> U) -> NoNoise<U> {
        NoNoise(PhantomData)
    }
}

impl<T: Copy> Vector<T> for NoNoise<T> {
    const LEN: usize = 0;
    const NAMES: &'static [&'static str] = &[];
    const UNITS: &'static [&'static str] = &[];
    const SI_UNITS: &'static [&'static str] = &[];
    const SI_FACTORS: &'static [f64] = &[];

    #[inline(always)]
    fn splat(_: T) -> Self {
        Self(PhantomData)
    }

    #[inline(always)]
    fn from_fn(_: impl FnMut(usize) -> T) -> Self {
        Self(PhantomData)
    }

    #[inline(always)]
    fn get(&self, _: usize) -> Option<T> {
        None
    }

    #[inline(always)]
    fn set(&mut self, _: usize, _: T) -> Option<()> {
        None
    }

    #[inline(always)]
    fn map(self, _: impl FnMut(T) -> T) -> Self {
        self
    }

    #[inline(always)]
    fn zip_with(self, _: Self, _: impl FnMut(T, T) -> T) -> Self {
        self
    }

    #[inline(always)]
    fn find(&self, _: impl FnMut(T) -> bool) -> Option<(&'static str, T)> {
        None
    }
}

/// Makes a deterministic model `Model<R>` with states `State<R>` and inputs `Input<R>` a stochastic one whose noise has no
/// channels, so that what is written for models with noise takes it too.
#[macro_export]
macro_rules! impl_no_noise {
    ($model:ident, $state:ident, $input:ident) => {
        impl<__R: $crate::Real> $crate::StochasticModel for $model<__R> {
            type Noise = $crate::NoNoise<__R>;

            #[inline(always)]
            fn noise_increment(
                &self,
                _: &$state<__R>,
                _: &$input<__R>,
                _: &Self::Noise,
            ) -> $state<__R> {
                $crate::Vector::splat(__R::ZERO)
            }
        }

        impl<__R: $crate::Real> $crate::ItoCorrected for $model<__R> {
            #[inline(always)]
            fn ito_correction(&self, _: &$state<__R>, _: &$input<__R>) -> $state<__R> {
                $crate::Vector::splat(__R::ZERO)
            }
        }

        impl<__R: $crate::Real> $crate::DifferentiableNoise for $model<__R> {
            #[inline(always)]
            fn iterated_increment(
                &self,
                _: &$state<__R>,
                _: &$input<__R>,
                _: impl FnMut(usize, usize) -> __R,
            ) -> $state<__R> {
                $crate::Vector::splat(__R::ZERO)
            }
        }

        impl<__R: $crate::Real> $crate::AdditiveNoise for $model<__R> {}

        impl<__R: $crate::Real> $crate::CommutativeNoise for $model<__R> {}
    };
}
