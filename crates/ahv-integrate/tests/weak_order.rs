//! Weak orders on equations that are not linear; those on a linear one are in the table of `orders`.
#![forbid(unsafe_code)]

mod common;
#[path = "common/order.rs"]
mod order;
#[allow(dead_code, reason = "another test measures the orders")]
#[path = "common/weak.rs"]
mod weak;

use ahv_core::{Model, NoiseClass, StochasticModel, Vector};
use ahv_integrate::{ItoDri1, WeakIncrements};
use approx::assert_relative_eq;
use order::observed_order;
use weak::{NO_INPUT, Nothing, One, Pair, Three, outcomes};

/// dX = (X/2 + √(X² + 1)) dt + √(X² + 1) dW, X = sinh(t + W) from 0.
struct Sinh;

impl Model for Sinh {
    type Scalar = f64;
    type State = One<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &One<f64>, _: &Nothing<f64>) -> One<f64> {
        x.map(|x| 0.5 * x + (x * x + 1.0).sqrt())
    }
}

impl StochasticModel for Sinh {
    type Noise = One<f64>;

    fn noise_increment(&self, x: &One<f64>, _: &Nothing<f64>, dw: &One<f64>) -> One<f64> {
        One {
            w: (x.w * x.w + 1.0).sqrt() * dw.w,
        }
    }
}

/// E f over all outcomes of `steps` steps.
fn expectation<M>(model: &M, x: M::State, dt: f64, steps: u32, f: &dyn Fn(&M::State) -> f64) -> f64
where
    M: Model<Scalar = f64, Input = Nothing<f64>> + StochasticModel,
{
    fn go<M: Model<Scalar = f64, Input = Nothing<f64>> + StochasticModel>(
        (model, dt): (&M, f64),
        all: &[(f64, WeakIncrements<M::Noise>)],
        x: M::State,
        steps: u32,
        f: &dyn Fn(&M::State) -> f64,
    ) -> f64 {
        if steps == 0 {
            return f(&x);
        }
        all.iter()
            .map(|(probability, increments)| {
                let mut next = x;
                ItoDri1::new(dt)
                    .step(model, &mut next, &NO_INPUT, increments)
                    .expect("the model stays finite");
                probability * go((model, dt), all, next, steps - 1, f)
            })
            .sum()
    }
    go((model, dt), &outcomes(dt), x, steps, f)
}

/// E sinh²(t + W) = (exp(2t) cosh(2t) − 1)/2.
#[test]
fn dri1_has_weak_order_two_on_a_nonlinear_equation() {
    let f = |x: &One<f64>| x.w * x.w;
    let t: f64 = 0.5;
    let truth = 0.5 * ((2.0 * t).exp() * (2.0 * t).cosh() - 1.0);
    let points = [4, 5, 6, 7, 8, 9, 10].map(|steps| {
        let dt = t / f64::from(steps);
        let value = expectation(&Sinh, One { w: 0.0 }, dt, steps, &f);
        (dt, (value - truth).abs())
    });
    let order = observed_order(&points);
    println!("order {order:.3}, errors {points:?}");
    assert!((order - 2.0).abs() < 0.3, "observed weak order {order}");
}

/// Two states and three channels: two columns general, one constant if `CONSTANT`, else not declared so.
struct Roots<const CONSTANT: bool>;

impl<const CONSTANT: bool> Model for Roots<CONSTANT> {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        Pair {
            a: 0.7 * x.a - 0.4 * x.b,
            b: 0.5 * x.a + 0.3 * x.b,
        }
    }
}

impl<const CONSTANT: bool> StochasticModel for Roots<CONSTANT> {
    type Noise = Three<f64>;

    fn noise_increment(&self, x: &Pair<f64>, _: &Nothing<f64>, dw: &Three<f64>) -> Pair<f64> {
        Pair {
            a: (0.5 + x.b * x.b).sqrt() * dw.w_1 + 0.3 * dw.w_2,
            b: 0.1 * dw.w_2 + (0.2 + 0.5 * x.a * x.a).sqrt() * dw.w_3,
        }
    }

    fn noise_class(channel: usize) -> NoiseClass {
        if CONSTANT && channel == 1 {
            NoiseClass::Constant
        } else {
            NoiseClass::General
        }
    }
}

/// Second moments of [`Roots`] obey a linear equation, whose Taylor series gives the truth for one step.
fn roots_moments(start: Pair<f64>, h: f64) -> [f64; 3] {
    let rate = |[aa, ab, bb]: [f64; 3], one: f64| {
        [
            2.0 * (0.7 * aa - 0.4 * ab) + one * (0.5 + 0.09) + bb,
            0.7 * ab - 0.4 * bb + 0.5 * aa + 0.3 * ab + one * 0.03,
            2.0 * (0.5 * ab + 0.3 * bb) + one * (0.01 + 0.2) + 0.5 * aa,
        ]
    };
    let mut total = [start.a * start.a, start.a * start.b, start.b * start.b];
    let (mut term, mut one) = (total, 1.0);
    for n in 1..20 {
        term = rate(term, one).map(|v| v * h / f64::from(n));
        one = 0.0;
        total = std::array::from_fn(|i| total[i] + term[i]);
    }
    total
}

#[test]
fn dri1_errs_by_the_third_power_in_a_step_on_general_noise() {
    let start = Pair { a: 0.9, b: -0.6 };
    let tests: [fn(&Pair<f64>) -> f64; 3] = [|x| x.a * x.a, |x| x.a * x.b, |x| x.b * x.b];
    for (index, f) in tests.iter().enumerate() {
        let points = [0.2, 0.1, 0.05, 0.025, 0.0125].map(|h| {
            let value = expectation(&Roots::<true>, start, h, 1, f);
            (h, (value - roots_moments(start, h)[index]).abs())
        });
        let order = observed_order(&points);
        println!("local order {order:.3}, errors {points:?}");
        assert!(order > 2.8, "observed local weak order {order}");
    }
}

#[test]
fn a_column_that_is_known_to_be_constant_changes_nothing_but_the_cost() {
    let mut general = Pair { a: 0.9, b: -0.6 };
    let mut constant = general;
    for (_, increments) in outcomes(0.01) {
        let stepper = ItoDri1::new(0.01);
        let steps = [
            stepper.step(&Roots::<false>, &mut general, &NO_INPUT, &increments),
            stepper.step(&Roots::<true>, &mut constant, &NO_INPUT, &increments),
        ];
        assert_eq!(steps, [Ok(()); 2]);
        assert_relative_eq!(general.a, constant.a, max_relative = 1e-13);
        assert_relative_eq!(general.b, constant.b, max_relative = 1e-13);
    }
}
