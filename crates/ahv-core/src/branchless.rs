//! A scalar without branches.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::{Lane, Real};

/// A number whose elementary functions have no branches, so that a loop over members becomes vector instructions.
///
/// Sine and cosine of an angle above π/4, the tangent of one above 10⁶ (singles: 10⁴) rad and the exponential of a number that
/// gives no normal one are NaN; elsewhere results have the bits of `T`. Every number counts as finite: who steps in a loop looks at the results, and computes again with
/// `T` what is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Branchless<T>(pub T);

macro_rules! operator {
    ($($name:ident, $method:ident;)+) => {$(
        impl<T: $name<Output = T>> $name for Branchless<T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )+};
}

operator! {
    Add, add;
    Sub, sub;
    Mul, mul;
    Div, div;
}

impl<T: Neg<Output = T>> Neg for Branchless<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: Lane> Real for Branchless<T> {
    const ZERO: Self = Self(T::ZERO);
    const ONE: Self = Self(T::ONE);
    const TWO: Self = Self(T::TWO);
    const HALF: Self = Self(T::HALF);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(T::from_f64(value))
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let angle = if self.0.is_small_angle() {
            self.0
        } else {
            T::NAN
        };
        let (sin, cos) = angle.small_sin_cos();
        (Self(sin), Self(cos))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let exponent = if self.0.is_moderate_exponent() {
            self.0
        } else {
            T::NAN
        };
        Self(exponent.moderate_exp())
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let angle = if self.0.is_moderate_angle() {
            self.0
        } else {
            T::NAN
        };
        Self(angle.moderate_tan())
    }

    #[inline(always)]
    fn asin(self) -> Self {
        Self(self.0.asin())
    }

    #[inline(always)]
    fn atan(self) -> Self {
        Self(self.0.atan())
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        Self(self.0.tanh())
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Self(self.0.ln())
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }

    #[inline(always)]
    fn powr(self, exponent: Self) -> Self {
        Self(self.0.powr(exponent.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
        Self(self.0.select(bound.0, below.0, otherwise.0))
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        true
    }
}

/// Nothing is beyond its ways without branches.
impl<T: Lane> Lane for Branchless<T> {
    const NAN: Self = Self(T::NAN);

    #[inline(always)]
    fn is_small_angle(self) -> bool {
        true
    }

    #[inline(always)]
    fn small_sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    #[inline(always)]
    fn is_moderate_angle(self) -> bool {
        true
    }

    #[inline(always)]
    fn moderate_sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    #[inline(always)]
    fn is_moderate_exponent(self) -> bool {
        true
    }

    #[inline(always)]
    fn moderate_exp(self) -> Self {
        self.exp()
    }

    #[inline(always)]
    fn moderate_tan(self) -> Self {
        self.tan()
    }
}
