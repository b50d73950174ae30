//! Weak orders without Monte Carlo: every outcome of the increments of few values is visited.
#![forbid(unsafe_code)]

mod common;
#[path = "common/order.rs"]
mod order;

use ahv_core::{Model, NoiseClass, StochasticModel, Vector};
use ahv_integrate::{EulerMaruyama, ItoDri1, StepError, StratonovichHeun, WeakIncrements};
use approx::assert_relative_eq;
use common::vector;
use order::observed_order;

vector!(Pair, a, b);
vector!(Three, w_1, w_2, w_3);
vector!(One, w);
vector!(Nothing, held);

const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };
type Matrix = [[f64; 2]; 2];

/// Probability and increments of every outcome of a step.
fn outcomes<W: Vector<f64>>(dt: f64) -> Vec<(f64, WeakIncrements<W>)> {
    // A single channel uses no two-point number.
    let signs = if W::LEN == 1 { 0 } else { W::LEN };
    let mut all = Vec::new();
    for code in 0..3_usize.pow(W::LEN as u32) << signs {
        let digit = |channel: usize| (code >> signs) / 3_usize.pow(channel as u32) % 3;
        let three = |channel: usize| digit(channel) as f64 - 1.0;
        let two = |channel: usize| if code >> channel & 1 == 0 { -1.0 } else { 1.0 };
        let probability: f64 = (0..W::LEN)
            .map(|channel| {
                if digit(channel) == 1 {
                    2.0 / 3.0
                } else {
                    1.0 / 6.0
                }
            })
            .product();
        let increments = WeakIncrements::from_signs(dt, three, two);
        all.push((probability / (1_usize << signs) as f64, increments));
    }
    all
}

fn apply(m: &Matrix, x: &Pair<f64>) -> Pair<f64> {
    Pair {
        a: m[0][0] * x.a + m[0][1] * x.b,
        b: m[1][0] * x.a + m[1][1] * x.b,
    }
}

/// dx = A x dt + Σ Bₖ x dWₖ, no two of whose matrices commute.
struct Linear {
    drift: Matrix,
    columns: [Matrix; 3],
}

const LINEAR: Linear = Linear {
    drift: [[-0.5, 0.8], [-0.3, 0.2]],
    columns: [
        [[0.3, 0.5], [0.0, -0.2]],
        [[0.1, 0.0], [0.6, 0.2]],
        [[0.0, -0.4], [0.3, 0.1]],
    ],
};

impl Model for Linear {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        apply(&self.drift, x)
    }
}

impl StochasticModel for Linear {
    type Noise = Three<f64>;

    fn noise_increment(&self, x: &Pair<f64>, _: &Nothing<f64>, dw: &Three<f64>) -> Pair<f64> {
        self.columns
            .iter()
            .zip(dw.to_array())
            .fold(Pair::splat(0.0), |sum, (m, dw)| {
                sum.zip_with(apply(m, x), |sum, g| sum + g * dw)
            })
    }
}

/// d/dt of E[x xᵀ] as the vector (E a², E ab, E b²).
fn second_moments_rate(model: &Linear, s: [f64; 3]) -> [f64; 3] {
    let p = [[s[0], s[1]], [s[1], s[2]]];
    let product = |m: &Matrix, n: &Matrix| -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..2).map(|k| m[i][k] * n[k][j]).sum()))
    };
    let transposed = |m: &Matrix| [[m[0][0], m[1][0]], [m[0][1], m[1][1]]];
    let left = product(&model.drift, &p);
    let mut rate = [2.0 * left[0][0], left[0][1] + left[1][0], 2.0 * left[1][1]];
    for column in &model.columns {
        let square = product(&product(column, &p), &transposed(column));
        rate[0] += square[0][0];
        rate[1] += square[0][1];
        rate[2] += square[1][1];
    }
    rate
}

