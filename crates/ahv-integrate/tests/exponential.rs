//! Exact propagation of flexible modes.
#![forbid(unsafe_code)]

mod common;

use ahv_core::Model;
use ahv_integrate::{Exponential, Fixed, FlexibleMode, Rk4, StepError, Tsit5};
use ahv_models::{dcom, flexible_mode};
use approx::assert_relative_eq;
use common::vector;

vector!(Rigid, position, speed);

type State = flexible_mode::State<f64>;
type Input = flexible_mode::Input<f64>;
type ClosedForm = fn(&State, &Input, &flexible_mode::Prepared<f64>, f64) -> State;

const START: State = State {
    eta: 0.7,
    eta_dot: -20.0,
    chi: 0.0,
};
const FORCE: Input = Input { force: 250.0 };

fn one_step(omega: f64, zeta: f64, dt: f64, closed_form: ClosedForm) {
    let parameters = flexible_mode::Parameters {
        omega,
        zeta,
        ..flexible_mode::NOMINAL
    };
    let model = flexible_mode::Model::new(&parameters);
    let mode = FlexibleMode::new::<flexible_mode::Model<f64>>("eta", "eta_dot", omega, zeta)
        .expect("a good mode");
    let mut x = START;
    Exponential::new(dt, [mode])
        .step(&model, &mut x, &FORCE)
        .expect("finite");
    let exact = closed_form(&START, &FORCE, &model.prepared, dt);
    let size = START.eta.hypot(START.eta_dot / omega) + FORCE.force / (omega * omega);
    assert_relative_eq!(x.eta, exact.eta, epsilon = 5e-13 * size);
    assert_relative_eq!(x.eta_dot, exact.eta_dot, epsilon = 5e-13 * size * omega);
}

#[test]
fn a_mode_under_constant_force_is_exact_at_any_step_and_damping() {
    for dt in [1e-4, 1e-3, 0.01, 0.05, 0.3, 2.0] {
        for omega in [5.0, 19.7437, 105.0] {
            for zeta in [1e-6, 0.02, 0.5, 0.7, 0.9] {
                one_step(omega, zeta, dt, flexible_mode::response_underdamped);
            }
            one_step(omega, 1.0, dt, flexible_mode::response_critical);
            for zeta in [1.1, 1.5, 3.0] {
                one_step(omega, zeta, dt, flexible_mode::response_overdamped);
            }
        }
    }
}

#[test]
fn nothing_jumps_at_critical_damping() {
    let step = |zeta: f64| {
        let parameters = flexible_mode::Parameters {
            zeta,
            ..flexible_mode::NOMINAL
        };
        let omega = parameters.omega;
        let model = flexible_mode::Model::new(&parameters);
        let mode = FlexibleMode::new::<flexible_mode::Model<f64>>("eta", "eta_dot", omega, zeta)
            .expect("a good mode");
        let mut x = START;
        let stepper = Exponential::new(0.08, [mode]);
        stepper.step(&model, &mut x, &FORCE).expect("finite");
        x
    };
    let critical = step(1.0);
    for offset in [1e-12, 1e-9, 1e-7] {
        for zeta in [1.0 - offset, 1.0 + offset] {
            assert_relative_eq!(step(zeta).eta, critical.eta, epsilon = 2.0 * offset + 1e-14);
        }
    }
}

#[test]
fn without_modes_it_is_the_classical_runge_kutta_method() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let start = dcom::State::from_array([
        7702.0, 85_000.0, 0.01, 0.03, 0.02, 0.6, 1.0, 0.0, 0.0, 0.0, 0.0,
    ]);
    let u = dcom::Input::from_array([0.3, 0.2, 0.0]);
    let (mut x, mut y) = (start, start);
    Exponential::new(0.01, [])
        .step(&model, &mut x, &u)
        .expect("finite");
    Rk4::new(0.01).step(&model, &mut y, &u).expect("finite");
    for (x, y) in x.to_array().into_iter().zip(y.to_array()) {
        assert_relative_eq!(x, y, max_relative = 1e-13, epsilon = 1e-15);
    }
}

/// A hundred times the stability limit of the explicit methods on the fastest mode.
#[test]
fn steps_may_be_long_against_the_modes() {
    let parameters = dcom::Parameters {
        omega_3: 20_000.0,
        zeta_3: 0.02,
        ..dcom::NOMINAL
    };
    let p = &parameters;
    let model = dcom::Model::new(p);
    let mode = |position, rate, omega, zeta| {
        FlexibleMode::new::<dcom::Model<f64>>(position, rate, omega, zeta).expect("a good mode")
    };
    let modes = [
        mode("eta_1", "eta_dot_1", p.omega_1, p.zeta_1),
        mode("eta_2", "eta_dot_2", p.omega_2, p.zeta_2),
        mode("eta_3", "eta_dot_3", p.omega_3, p.zeta_3),
    ];
    let start = dcom::State::from_array([
        7702.0, 85_000.0, 0.0, 0.026, 0.0, 0.6, 0.0, 0.0, 0.0, 1e-7, 0.0,
    ]);
    let u = dcom::Input::from_array([0.2821, 0.2286, 0.0]);
    let end = 0.2;
    let (mut long, mut fine, mut explicit) = (start, start, start);
    for _ in 0..20 {
        Exponential::new(end / 20.0, modes)
            .step(&model, &mut long, &u)
            .expect("finite");
    }
    for _ in 0..20_000 {
        Fixed::new(Tsit5, end / 20_000.0)
            .step(&model, &mut fine, &u)
            .expect("finite");
    }
    assert_relative_eq!(long.alpha, fine.alpha, epsilon = 1e-7);
    assert_relative_eq!(long.eta_1, fine.eta_1, epsilon = 1e-5);
    assert_relative_eq!(long.eta_2, fine.eta_2, epsilon = 1e-5);
    assert_relative_eq!(long.eta_3, fine.eta_3, epsilon = 1e-8);
    let blown = (0..200).any(|_| Rk4::new(0.01).step(&model, &mut explicit, &u).is_err());
    assert!(
        blown,
        "the explicit method should have left the finite numbers"
    );
}

struct Falling;

impl Model for Falling {
    type Scalar = f64;
    type State = Rigid<f64>;
    type Input = Rigid<f64>;

    fn drift(&self, x: &Rigid<f64>, u: &Rigid<f64>) -> Rigid<f64> {
        Rigid {
            position: x.speed,
            speed: u.speed,
        }
    }
}

#[test]
fn what_is_no_mode_or_no_step_is_refused() {
    let new = FlexibleMode::new::<Falling>;
    assert_eq!(new("position", "nothing", 1.0, 0.5), None);
    assert_eq!(new("position", "speed", 0.0, 0.5), None);
    assert_eq!(new("position", "speed", f64::NAN, 0.5), None);
    assert_eq!(new("position", "speed", 1.0, -0.5), None);
    assert!(new("position", "speed", 1.0, 0.5).is_some());
    let u = Rigid {
        position: 0.0,
        speed: -9.8,
    };
    let start = Rigid {
        position: 1.0,
        speed: f64::MAX,
    };
    let mut x = start;
    let refused = Exponential::new(-1.0, []).step(&Falling, &mut x, &u);
    assert_eq!(refused, Err(StepError::StepSize { dt: -1.0 }));
    let infinite = Exponential::new(1e10, []).step(&Falling, &mut x, &u);
    assert!(matches!(infinite, Err(StepError::NonFinite { .. })));
    assert_eq!(x, start);
}
