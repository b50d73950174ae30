//! What a step evaluates, as `docs/integrators.md` says: its first table, and the table of the stochastic schemes.
#![forbid(unsafe_code)]

mod common;

use std::cell::Cell;

use ahv_core::{
    AdditiveNoise, CommutativeNoise, DifferentiableModel, DifferentiableNoise, ItoCorrected, Model,
    NoiseClass, Pattern, StochasticModel, Vector,
};
use ahv_integrate::{
    DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, Heun, ItoDri1, ItoEulerMaruyama,
    ItoHeun, ItoMilstein, ItoSra1, Rk4, Rodas4, StepError, StratonovichHeun, Tsit5, WeakIncrements,
    WienerIntegrals,
};
use common::vector;

vector!(Pair, a, b);
vector!(Three, w_1, w_2, w_3);
vector!(Nothing, held);

const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };
const DW: Three<f64> = Three {
    w_1: 0.1,
    w_2: -0.1,
    w_3: 0.1,
};

/// A model that counts what is asked of it. The first column of its noise is constant.
#[derive(Default)]
struct Counted {
    drifts: Cell<u32>,
    jacobians: Cell<u32>,
    increments: Cell<u32>,
    corrections: Cell<u32>,
    iterated: Cell<u32>,
}

fn add(cell: &Cell<u32>) {
    cell.set(cell.get() + 1);
}

impl Model for Counted {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        add(&self.drifts);
        x.map(|x| -x)
    }
}

impl DifferentiableModel for Counted {
    type StateJacobian = Pair<Pair<f64>>;
    type InputJacobian = Pair<Nothing<f64>>;

    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([2, 2], &[[0, 0], [1, 1]]);

    fn jacobians(
        &self,
        _: &Pair<f64>,
        _: &Nothing<f64>,
    ) -> (Self::StateJacobian, Self::InputJacobian) {
        add(&self.jacobians);
        let by_state = Pair {
            a: Pair { a: -1.0, b: 0.0 },
            b: Pair { a: 0.0, b: -1.0 },
        };
        (by_state, Pair::splat(NO_INPUT))
    }

    fn drift_and_jacobians(
        &self,
        x: &Pair<f64>,
        u: &Nothing<f64>,
    ) -> (Pair<f64>, Self::StateJacobian, Self::InputJacobian) {
        let (by_state, by_input) = self.jacobians(x, u);
        (self.drift(x, u), by_state, by_input)
    }
}

impl StochasticModel for Counted {
    type Noise = Three<f64>;

    fn noise_increment(&self, _: &Pair<f64>, _: &Nothing<f64>, dw: &Three<f64>) -> Pair<f64> {
        add(&self.increments);
        Pair {
            a: dw.w_1 + dw.w_2,
            b: dw.w_3,
        }
    }

    fn noise_class(channel: usize) -> NoiseClass {
        match channel {
            0 => NoiseClass::Constant,
            _ => NoiseClass::General,
        }
    }
}

impl ItoCorrected for Counted {
    fn ito_correction(&self, _: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        add(&self.corrections);
        Pair::splat(0.0)
    }
}

impl DifferentiableNoise for Counted {
    fn iterated_increment(
        &self,
        _: &Pair<f64>,
        _: &Nothing<f64>,
        _: impl FnMut(usize, usize) -> f64,
    ) -> Pair<f64> {
        add(&self.iterated);
        Pair::splat(0.0)
    }
}

impl AdditiveNoise for Counted {}
impl CommutativeNoise for Counted {}

/// Drifts, Jacobians, increments, corrections and L^j b^k of a step.
fn cost(step: impl FnOnce(&Counted, &mut Pair<f64>) -> Result<(), StepError<f64>>) -> [u32; 5] {
    let (model, mut x) = (Counted::default(), Pair { a: 1.0, b: 0.5 });
    step(&model, &mut x).expect("a finite step");
    [
        model.drifts.get(),
        model.jacobians.get(),
        model.increments.get(),
        model.corrections.get(),
        model.iterated.get(),
    ]
}

#[test]
fn a_deterministic_step_costs_what_is_documented() {
    let drifts = |count| [count, 0, 0, 0, 0];
    assert_eq!(
        cost(|m, x| Euler::new(0.1).step(m, x, &NO_INPUT)),
        drifts(1)
    );
    assert_eq!(cost(|m, x| Heun::new(0.1).step(m, x, &NO_INPUT)), drifts(2));
    assert_eq!(cost(|m, x| Rk4::new(0.1).step(m, x, &NO_INPUT)), drifts(4));
    let five = cost(|m, x| Fixed::new(DormandPrince54, 0.1).step(m, x, &NO_INPUT));
    assert_eq!(five, drifts(7));
    let five = cost(|m, x| Fixed::new(Tsit5, 0.1).step(m, x, &NO_INPUT));
    assert_eq!(five, drifts(7));
    let eight = cost(|m, x| Fixed::new(DormandPrince853, 0.1).step(m, x, &NO_INPUT));
    assert_eq!(eight, drifts(12));
    let exponential = cost(|m, x| Exponential::<0>::new(0.1, []).step(m, x, &NO_INPUT));
    assert_eq!(exponential, drifts(4));
    let stiff = cost(|m, x| Fixed::new(Rodas4, 0.1).step(m, x, &NO_INPUT));
    assert_eq!(stiff, [6, 1, 0, 0, 0]);
}

#[test]
fn a_stochastic_step_costs_what_is_documented() {
    let euler = cost(|m, x| ItoEulerMaruyama::new(0.1).step(m, x, &NO_INPUT, &DW));
    assert_eq!(euler, [1, 0, 1, 0, 0]);
    let heun = cost(|m, x| StratonovichHeun::new(0.1).step(m, x, &NO_INPUT, &DW));
    assert_eq!(heun, [2, 0, 2, 0, 0]);
    let heun = cost(|m, x| ItoHeun::new(0.1).step(m, x, &NO_INPUT, &DW));
    assert_eq!(heun, [2, 0, 2, 2, 0]);
    let milstein = cost(|m, x| ItoMilstein::new(0.1).step(m, x, &NO_INPUT, &DW));
    assert_eq!(milstein, [1, 0, 1, 0, 1]);
    let sra1 = cost(|m, x| {
        let integrals = WienerIntegrals { dw: DW, dz: DW };
        ItoSra1::new(0.1).step(m, x, &NO_INPUT, &integrals)
    });
    assert_eq!(sra1, [2, 0, 2, 0, 0]);
    // One, and nine for each of the two columns that are not constant.
    let dri1 = cost(|m, x| {
        let increments = WeakIncrements {
            three_point: DW,
            two_point: DW,
        };
        ItoDri1::new(0.1).step(m, x, &NO_INPUT, &increments)
    });
    assert_eq!(dri1, [3, 0, 19, 0, 0]);
}
