//! The scalar of the models.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::elementary::{arc, double, logarithm, single, tangent};

/// A real number, or several that are computed side by side.
///
/// Elementary functions are this crate's and `libm`'s, never the platform's: a result has the same bits on
/// every machine. There is no order but that of [`Real::select`]: generated code has no branches, so that a scalar may hold
/// several lanes. All functions follow IEEE 754; outside a function's domain the result is NaN.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
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
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine of an angle in rad.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// e to the power `self`.
    fn exp(self) -> Self;

    /// Tangent of an angle in rad; above 10⁶ rad the quotient of sine and cosine, within 3 ulp.
    fn tan(self) -> Self;

    /// Inverse sine in rad, from −π/2 to π/2; NaN beyond −1 and 1.
    fn asin(self) -> Self;

    /// Inverse tangent in rad, from −π/2 to π/2.
    fn atan(self) -> Self;

    /// Angle in rad, from −π to π, of the point with the ordinate `self` and the abscissa `x`.
    fn atan2(self, x: Self) -> Self;

    /// Hyperbolic tangent.
    fn tanh(self) -> Self;

    /// Natural logarithm; −∞ of zero, NaN below.
    fn ln(self) -> Self;

    /// `self` to the real power `exponent`, e to the power of `exponent` times the logarithm: the `powr` of IEEE 754, NaN below zero.
    fn powr(self, exponent: Self) -> Self;

    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;

    /// 1/`self`.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::ONE / self
    }

    /// Absolute value.
    fn abs(self) -> Self;

    /// `below` where `self` is below `bound`, else `otherwise`; NaN where `self` or `bound` is.
    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self;

    /// The smaller of two numbers; NaN if one is.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select(other, self, other)
    }

    /// The larger of two numbers; NaN if one is.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select(other, other, self)
    }

    /// Whether every lane is neither infinite nor NaN.
    fn is_finite(self) -> bool;
}

/// A scalar whose own sine, cosine and exponential are in `$own`. All other elementary functions are computed in doubles,
/// and a single is rounded from that.
macro_rules! real {
    ($scalar:ident, $own:ident) => {
        impl Real for $scalar {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const HALF: Self = 0.5;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $own::sin_cos(self)
            }

            #[inline(always)]
            fn exp(self) -> Self {
                $own::exp(self)
            }

            #[inline(always)]
            fn tan(self) -> Self {
                double::tan(f64::from(self)) as Self
            }

            #[inline(always)]
            fn asin(self) -> Self {
                arc::asin(f64::from(self)) as Self
            }

            #[inline(always)]
            fn atan(self) -> Self {
                arc::atan(f64::from(self)) as Self
            }

            #[inline(always)]
            fn tanh(self) -> Self {
                tangent::tanh(f64::from(self)) as Self
            }

            #[inline(always)]
            fn ln(self) -> Self {
                logarithm::ln(f64::from(self)) as Self
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                arc::atan2(f64::from(self), f64::from(x)) as Self
            }

            #[inline(always)]
            fn powr(self, exponent: Self) -> Self {
                logarithm::powr(f64::from(self), f64::from(exponent)) as Self
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                root::$own(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $scalar::abs(self)
            }

            #[inline(always)]
            fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
                let chosen = if self < bound { below } else { otherwise };
                if self < bound || self >= bound {
                    chosen
                } else {
                    Self::NAN
                }
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                $scalar::is_finite(self)
            }
        }
    };
}

real!(f64, double);
real!(f32, single);

/// Square roots: of `core` there are none, and `libm`'s do not become vector instructions. Both round correctly.
#[cfg(not(feature = "std"))]
mod root {
    pub(super) use libm::{sqrt as double, sqrtf as single};
}

#[cfg(feature = "std")]
mod root {
    #[inline(always)]
    pub(super) fn double(x: f64) -> f64 {
        std::primitive::f64::sqrt(x)
    }

    #[inline(always)]
    pub(super) fn single(x: f32) -> f32 {
        std::primitive::f32::sqrt(x)
    }
}
