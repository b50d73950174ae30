//! A scalar that multiplies and adds in one rounding.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::{Real, Straight};

/// A scalar with a fused multiply-add.
pub trait MulAdd: Real {
    /// `self`·`factor` + `addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
}

impl MulAdd for f64 {
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        std::primitive::f64::mul_add(self, factor, addend)
    }
}

impl<T: MulAdd + crate::Lane> MulAdd for Straight<T> {
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0))
    }
}

/// A number that is a product not yet rounded, so that generated code, which knows nothing of it, adds products in one
/// rounding.
///
/// Products have no rounding of their own before they are added, which changes last bits: a mode to be asked for by name. For
/// targets with the instruction; elsewhere each addition is a call.
#[derive(Clone, Copy, Debug)]
pub struct Fused<T> {
    /// The factors; the second is 1 where there is none. The compiler knows it, and drops multiplications by it.
    factors: [T; 2],
}

impl<T: MulAdd> Fused<T> {
    /// The number `value`.
    #[inline(always)]
    pub const fn new(value: T) -> Self {
        Self {
            factors: [value, T::ONE],
        }
    }

    /// The number, rounded.
    #[inline(always)]
    pub fn value(self) -> T {
        let [a, b] = self.factors;
        a * b
    }
}

impl<T: MulAdd> PartialEq for Fused<T>
where
    T: PartialEq,
{
    fn eq(&self, other: &Self) -> bool {
        self.value() == other.value()
    }
}

impl<T: MulAdd> Add for Fused<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let [a, b] = other.factors;
        Self::new(a.mul_add(b, self.value()))
    }
}

impl<T: MulAdd> Sub for Fused<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let [a, b] = other.factors;
        Self::new((-a).mul_add(b, self.value()))
    }
}

impl<T: MulAdd> Mul for Fused<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            factors: [self.value(), other.value()],
        }
    }
}

impl<T: MulAdd> Div for Fused<T> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::new(self.value() / other.value())
    }
}

impl<T: MulAdd> Neg for Fused<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b] = self.factors;
        Self { factors: [-a, b] }
    }
}

impl<T: MulAdd> Real for Fused<T> {
    const ZERO: Self = Self::new(T::ZERO);
    const ONE: Self = Self::new(T::ONE);
    const TWO: Self = Self::new(T::TWO);
    const HALF: Self = Self::new(T::HALF);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::new(T::from_f64(value))
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value().to_f64()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value().sin_cos();
        (Self::new(sin), Self::new(cos))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        Self::new(self.value().sin())
    }

    #[inline(always)]
    fn cos(self) -> Self {
        Self::new(self.value().cos())
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Self::new(self.value().exp())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::new(self.value().sqrt())
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::new(self.value().recip())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::new(self.value().abs())
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.value().is_finite()
    }
}
