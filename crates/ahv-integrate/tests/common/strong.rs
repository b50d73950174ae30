//! Strong orders: coarse solutions against closed forms, or much finer ones, on the same Brownian path.

use ahv_core::{
    AdditiveNoise, CommutativeNoise, DifferentiableNoise, ItoCorrected, Model, NoiseClass,
    StochasticModel,
};
use ahv_integrate::{ItoSra1, StepError, WienerIntegrals};

use super::common::vector;
use super::normal::{Normal, refined};
use super::order::observed_order;

vector!(Plane, re, im);
vector!(Two, w_1, w_2);
vector!(Nothing, held);

pub(crate) const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };
const RATE: (f64, f64) = (-0.2, 0.1);
const SLOPES: [(f64, f64); 2] = [(0.3, 0.2), (-0.1, 0.4)];
pub(crate) const START: Plane<f64> = Plane { re: 1.0, im: 0.5 };
pub(crate) const T_END: f64 = 1.0;

fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    (a * c - b * d, a * d + b * c)
}

fn turned(factor: (f64, f64), x: &Plane<f64>) -> Plane<f64> {
    let (re, im) = times(factor, (x.re, x.im));
    Plane { re, im }
}

/// dz = r z dt + c₁ z dW₁ + c₂ z dW₂ with complex r, c: general columns that commute.
pub(crate) struct Spiral;

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

pub(crate) type Step = fn(f64, &mut Plane<f64>, &Two<f64>) -> Result<(), StepError<f64>>;

/// Root mean square errors of a scheme at t = 1 over the step sizes 2⁻³ to 2⁻⁸, and their slope.
pub(crate) fn spiral_order(step: Step, sense: f64) -> f64 {
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
    observed_order(&points)
}

/// A nonlinear drift with additive noise in both components.
pub(crate) struct Curved;

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

    fn noise_commutes(_: usize, _: usize) -> bool {
        true
    }
}

impl ItoCorrected for Curved {
    fn ito_correction(&self, _: &Plane<f64>, _: &Nothing<f64>) -> Plane<f64> {
        Plane { re: 0.0, im: 0.0 }
    }
}

impl DifferentiableNoise for Curved {
    fn iterated_increment(
        &self,
        _: &Plane<f64>,
        _: &Nothing<f64>,
        _: impl FnMut(usize, usize) -> f64,
    ) -> Plane<f64> {
        Plane { re: 0.0, im: 0.0 }
    }
}

impl AdditiveNoise for Curved {}
impl CommutativeNoise for Curved {}

/// dx = −x dt + dW₁, dy = (x − y) dt + x dW₂: two columns that do not commute, of which neither has an Itô correction.
pub(crate) struct Area;

impl Model for Area {
    type Scalar = f64;
    type State = Plane<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Plane<f64>, _: &Nothing<f64>) -> Plane<f64> {
        Plane {
            re: -x.re,
            im: x.re - x.im,
        }
    }
}

impl StochasticModel for Area {
    type Noise = Two<f64>;

    fn noise_increment(&self, x: &Plane<f64>, _: &Nothing<f64>, dw: &Two<f64>) -> Plane<f64> {
        Plane {
            re: dw.w_1,
            im: x.re * dw.w_2,
        }
    }
}

impl ItoCorrected for Area {
    fn ito_correction(&self, _: &Plane<f64>, _: &Nothing<f64>) -> Plane<f64> {
        Plane { re: 0.0, im: 0.0 }
    }
}

/// A step with ΔW and ΔZ.
pub(crate) type IntegralStep =
    fn(f64, &mut Plane<f64>, &WienerIntegrals<Two<f64>>) -> Result<(), StepError<f64>>;

/// Root mean square errors of a scheme at t = 1 over the step sizes 2⁻³ to 2⁻⁸ against `reference` at 2⁻¹², and their
/// slope.
pub(crate) fn refined_order(step: IntegralStep, reference: IntegralStep) -> f64 {
    let (finest, levels) = (12, 3..=8);
    let run = |step: IntegralStep, level: usize, steps: &[WienerIntegrals<Two<f64>>]| {
        let mut x = START;
        for integrals in steps {
            step(dt(level), &mut x, integrals).expect("the drift is bounded by the state");
        }
        x
    };
    let mut squares = [0.0; 6];
    let mut normal = Normal(5);
    for _ in 0..150 {
        let path = refined::<Two<f64>>(&mut normal, T_END, finest);
        let end = run(reference, finest, &path[finest]);
        for (level, square) in levels.clone().zip(&mut squares) {
            let x = run(step, level, &path[level]);
            *square += (x.re - end.re).powi(2) + (x.im - end.im).powi(2);
        }
    }
    slope(levels, &squares)
}

/// The strong order on [`Curved`], against SRA1.
pub(crate) fn curved_order(step: IntegralStep) -> f64 {
    refined_order(step, |dt, x, w| {
        ItoSra1::new(dt).step(&Curved, x, &NO_INPUT, w)
    })
}

/// The strong order on [`Area`], against itself.
pub(crate) fn area_order(step: IntegralStep) -> f64 {
    refined_order(step, step)
}
