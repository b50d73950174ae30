//! Explicit methods with a fixed step.

use ahv_core::{Model, Real, Vector};

use crate::StepError;
use crate::error::{accept, step_size};

/// The explicit Euler method, order 1, with a fixed step and a held input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Euler {
    dt: f64,
}

impl Euler {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: Model>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let slope = model.drift(x, u);
        accept(x, x.zip_with(slope, |x, k| x + dt * k))
    }
}

/// Heun's method (the explicit trapezoidal rule), order 2, with a fixed step and a held input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heun {
    dt: f64,
}

impl Heun {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: Model>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let half = dt * M::Scalar::HALF;
        let k1 = model.drift(x, u);
        let k2 = model.drift(&x.zip_with(k1, |x, k| x + dt * k), u);
        let slope = k1.zip_with(k2, |a, b| a + b);
        accept(x, x.zip_with(slope, |x, k| x + half * k))
    }
}

/// The classical Runge–Kutta method of order 4 (Kutta 1901), with a fixed step and a held input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rk4 {
    dt: f64,
}

impl Rk4 {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: Model>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let half = dt * M::Scalar::HALF;
        let sixth = dt * M::Scalar::from_f64(1.0 / 6.0);

        let k1 = model.drift(x, u);
        let k2 = model.drift(&x.zip_with(k1, |x, k| x + half * k), u);
        let k3 = model.drift(&x.zip_with(k2, |x, k| x + half * k), u);
        let k4 = model.drift(&x.zip_with(k3, |x, k| x + dt * k), u);

        let inner = k2.zip_with(k3, |a, b| M::Scalar::TWO * (a + b));
        let slope = k1.zip_with(k4, |a, b| a + b).zip_with(inner, |a, b| a + b);
        accept(x, x.zip_with(slope, |x, k| x + sixth * k))
    }
}
