//! Strong orders: coarse solutions against closed forms, or much finer ones, on the same Brownian path.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[path = "common/order.rs"]
mod order;

use ahv_core::{
    AdditiveNoise, CommutativeNoise, DifferentiableNoise, ItoCorrected, Model, NoiseClass,
    StochasticModel,
};
use ahv_integrate::{
    EulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, StepError, StratonovichHeun, WienerIntegrals,
};
use common::vector;
use normal::{Normal, refined};
use order::observed_order;

vector!(Plane, re, im);
vector!(Two, w_1, w_2);
vector!(Nothing, held);

const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };
const RATE: (f64, f64) = (-0.2, 0.1);
const SLOPES: [(f64, f64); 2] = [(0.3, 0.2), (-0.1, 0.4)];
const START: Plane<f64> = Plane { re: 1.0, im: 0.5 };
const T_END: f64 = 1.0;

fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    (a * c - b * d, a * d + b * c)
}

fn turned(factor: (f64, f64), x: &Plane<f64>) -> Plane<f64> {
    let (re, im) = times(factor, (x.re, x.im));
    Plane { re, im }
}

/// dz = r z dt + c₁ z dW₁ + c₂ z dW₂ with complex r, c: general columns that commute.
struct Spiral;

impl Model for Spiral {
    type Scalar = f64;
    type State = Plane<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Plane<f64>, _: &Nothing<f64>) -> Plane<f64> {
        turned(RATE, x)
    }
}

impl StochasticModel for Spiral {
    type Noise = Two<f64>;

    fn noise_increment(&self, x: &Plane<f64>, _: &Nothing<f64>, dw: &Two<f64>) -> Plane<f64> {
        let [a, b] = SLOPES;
        turned(
            (a.0 * dw.w_1 + b.0 * dw.w_2, a.1 * dw.w_1 + b.1 * dw.w_2),
            x,
        )
    }

    fn noise_commutes(_: usize, _: usize) -> bool {
        true
    }
}

impl ItoCorrected for Spiral {
    fn ito_correction(&self, x: &Plane<f64>, u: &Nothing<f64>) -> Plane<f64> {
        self.iterated_increment(x, u, |j, k| if j == k { 0.5 } else { 0.0 })
    }
}

impl DifferentiableNoise for Spiral {
    fn iterated_increment(
        &self,
        x: &Plane<f64>,
        _: &Nothing<f64>,
        mut integral: impl FnMut(usize, usize) -> f64,
    ) -> Plane<f64> {
        let mut factor = (0.0, 0.0);
        for (j, &inner) in SLOPES.iter().enumerate() {
            for (k, &outer) in SLOPES.iter().enumerate() {
                let (re, im) = times(outer, inner);
                let weight = integral(j, k);
                factor = (factor.0 + weight * re, factor.1 + weight * im);
            }
        }
        turned(factor, x)
    }
}

impl CommutativeNoise for Spiral {}

/// The Itô solution where `sense` is 1, Stratonovich's where it is 0.
fn exact(w: &Two<f64>, sense: f64) -> Plane<f64> {
    let [a, b] = SLOPES;
    let (squares_a, squares_b) = (times(a, a), times(b, b));
    let half = 0.5 * sense * T_END;
    let re = RATE.0 * T_END - half * (squares_a.0 + squares_b.0) + a.0 * w.w_1 + b.0 * w.w_2;
    let im = RATE.1 * T_END - half * (squares_a.1 + squares_b.1) + a.1 * w.w_1 + b.1 * w.w_2;
    turned((re.exp() * im.cos(), re.exp() * im.sin()), &START)
}

type Step = fn(f64, &mut Plane<f64>, &Two<f64>) -> Result<(), StepError<f64>>;

/// Root mean square errors of a scheme at t = 1 over the step sizes 2⁻³ to 2⁻⁸, and their slope.
fn spiral_order(step: Step, sense: f64) -> f64 {
    let levels = 3..=8;
    let mut squares = [0.0; 6];
    let mut normal = Normal(11);
    for _ in 0..500 {
        let path = refined::<Two<f64>>(&mut normal, T_END, 8);
        let end = exact(&path[0][0].dw, sense);
        for (level, square) in levels.clone().zip(&mut squares) {
            let mut x = START;
            for increments in &path[level] {
                step(dt(level), &mut x, &increments.dw).expect("the spiral stays finite");
            }
            *square += (x.re - end.re).powi(2) + (x.im - end.im).powi(2);
        }
    }
    slope(levels, &squares)
}

fn dt(level: usize) -> f64 {
    T_END / (1_u64 << level) as f64
}

fn slope(levels: impl Iterator<Item = usize>, squares: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = levels
        .zip(squares)
        .map(|(level, square)| (dt(level), square.sqrt()))
        .collect();
    let order = observed_order(&points);
    println!("order {order:.3}, errors {points:?}");
    order
}