fn exact_second_moments(model: &Linear, start: [f64; 3]) -> [f64; 3] {
    let steps = 2000;
    let h = 1.0 / f64::from(steps);
    let ahead = |s: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
    let mut s = start;
    for _ in 0..steps {
        let k1 = second_moments_rate(model, s);
        let k2 = second_moments_rate(model, ahead(s, k1, 0.5 * h));
        let k3 = second_moments_rate(model, ahead(s, k2, 0.5 * h));
        let k4 = second_moments_rate(model, ahead(s, k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    s
}

type Step =
    fn(f64, &Linear, &mut Pair<f64>, &WeakIncrements<Three<f64>>) -> Result<(), StepError<f64>>;

/// E a², E ab, E b² after one time unit in `steps` steps. On a linear model a step is a random matrix, and the
/// moments take a step by the mean of its Kronecker square.
fn second_moments(step: Step, model: &Linear, start: [f64; 3], steps: u32) -> [f64; 3] {
    let dt = 1.0 / f64::from(steps);
    let mut map = [[0.0; 3]; 3];
    for (probability, increments) in outcomes(dt) {
        let column = |start: Pair<f64>| {
            let mut x = start;
            step(dt, model, &mut x, &increments).expect("a linear step is finite");
            x
        };
        let (p, q) = (
            column(Pair { a: 1.0, b: 0.0 }),
            column(Pair { a: 0.0, b: 1.0 }),
        );
        let kronecker = [
            [p.a * p.a, 2.0 * p.a * q.a, q.a * q.a],
            [p.a * p.b, p.a * q.b + q.a * p.b, q.a * q.b],
            [p.b * p.b, 2.0 * p.b * q.b, q.b * q.b],
        ];
        for (row, own) in map.iter_mut().zip(kronecker) {
            for (entry, own) in row.iter_mut().zip(own) {
                *entry += probability * own;
            }
        }
    }
    (0..steps).fold(start, |s, _| {
        map.map(|row| (0..3).map(|k| row[k] * s[k]).sum())
    })
}

fn weak_order(step: Step, model: &Linear, exact: &Linear) -> f64 {
    let start = [1.0, 0.5, 0.25];
    let truth = exact_second_moments(exact, start);
    let points = [8, 16, 32, 64, 128, 256].map(|steps| {
        let s = second_moments(step, model, start, steps);
        let error: f64 = (0..3).map(|i| (s[i] - truth[i]).powi(2)).sum();
        (1.0 / f64::from(steps), error.sqrt())
    });
    let order = observed_order(&points);
    println!("order {order:.3}, errors {points:?}");
    order
}

#[test]
fn dri1_has_weak_order_two_on_noise_that_does_not_commute() {
    let step: Step = |dt, model, x, dw| ItoDri1::new(dt).step(model, x, &NO_INPUT, dw);
    let order = weak_order(step, &LINEAR, &LINEAR);
    assert!((order - 2.0).abs() < 0.1, "observed weak order {order}");
}

/// Three values a channel have the moments of a normal number up to the fifth: enough for a step that is quadratic in dW.
#[test]
fn euler_maruyama_in_the_ito_sense_has_weak_order_one() {
    let step: Step =
        |dt, model, x, dw| EulerMaruyama::new(dt).step(model, x, &NO_INPUT, &dw.three_point);
    let order = weak_order(step, &LINEAR, &LINEAR);
    assert!((order - 1.0).abs() < 0.1, "observed weak order {order}");
}

#[test]
fn heun_in_the_stratonovich_sense_has_weak_order_one() {
    let step: Step =
        |dt, model, x, dw| StratonovichHeun::new(dt).step(model, x, &NO_INPUT, &dw.three_point);
    let mut ito = LINEAR;
    for column in &LINEAR.columns {
        for i in 0..2 {
            for j in 0..2 {
                let square: f64 = (0..2).map(|k| column[i][k] * column[k][j]).sum();
                ito.drift[i][j] += 0.5 * square;
            }
        }
    }
    let order = weak_order(step, &LINEAR, &ito);
    assert!((order - 1.0).abs() < 0.1, "observed weak order {order}");
}

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
