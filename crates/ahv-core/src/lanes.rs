//! Several numbers side by side.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Real;

/// A number that can stand in a lane of [`Lanes`]: `f64` or `f32`. Its elementary functions have ways without branches.
pub trait Lane: Real {
    /// Not a number.
    #[doc(hidden)]
    const NAN: Self;

    /// Whether [`Self::small_sin_cos`] is sine and cosine of this angle.
    #[doc(hidden)]
    fn is_small_angle(self) -> bool;

    /// Sine and cosine of a small angle in rad, without branches.
    #[doc(hidden)]
    fn small_sin_cos(self) -> (Self, Self);

    /// Whether [`Self::moderate_sin_cos`] is sine and cosine of this angle; it has the bits of [`Self::small_sin_cos`] where
    /// both are.
    #[doc(hidden)]
    fn is_moderate_angle(self) -> bool;

    /// Sine and cosine of a moderate angle in rad, without branches.
    #[doc(hidden)]
    fn moderate_sin_cos(self) -> (Self, Self);

    /// Whether [`Self::moderate_exp`] is the exponential of this number.
    #[doc(hidden)]
    fn is_moderate_exponent(self) -> bool;

    /// e to a moderate power, without branches.
    #[doc(hidden)]
    fn moderate_exp(self) -> Self;

    /// Tangent of a moderate angle in rad, without branches.
    #[doc(hidden)]
    fn moderate_tan(self) -> Self;
}

/// `N` numbers that are computed side by side: a scalar of the generated code with a member of an ensemble in each lane.
///
/// Each lane has the bits that its member has when it is computed alone. Operations are loops over the lanes without
/// branches, which the compiler turns into vector instructions of the target that the code is compiled for; everything
/// is always inlined, so that this is the target of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const N: usize>(pub [T; N]);

impl<T: Copy, const N: usize> Lanes<T, N> {
    /// The same number in every lane.
    #[inline(always)]
    pub const fn splat(value: T) -> Self {
        Self([value; N])
    }

    /// Lane `lane` is `value(lane)`; there is at least one.
    #[inline(always)]
    pub fn from_fn(mut value: impl FnMut(usize) -> T) -> Self {
        // Not `array::from_fn`, which is not always inlined.
        let mut lanes = [value(0); N];
        for (lane, place) in lanes.iter_mut().enumerate().skip(1) {
            *place = value(lane);
        }
        Self(lanes)
    }

    /// Applies `f` to every lane.
    #[inline(always)]
    pub fn map<U: Copy>(self, f: impl Fn(T) -> U) -> Lanes<U, N> {
        Lanes::from_fn(|lane| f(self.0[lane]))
    }

    /// Whether `test` holds in every lane.
    #[inline(always)]
    pub fn all(self, test: impl Fn(T) -> bool) -> bool {
        self.0.iter().fold(true, |all, &lane| all & test(lane))
    }

    /// Applies `f` to the lanes of two vectors.
    #[inline(always)]
    pub fn zip_with<U: Copy, V: Copy>(
        self,
        other: Lanes<U, N>,
        f: impl Fn(T, U) -> V,
    ) -> Lanes<V, N> {
        Lanes::from_fn(|lane| f(self.0[lane], other.0[lane]))
    }
}

macro_rules! operator {
    ($($name:ident, $method:ident;)+) => {$(
        impl<T: Copy + $name<Output = T>, const N: usize> $name for Lanes<T, N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip_with(other, T::$method)
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

impl<T: Copy + Neg<Output = T>, const N: usize> Neg for Lanes<T, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(T::neg)
    }
}

impl<T: Lane, const N: usize> Real for Lanes<T, N> {
    const ZERO: Self = Self::splat(T::ZERO);
    const ONE: Self = Self::splat(T::ONE);
    const TWO: Self = Self::splat(T::TWO);
    const HALF: Self = Self::splat(T::HALF);

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::splat(T::from_f64(value))
    }

    fn to_f64(self) -> f64 {
        let shown = self.0.into_iter().find(|lane| !lane.is_finite());
        shown.unwrap_or(self.0[0]).to_f64()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if self.all(T::is_small_angle) {
            (
                self.map(|x| x.small_sin_cos().0),
                self.map(|x| x.small_sin_cos().1),
            )
        } else {
            reduced_sin_cos(self)
        }
    }

    #[inline(always)]
    fn exp(self) -> Self {
        if self.all(T::is_moderate_exponent) {
            self.map(T::moderate_exp)
        } else {
            exp_of_each(self)
        }
    }

    #[inline(always)]
    fn tan(self) -> Self {
        if self.all(T::is_moderate_angle) {
            self.map(T::moderate_tan)
        } else {
            tan_of_each(self)
        }
    }

    #[inline(always)]
    fn asin(self) -> Self {
        self.map(Real::asin)
    }

    #[inline(always)]
    fn atan(self) -> Self {
        self.map(Real::atan)
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        self.map(Real::tanh)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.map(Real::ln)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        self.zip_with(x, Real::atan2)
    }

    #[inline(always)]
    fn powr(self, exponent: Self) -> Self {
        self.zip_with(exponent, Real::powr)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(Real::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.map(Real::abs)
    }

    #[inline(always)]
    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
        Self::from_fn(|lane| self.0[lane].select(bound.0[lane], below.0[lane], otherwise.0[lane]))
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.all(T::is_finite)
    }
}

/// Some angle is not small.
#[cold]
#[inline(never)]
fn reduced_sin_cos<T: Lane, const N: usize>(x: Lanes<T, N>) -> (Lanes<T, N>, Lanes<T, N>) {
    if x.all(T::is_moderate_angle) {
        let both = |x: T| x.moderate_sin_cos();
        (x.map(|x| both(x).0), x.map(|x| both(x).1))
    } else {
        (x.map(Real::sin), x.map(Real::cos))
    }
}

/// Some result is not a normal number.
#[cold]
#[inline(never)]
fn exp_of_each<T: Lane, const N: usize>(x: Lanes<T, N>) -> Lanes<T, N> {
    x.map(Real::exp)
}

/// Some angle is beyond the reduction without branches.
#[cold]
#[inline(never)]
fn tan_of_each<T: Lane, const N: usize>(x: Lanes<T, N>) -> Lanes<T, N> {
    x.map(Real::tan)
}
