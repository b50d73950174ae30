//! Runge–Kutta against closed forms.
#![forbid(unsafe_code)]

mod common;
#[path = "common/order.rs"]
mod order;

use ahv_core::Model;
use ahv_integrate::{Rk4, StepError};
use approx::assert_relative_eq;
use common::vector;
use order::observed_order;

vector!(State, growth, position);
vector!(Input, rate);

/// Logistic growth, x' = r x (1 − x), and its integral: ln(1 − x₀ + x₀ e^{rt}) / r.
struct Logistic;

impl Model for Logistic {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Input<f64>;

    fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
        State {
            growth: u.rate * x.growth * (1.0 - x.growth),
            position: x.growth,
        }
    }
}

const RATE: Input<f64> = Input { rate: 2.0 };
const START: State<f64> = State {
    growth: 0.1,
    position: 0.0,
};

fn exact(t: f64) -> State<f64> {
    let grown = START.growth * (RATE.rate * t).exp();
    let sum = 1.0 - START.growth + grown;
    State {
        growth: grown / sum,
        position: sum.ln() / RATE.rate,
    }
}

fn integrate(t_end: f64, steps: u32) -> State<f64> {
    let stepper = Rk4::new(t_end / f64::from(steps));
    let mut x = START;
    for _ in 0..steps {
        stepper
            .step(&Logistic, &mut x, &RATE)
            .expect("the logistic equation stays finite");
    }
    x
}

#[test]
fn the_order_is_four() {
    let t_end = 3.0;
    let errors = |pick: fn(State<f64>) -> f64| {
        [16, 32, 64, 128, 256, 512].map(|steps| {
            let error = (pick(integrate(t_end, steps)) - pick(exact(t_end))).abs();
            (t_end / f64::from(steps), error)
        })
    };
    for pick in [|x: State<f64>| x.growth, |x: State<f64>| x.position] {
        let order = observed_order(&errors(pick));
        assert!((order - 4.0).abs() < 0.1, "observed order {order}");
    }
}

#[test]
fn small_steps_meet_the_closed_form() {
    let (x, expected) = (integrate(3.0, 3000), exact(3.0));
    assert_relative_eq!(x.growth, expected.growth, max_relative = 1e-12);
    assert_relative_eq!(x.position, expected.position, max_relative = 1e-12);
}

#[test]
fn a_non_finite_result_is_named_and_the_last_good_state_kept() {
    let huge = State {
        growth: -1e200,
        position: 0.0,
    };
    let mut x = huge;
    match Rk4::new(1.0).step(&Logistic, &mut x, &RATE) {
        Err(StepError::NonFinite {
            name: "growth",
            value,
        }) => assert!(!value.is_finite()),
        other => panic!("expected a non-finite growth, got {other:?}"),
    }
    assert_eq!(x, huge);
}

#[test]
fn a_step_size_must_be_positive_and_finite() {
    for dt in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let mut x = START;
        let error = Rk4::new(dt)
            .step(&Logistic, &mut x, &RATE)
            .expect_err("no such step");
        assert!(matches!(error, StepError::StepSize { .. }));
        assert!(error.to_string().contains("must be positive"), "{error}");
        assert_eq!(x, START);
    }
}
