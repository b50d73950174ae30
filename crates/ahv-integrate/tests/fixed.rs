//! The methods with a fixed step against closed forms.
#![forbid(unsafe_code)]

mod common;
#[path = "common/order.rs"]
mod order;

use ahv_core::Model;
use ahv_integrate::{DormandPrince54, DormandPrince853, Euler, Fixed, Heun, Rk4, StepError, Tsit5};
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

type Outcome = Result<(), StepError<f64>>;

fn integrate(t_end: f64, steps: u32, step: impl Fn(f64, &mut State<f64>) -> Outcome) -> State<f64> {
    let mut x = START;
    for _ in 0..steps {
        step(t_end / f64::from(steps), &mut x).expect("the logistic equation stays finite");
    }
    x
}

fn rk4(dt: f64, x: &mut State<f64>) -> Outcome {
    Rk4::new(dt).step(&Logistic, x, &RATE)
}

fn assert_order(order: f64, steps: [u32; 6], step: impl Fn(f64, &mut State<f64>) -> Outcome) {
    let t_end = 3.0;
    for pick in [|x: State<f64>| x.growth, |x: State<f64>| x.position] {
        let errors = steps.map(|steps| {
            let error = (pick(integrate(t_end, steps, &step)) - pick(exact(t_end))).abs();
            (t_end / f64::from(steps), error)
        });
        let observed = observed_order(&errors);
        assert!(
            (observed - order).abs() < 0.05 * order,
            "observed order {observed}, not {order}"
        );
    }
}

#[test]
fn the_orders_are_those_of_the_methods() {
    assert_order(1.0, [256, 512, 1024, 2048, 4096, 8192], |dt, x| {
        Euler::new(dt).step(&Logistic, x, &RATE)
    });
    assert_order(2.0, [64, 128, 256, 512, 1024, 2048], |dt, x| {
        Heun::new(dt).step(&Logistic, x, &RATE)
    });
    assert_order(4.0, [16, 32, 64, 128, 256, 512], rk4);
    assert_order(5.0, [64, 96, 128, 192, 256, 384], |dt, x| {
        Fixed::new(DormandPrince54, dt).step(&Logistic, x, &RATE)
    });
    assert_order(5.0, [64, 96, 128, 192, 256, 384], |dt, x| {
        Fixed::new(Tsit5, dt).step(&Logistic, x, &RATE)
    });
    assert_order(8.0, [8, 10, 12, 16, 20, 24], |dt, x| {
        Fixed::new(DormandPrince853, dt).step(&Logistic, x, &RATE)
    });
}

#[test]
fn small_steps_meet_the_closed_form() {
    let (x, expected) = (integrate(3.0, 3000, rk4), exact(3.0));
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
        for result in [
            Euler::new(dt).step(&Logistic, &mut x, &RATE),
            Heun::new(dt).step(&Logistic, &mut x, &RATE),
            Fixed::new(Tsit5, dt).step(&Logistic, &mut x, &RATE),
        ] {
            assert!(matches!(result, Err(StepError::StepSize { .. })));
        }
        assert_eq!(x, START);
    }
}
