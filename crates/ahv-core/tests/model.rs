//! What a model says of its noise without an implementation of its own, and what [`NoInline`] hands on.
#![forbid(unsafe_code)]

use ahv_core::{
    ColouredNoise, DifferentiableModel, DifferentiableNoise, ItoCorrected, Model, NoInline,
    NoiseClass, Pattern, StochasticModel,
};

#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair<T> {
    x: T,
    y: T,
}

ahv_core::impl_vector!(Pair {
    x: ["1", "1", 1.0],
    y: ["1", "1", 1.0]
});

const X: Pair<f64> = Pair { x: 2.0, y: 3.0 };
const U: Pair<f64> = Pair { x: 5.0, y: 7.0 };
const DW: Pair<f64> = Pair { x: 11.0, y: 13.0 };

/// ẋ = x·u₁, ẏ = −4 y; G = [x, 0; 0, 6].
#[derive(Clone, Copy)]
struct Silent;

impl Model for Silent {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Pair<f64>;

    fn drift(&self, x: &Pair<f64>, u: &Pair<f64>) -> Pair<f64> {
        Pair {
            x: x.x * u.x,
            y: -4.0 * x.y,
        }
    }
}

impl StochasticModel for Silent {
    type Noise = Pair<f64>;

    fn noise_increment(&self, x: &Pair<f64>, _: &Pair<f64>, dw: &Pair<f64>) -> Pair<f64> {
        Pair {
            x: x.x * dw.x,
            y: 6.0 * dw.y,
        }
    }
}

/// The same, and it says what it knows.
#[derive(Clone, Copy)]
struct Known;

impl Model for Known {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Pair<f64>;

    fn drift(&self, x: &Pair<f64>, u: &Pair<f64>) -> Pair<f64> {
        Silent.drift(x, u)
    }
}

impl DifferentiableModel for Known {
    type StateJacobian = Pair<Pair<f64>>;
    type InputJacobian = Pair<Pair<f64>>;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([2, 2], &[[0, 0], [1, 1]]);

    fn jacobians(&self, x: &Pair<f64>, u: &Pair<f64>) -> (Pair<Pair<f64>>, Pair<Pair<f64>>) {
        let rows = |first: [f64; 2], second: [f64; 2]| Pair {
            x: Pair::from(first),
            y: Pair::from(second),
        };
        (rows([u.x, 0.0], [0.0, -4.0]), rows([x.x, 0.0], [0.0, 0.0]))
    }
}

impl StochasticModel for Known {
    type Noise = Pair<f64>;

    fn noise_increment(&self, x: &Pair<f64>, u: &Pair<f64>, dw: &Pair<f64>) -> Pair<f64> {
        Silent.noise_increment(x, u, dw)
    }

    fn noise_class(channel: usize) -> NoiseClass {
        match channel {
            0 => NoiseClass::Diagonal,
            _ => NoiseClass::Constant,
        }
    }

    fn noise_commutes(first: usize, second: usize) -> bool {
        first.max(second) < 2
    }
}

impl ItoCorrected for Known {
    fn ito_correction(&self, x: &Pair<f64>, _: &Pair<f64>) -> Pair<f64> {
        Pair {
            x: 0.5 * x.x,
            y: 0.0,
        }
    }
}

impl DifferentiableNoise for Known {
    fn iterated_increment(
        &self,
        x: &Pair<f64>,
        _: &Pair<f64>,
        mut integral: impl FnMut(usize, usize) -> f64,
    ) -> Pair<f64> {
        Pair {
            x: x.x * integral(0, 0),
            y: 0.0,
        }
    }
}

impl ColouredNoise for Known {
    fn decay(&self, state: usize) -> Option<f64> {
        (state == 1).then_some(4.0)
    }
}

/// A scheme for additive or commutative noise must not take a model that makes no promise.
#[test]
fn a_model_that_says_nothing_promises_nothing() {
    for channel in 0..2 {
        assert_eq!(Silent::noise_class(channel), NoiseClass::General);
        // A column commutes with itself.
        assert!(Silent::noise_commutes(channel, channel));
        assert!(!Silent::noise_commutes(channel, 1 - channel));
    }
    let both = Silent.drift_and_noise_increment(&X, &U, &DW);
    assert_eq!(both.0.to_array(), [10.0, -12.0]);
    assert_eq!(both.1.to_array(), [22.0, 78.0]);
}

#[test]
fn an_outlined_model_is_the_model() {
    let outlined = NoInline(Known);
    assert_eq!(outlined.drift(&X, &U), Known.drift(&X, &U));
    assert_eq!(outlined.jacobians(&X, &U), Known.jacobians(&X, &U));
    assert_eq!(
        outlined.drift_and_jacobians(&X, &U),
        Known.drift_and_jacobians(&X, &U)
    );
    assert_eq!(
        outlined.noise_increment(&X, &U, &DW),
        Known.noise_increment(&X, &U, &DW)
    );
    assert_eq!(
        outlined.drift_and_noise_increment(&X, &U, &DW),
        Known.drift_and_noise_increment(&X, &U, &DW)
    );
    assert_eq!(
        outlined.ito_correction(&X, &U),
        Known.ito_correction(&X, &U)
    );
    let integral = |j, k| if j == k { 0.25 } else { 0.0 };
    assert_eq!(
        outlined.iterated_increment(&X, &U, integral),
        Known.iterated_increment(&X, &U, integral)
    );
    for (first, second) in [(0, 0), (0, 1), (1, 2), (2, 1)] {
        assert_eq!(
            NoInline::<Known>::noise_commutes(first, second),
            Known::noise_commutes(first, second)
        );
    }
    for index in 0..2 {
        assert_eq!(
            NoInline::<Known>::noise_class(index),
            Known::noise_class(index)
        );
        assert_eq!(outlined.decay(index), Known.decay(index));
    }
    assert_eq!(
        <NoInline<Known> as DifferentiableModel>::STATE_JACOBIAN_PATTERN,
        Known::STATE_JACOBIAN_PATTERN
    );
}
