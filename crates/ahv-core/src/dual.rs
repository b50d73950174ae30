//! Exact derivatives of functions of a [`Real`], by numbers that carry a slope.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Real;

/// A number with its derivative by one variable.
///
/// A function that is written for any [`Real`] has its exact derivative when it is computed with these numbers; of `Dual<Dual<R>>`
/// the second one, too.
///
/// ```
/// use ahv_core::{Dual, Real};
///
/// // d/dx sin² x = 2 sin x cos x.
/// let x = Dual { value: 0.3, slope: 1.0 };
/// let (sin, cos) = Real::sin_cos(0.3_f64);
/// assert_eq!((x.sin() * x.sin()).slope, 2.0 * sin * cos);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<R = f64> {
    /// The number.
    pub value: R,
    /// Its derivative.
    pub slope: R,
}

impl<R: Real> Dual<R> {
    /// A constant.
    pub const fn constant(value: R) -> Self {
        Self {
            value,
            slope: R::ZERO,
        }
    }

    /// The variable that derivatives are by.
    pub const fn variable(value: R) -> Self {
        Self {
            value,
            slope: R::ONE,
        }
    }

    /// A function of this number, from its value and its derivative.
    fn through(self, value: R, derivative: R) -> Self {
        Self {
            value,
            slope: derivative * self.slope,
        }
    }
}

impl<R: Real> Add for Dual<R> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<R: Real> Sub for Dual<R> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<R: Real> Mul for Dual<R> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl<R: Real> Div for Dual<R> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl<R: Real> Neg for Dual<R> {
    type Output = Self;

    fn neg(self) -> Self {
        self.through(-self.value, -R::ONE)
    }
}

impl<R: Real> Real for Dual<R> {
    const ZERO: Self = Self::constant(R::ZERO);
    const ONE: Self = Self::constant(R::ONE);
    const TWO: Self = Self::constant(R::TWO);
    const HALF: Self = Self::constant(R::HALF);

    fn from_f64(value: f64) -> Self {
        Self::constant(R::from_f64(value))
    }

    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.through(sin, cos), self.through(cos, -sin))
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        self.through(value, value)
    }

    fn tan(self) -> Self {
        let value = self.value.tan();
        self.through(value, R::ONE + value * value)
    }

    fn asin(self) -> Self {
        let x = self.value;
        self.through(x.asin(), ((R::ONE - x) * (R::ONE + x)).sqrt().recip())
    }

    fn atan(self) -> Self {
        let x = self.value;
        self.through(x.atan(), (R::ONE + x * x).recip())
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self {
            value: self.value.atan2(x.value),
            slope: (x.value * self.slope - self.value * x.slope) / square,
        }
    }

    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.through(value, R::ONE - value * value)
    }

    fn ln(self) -> Self {
        self.through(self.value.ln(), self.value.recip())
    }

    fn powr(self, exponent: Self) -> Self {
        let (x, y) = (self.value, exponent.value);
        let value = x.powr(y);
        // A constant exponent has no slope, whatever the logarithm of the base.
        let size = exponent.slope.abs();
        let of_exponent = R::ZERO.select(size, value * x.ln() * exponent.slope, R::ZERO);
        Self {
            value,
            slope: y * x.powr(y - R::ONE) * self.slope + of_exponent,
        }
    }

    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.through(value, R::HALF / value)
    }

    fn abs(self) -> Self {
        let positive = R::ZERO.select(self.value, R::ONE, R::ZERO);
        let sign = self.value.select(R::ZERO, -R::ONE, positive);
        self.through(self.value.abs(), sign)
    }

    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
        let choose = |a, b| self.value.select(bound.value, a, b);
        Self {
            value: choose(below.value, otherwise.value),
            slope: choose(below.slope, otherwise.slope),
        }
    }

    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
}
