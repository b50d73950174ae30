//! Exact derivatives of generated functions, by numbers that carry a slope.

use std::ops::{Add, Div, Mul, Neg, Sub};

use ahv_core::{GeneratedModel, Real, Vector};

/// A number with its derivative by one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Dual {
    /// A constant.
    pub const fn constant(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }

    /// A function of this number, from its value and its derivative.
    const fn through(self, value: f64, derivative: f64) -> Self {
        Self {
            value,
            slope: derivative * self.slope,
        }
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl Div for Dual {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl Real for Dual {
    const ZERO: Self = Self::constant(0.0);
    const ONE: Self = Self::constant(1.0);
    const TWO: Self = Self::constant(2.0);
    const HALF: Self = Self::constant(0.5);

    fn from_f64(value: f64) -> Self {
        Self::constant(value)
    }

    fn to_f64(self) -> f64 {
        self.value
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.value);
        (self.through(sin, cos), self.through(cos, -sin))
    }

    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.through(value, value)
    }

    fn tan(self) -> Self {
        let value = Real::tan(self.value);
        self.through(value, 1.0 + value * value)
    }

    fn asin(self) -> Self {
        let x = self.value;
        self.through(Real::asin(x), 1.0 / Real::sqrt((1.0 - x) * (1.0 + x)))
    }

    fn atan(self) -> Self {
        let x = self.value;
        self.through(Real::atan(x), 1.0 / (1.0 + x * x))
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self {
            value: Real::atan2(self.value, x.value),
            slope: (x.value * self.slope - self.value * x.slope) / square,
        }
    }

    fn tanh(self) -> Self {
        let value = Real::tanh(self.value);
        self.through(value, 1.0 - value * value)
    }

    fn ln(self) -> Self {
        self.through(Real::ln(self.value), 1.0 / self.value)
    }

    fn powr(self, exponent: Self) -> Self {
        let (x, y) = (self.value, exponent.value);
        let value = Real::powr(x, y);
        // A constant exponent has no slope, whatever the logarithm of the base.
        let of_exponent = if exponent.slope == 0.0 {
            0.0
        } else {
            value * Real::ln(x) * exponent.slope
        };
        Self {
            value,
            slope: y * Real::powr(x, y - 1.0) * self.slope + of_exponent,
        }
    }

    fn sqrt(self) -> Self {
        let value = Real::sqrt(self.value);
        self.through(value, 0.5 / value)
    }

    fn abs(self) -> Self {
        let slope = if self.value == 0.0 {
            0.0
        } else {
            self.value.signum()
        };
        self.through(self.value.abs(), slope)
    }

    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
        let choose = |a, b| Real::select(self.value, bound.value, a, b);
        Self {
            value: choose(below.value, otherwise.value),
            slope: choose(below.slope, otherwise.slope),
        }
    }

    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
}

/// The derivatives of the outputs of `model` at (x, u) by each state, then by each input: a vector over the outputs each.
pub fn output_slopes<M: GeneratedModel>(
    model: &M,
    x: &M::State,
    u: &M::Input,
) -> Vec<M::OutputsOf<f64>> {
    let model = model.with_scalar::<Dual>();
    let states = <M::State as Vector<f64>>::LEN;
    let slopes = (0..states + <M::Input as Vector<f64>>::LEN).map(|variable| {
        let mut x = M::map_state(x, |&it| Dual::constant(it));
        let mut u = M::map_input(u, |&it| Dual::constant(it));
        let seeded = |it: Dual| Dual { slope: 1.0, ..it };
        match variable.checked_sub(states) {
            None => x
                .get(variable)
                .map(seeded)
                .and_then(|it| x.set(variable, it)),
            Some(input) => u.get(input).map(seeded).and_then(|it| u.set(input, it)),
        };
        let outputs = M::outputs(&model, &x, &u);
        M::OutputsOf::<f64>::from_fn(|index| outputs.get(index).map_or(0.0, |it| it.slope))
    });
    slopes.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two functions of time at one time: values and rates of which none is 0 or 1.
    const F: Dual = Dual {
        value: 0.7,
        slope: 3.0,
    };
    const G: Dual = Dual {
        value: -1.3,
        slope: 0.4,
    };

    fn near(found: Dual, value: f64, slope: f64) {
        let errors = [found.value - value, found.slope - slope];
        let small = errors.iter().all(|error| error.abs() < 1e-14);
        assert!(small, "{found:?}: {value}, {slope}");
    }

    /// The rules for sum, difference, product and quotient, written out in decimals.
    #[test]
    fn arithmetic_has_the_slopes_of_the_rules() {
        near(F + G, -0.6, 3.4);
        near(F - G, 2.0, 2.6);
        near(F * G, -0.91, -3.9 + 0.28);
        near(F / G, -7.0 / 13.0, (-3.9 - 0.28) / 1.69);
        near(-F, -0.7, -3.0);
        near(F.recip(), 10.0 / 7.0, -3.0 / 0.49);
    }

    /// The chain rule with the derivatives that every table has.
    #[test]
    fn functions_have_the_slopes_of_the_chain_rule() {
        let (sin, cos) = 0.7_f64.sin_cos();
        near(Real::sin(F), sin, 3.0 * cos);
        near(Real::cos(F), cos, -3.0 * sin);
        near(Real::exp(F), 0.7_f64.exp(), 3.0 * 0.7_f64.exp());
        near(Real::sqrt(F), 0.7_f64.sqrt(), 1.5 / 0.7_f64.sqrt());
        near(Real::abs(F), 0.7, 3.0);
        near(Real::abs(G), 1.3, -0.4);
        near(Real::tan(F), 0.7_f64.tan(), 3.0 / (cos * cos));
        near(Real::asin(F), 0.7_f64.asin(), 3.0 / 0.51_f64.sqrt());
        near(Real::atan(F), 0.7_f64.atan(), 3.0 / 1.49);
        near(
            Real::tanh(G),
            (-1.3_f64).tanh(),
            0.4 / 1.3_f64.cosh().powi(2),
        );
        near(Real::ln(F), 0.7_f64.ln(), 3.0 / 0.7);
        let of_angle = (-1.3 * 3.0 - 0.7 * 0.4) / (0.49 + 1.69);
        near(Real::atan2(F, G), 0.7_f64.atan2(-1.3), of_angle);
        let power = 0.7_f64.powf(-1.3);
        let of_power = power * (-1.3 / 0.7 * 3.0 + 0.7_f64.ln() * 0.4);
        near(Real::powr(F, G), power, of_power);
    }

    /// The slope of what is chosen; of a minimum and a maximum, that of the one that it is.
    #[test]
    fn choices_have_the_slope_of_what_they_choose() {
        assert_eq!(Real::select(G, F, F, G), F);
        assert_eq!(Real::select(F, G, F, G), G);
        assert_eq!((Real::min(F, G), Real::max(F, G)), (G, F));
        assert_eq!(
            Real::abs(Dual {
                slope: 3.0,
                ..Dual::ZERO
            })
            .slope,
            0.0
        );
    }
}
