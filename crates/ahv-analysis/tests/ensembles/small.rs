//! Small models whose covariance has a closed form.

use std::marker::PhantomData;

use ahv_core::{DifferentiableModel, Model, Pattern, StochasticModel, Vector};

/// Vectors of pure numbers.
macro_rules! vectors {
    ($($name:ident: $($component:ident)+;)+) => {$(
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $name<T> {
            $(pub(crate) $component: T,)+
        }

        ahv_core::impl_vector! { $name { $($component: ["1", "1", 1.0]),+ } }
    )+};
}

vectors! {
    One: x;
    Two: x y;
    Fifteen: a b c d e f g h i j k l m n o;
    Eighteen: a b c d e f g h i j k l m n o p q r;
}

/// dx = −x² dt + σ dW.
pub(crate) struct Square(pub(crate) f64);

impl Model for Square {
    type Scalar = f64;
    type State = One<f64>;
    type Input = One<f64>;

    fn drift(&self, x: &One<f64>, _: &One<f64>) -> One<f64> {
        One { x: -x.x * x.x }
    }
}

impl DifferentiableModel for Square {
    type StateJacobian = One<One<f64>>;
    type InputJacobian = One<One<f64>>;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([1, 1], &[[0, 0]]);

    fn jacobians(&self, x: &One<f64>, _: &One<f64>) -> (One<One<f64>>, One<One<f64>>) {
        let by_state = One {
            x: One { x: -2.0 * x.x },
        };
        (by_state, One { x: One { x: 0.0 } })
    }
}

impl StochasticModel for Square {
    type Noise = One<f64>;

    fn noise_increment(&self, _: &One<f64>, _: &One<f64>, dw: &One<f64>) -> One<f64> {
        One { x: self.0 * dw.x }
    }
}

/// A linear model of two states and one input: dx₁ = (−a x₁ + c u) dt + g dW, dx₂ = x₁ dt.
pub(crate) struct Pair {
    pub(crate) a: f64,
    pub(crate) c: f64,
    pub(crate) g: f64,
}

impl Model for Pair {
    type Scalar = f64;
    type State = Two<f64>;
    type Input = One<f64>;

    fn drift(&self, x: &Two<f64>, u: &One<f64>) -> Two<f64> {
        Two {
            x: self.c * u.x - self.a * x.x,
            y: x.x,
        }
    }
}

impl DifferentiableModel for Pair {
    type StateJacobian = Two<Two<f64>>;
    type InputJacobian = Two<One<f64>>;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([2, 2], &[[0, 0], [1, 0]]);

    fn jacobians(&self, _: &Two<f64>, _: &One<f64>) -> (Two<Two<f64>>, Two<One<f64>>) {
        (
            Two {
                x: Two { x: -self.a, y: 0.0 },
                y: Two { x: 1.0, y: 0.0 },
            },
            Two {
                x: One { x: self.c },
                y: One { x: 0.0 },
            },
        )
    }
}

impl StochasticModel for Pair {
    type Noise = One<f64>;

    fn noise_increment(&self, _: &Two<f64>, _: &One<f64>, dw: &One<f64>) -> Two<f64> {
        Two {
            x: self.g * dw.x,
            y: 0.0,
        }
    }
}

/// dxᵢ = uⱼ dt, where every state has the first of the inputs.
pub(crate) struct Driven<U>(pub(crate) PhantomData<U>);

impl<U: Vector<f64>> Model for Driven<U> {
    type Scalar = f64;
    type State = Fifteen<f64>;
    type Input = U;

    fn drift(&self, _: &Fifteen<f64>, u: &U) -> Fifteen<f64> {
        Fifteen::splat(u.get(0).unwrap_or_default())
    }
}

impl<U: Vector<f64>> DifferentiableModel for Driven<U> {
    type StateJacobian = Fifteen<Fifteen<f64>>;
    type InputJacobian = Fifteen<U>;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([15, 15], &[]);

    fn jacobians(&self, _: &Fifteen<f64>, _: &U) -> (Fifteen<Fifteen<f64>>, Fifteen<U>) {
        let row = U::from_fn(|index| f64::from(u8::from(index == 0)));
        (Fifteen::splat(Fifteen::splat(0.0)), Fifteen::splat(row))
    }
}

impl<U: Vector<f64>> StochasticModel for Driven<U> {
    type Noise = One<f64>;

    fn noise_increment(&self, _: &Fifteen<f64>, _: &U, _: &One<f64>) -> Fifteen<f64> {
        Fifteen::splat(0.0)
    }
}
