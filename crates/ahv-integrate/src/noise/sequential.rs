//! Increments from a generator, one after the other.

use ahv_core::{Real, Vector};
use rand_distr::{Distribution, StandardNormal};

use crate::{WeakIncrements, WienerIntegrals};

/// Increments from any generator of `rand`, one after the other, through `rand_distr::StandardNormal`.
///
/// Faster than keyed numbers, but a number depends on all that were drawn before it; and its last bit may depend
/// on the platform's logarithm if a crate of the build enables `num-traits/std`. Every lane of a scalar with lanes
/// gets the same number.
#[derive(Clone, Debug)]
pub struct RandNormals<G> {
    generator: G,
}

impl<G: rand::Rng> RandNormals<G> {
    /// Increments from `generator`, a generator or a mutable reference to one.
    pub const fn new(generator: G) -> Self {
        Self { generator }
    }

    /// Independent standard normal numbers, one a component.
    pub fn normals<R: Real, W: Vector<R>>(&mut self) -> W {
        W::from_fn(|_| R::from_f64(self.normal()))
    }

    /// Wiener increments over a step of `dt`, in s: mean 0 and variance `dt`, in s^½.
    pub fn increments<R: Real, W: Vector<R>>(&mut self, dt: f64) -> W {
        let root = R::from_f64(dt).sqrt();
        self.normals::<R, W>().map(|z| root * z)
    }

    /// ΔW and ΔZ over a step of `dt`, in s.
    pub fn integrals<R: Real, W: Vector<R>>(&mut self, dt: f64) -> WienerIntegrals<W> {
        WienerIntegrals::from_normals(dt, self.normals(), self.normals())
    }

    /// Increments for a scheme of weak order 2 over a step of `dt`, in s.
    pub fn weak_increments<R: Real, W: Vector<R>>(&mut self, dt: f64) -> WeakIncrements<W> {
        WeakIncrements::from_normals(dt, |_| self.normal())
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.generator)
    }
}