#[test]
fn euler_maruyama_in_the_ito_sense_has_strong_order_one_half() {
    let step: Step = |dt, x, dw| EulerMaruyama::new(dt).step(&Spiral, x, &NO_INPUT, dw);
    let order = spiral_order(step, 1.0);
    assert!((order - 0.5).abs() < 0.1, "observed strong order {order}");
}

#[test]
fn heun_in_the_stratonovich_sense_has_strong_order_one() {
    let step: Step = |dt, x, dw| StratonovichHeun::new(dt).step(&Spiral, x, &NO_INPUT, dw);
    let order = spiral_order(step, 0.0);
    assert!((order - 1.0).abs() < 0.1, "observed strong order {order}");
}

#[test]
fn heun_in_the_ito_sense_has_strong_order_one() {
    let step: Step = |dt, x, dw| ItoHeun::new(dt).step(&Spiral, x, &NO_INPUT, dw);
    let order = spiral_order(step, 1.0);
    assert!((order - 1.0).abs() < 0.1, "observed strong order {order}");
}

#[test]
fn milstein_has_strong_order_one_on_commuting_columns() {
    let step: Step = |dt, x, dw| ItoMilstein::new(dt).step(&Spiral, x, &NO_INPUT, dw);
    let order = spiral_order(step, 1.0);
    assert!((order - 1.0).abs() < 0.1, "observed strong order {order}");
}

/// A nonlinear drift with additive noise in both components.
struct Curved;

impl Model for Curved {
    type Scalar = f64;
    type State = Plane<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Plane<f64>, _: &Nothing<f64>) -> Plane<f64> {
        Plane {
            re: (2.0 * x.re).cos() + x.im,
            im: -2.0 * x.im + x.re.sin(),
        }
    }
}

impl StochasticModel for Curved {
    type Noise = Two<f64>;

    fn noise_increment(&self, _: &Plane<f64>, _: &Nothing<f64>, dw: &Two<f64>) -> Plane<f64> {
        Plane {
            re: dw.w_1,
            im: 0.5 * dw.w_1 + dw.w_2,
        }
    }

    fn noise_class(_: usize) -> NoiseClass {
        NoiseClass::Constant
    }
}

impl AdditiveNoise for Curved {}

#[test]
fn sra1_has_strong_order_three_halves_on_additive_noise() {
    let (finest, levels) = (13, 4..=9);
    let run = |level: usize, steps: &[WienerIntegrals<Two<f64>>]| {
        let (stepper, mut x) = (ItoSra1::new(dt(level)), START);
        for integrals in steps {
            stepper
                .step(&Curved, &mut x, &NO_INPUT, integrals)
                .expect("the drift is bounded by the state");
        }
        x
    };
    let mut squares = [0.0; 6];
    let mut normal = Normal(5);
    for _ in 0..150 {
        let path = refined::<Two<f64>>(&mut normal, T_END, finest);
        let end = run(finest, &path[finest]);
        for (level, square) in levels.clone().zip(&mut squares) {
            let x = run(level, &path[level]);
            *square += (x.re - end.re).powi(2) + (x.im - end.im).powi(2);
        }
    }
    let order = slope(levels, &squares);
    assert!((order - 1.5).abs() < 0.12, "observed strong order {order}");
}

#[test]
fn equal_increments_give_equal_bits() {
    let path = refined::<Two<f64>>(&mut Normal(3), T_END, 6);
    let run = || {
        let mut x = START;
        for integrals in &path[6] {
            let dw = &integrals.dw;
            let steps = [
                ItoMilstein::new(0.01).step(&Spiral, &mut x, &NO_INPUT, dw),
                ItoHeun::new(0.01).step(&Spiral, &mut x, &NO_INPUT, dw),
                ItoSra1::new(0.01).step(&Curved, &mut x, &NO_INPUT, integrals),
            ];
            assert_eq!(steps, [Ok(()); 3]);
        }
        x.to_array().map(f64::to_bits)
    };
    assert_eq!(run(), run());
}

#[test]
fn bad_steps_are_errors_and_keep_the_state() {
    let dw = Two {
        w_1: 0.1,
        w_2: f64::NAN,
    };
    let mut x = START;
    for dt in [0.0, -1.0, f64::INFINITY] {
        let expected = Err(StepError::StepSize { dt });
        assert_eq!(
            ItoHeun::new(dt).step(&Spiral, &mut x, &NO_INPUT, &dw),
            expected
        );
        assert_eq!(
            ItoMilstein::new(dt).step(&Spiral, &mut x, &NO_INPUT, &dw),
            expected
        );
    }
    for result in [
        ItoHeun::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
        StratonovichHeun::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
        ItoMilstein::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
    ] {
        assert!(
            matches!(result, Err(StepError::NonFinite { name: "re", .. })),
            "{result:?}"
        );
    }
    assert_eq!(x, START);
}
