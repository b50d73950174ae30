//! The scalar of the models.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::elementary;

/// A real number, or several that are computed side by side.
///
/// Elementary functions are this crate's and `libm`'s, never the platform's: a result has the same bits on
/// every machine. There is no order: generated code has no branches, so that a scalar may hold
/// several lanes. All functions follow IEEE 754; outside a function's domain the result is NaN.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// 0
    const ZERO: Self;
    /// 1
    const ONE: Self;
    /// 2
    const TWO: Self;
    /// 1/2
    const HALF: Self;

    /// The nearest value to `value`, in every lane.
    fn from_f64(value: f64) -> Self;

    /// One number to show to a person; a scalar with lanes shows its first non-finite lane, else its first.
    fn to_f64(self) -> f64;

    /// Sine and cosine of an angle in rad; they share the reduction of the argument.
    fn sin_cos(self) -> (Self, Self);

    /// Sine of an angle in rad.
    fn sin(self) -> Self;

    /// Cosine of an angle in rad.
    fn cos(self) -> Self;

    /// e to the power `self`.
    fn exp(self) -> Self;

    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;

    /// 1/`self`.
    fn recip(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// Whether every lane is neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const HALF: Self = 0.5;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    #[inline]
    fn sin(self) -> Self {
        elementary::sin_cos(self).0
    }

    #[inline]
    fn cos(self) -> Self {
        elementary::sin_cos(self).1
    }

    #[inline]
    fn exp(self) -> Self {
        elementary::exp(self)
    }

    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }

    #[inline]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const HALF: Self = 0.5;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincosf(self)
    }

    #[inline]
    fn sin(self) -> Self {
        libm::sinf(self)
    }

    #[inline]
    fn cos(self) -> Self {
        libm::cosf(self)
    }

    #[inline]
    fn exp(self) -> Self {
        libm::expf(self)
    }

    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }

    #[inline]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline]
    fn abs(self) -> Self {
        f32::abs(self)
    }

    #[inline]
    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}
