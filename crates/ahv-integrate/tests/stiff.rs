//! The stiff method at steps that explicit methods cannot take.
#![forbid(unsafe_code)]

use ahv_core::Vector;
use ahv_integrate::{Adaptive, Constant, Fixed, Problem, Progress, Rk4, Rodas4, Tsit5};
use ahv_models::{dcom, flexible_mode};
use approx::assert_relative_eq;

/// A mode far faster than the step is gone after one: L-stable.
#[test]
fn a_fast_mode_is_damped_in_one_step() {
    for zeta in [0.02, 0.7, 1.0, 20.0] {
        let parameters = flexible_mode::Parameters {
            omega: 1e6,
            zeta,
            ..flexible_mode::NOMINAL
        };
        let model = flexible_mode::Model::new(&parameters);
        let u = flexible_mode::Input { force: 2e12 };
        let start = flexible_mode::State {
            eta: 1.0,
            eta_dot: 0.0,
            chi: 1.0,
        };
        let (mut x, mut y) = (start, start);
        Fixed::new(Rodas4, 1.0)
            .step(&model, &mut x, &u)
            .expect("finite");
        assert_relative_eq!(x.eta, 2.0, epsilon = 1e-3);
        let explicit = Fixed::new(Tsit5, 1.0).step(&model, &mut y, &u);
        assert!(explicit.is_err() || y.eta.abs() > 1e10);
    }
}

fn fast_flight() -> (dcom::Model<f64>, dcom::State<f64>, dcom::Input<f64>) {
    let parameters = dcom::Parameters {
        omega_3: 20_000.0,
        zeta_3: 0.3,
        ..dcom::NOMINAL
    };
    let start = dcom::State {
        velocity: 7702.0808,
        altitude: 85_000.0,
        alpha: 0.0262,
        eta_1: 0.6276,
        eta_2: -0.0137,
        ..dcom::State::splat(0.0)
    };
    let u = dcom::Input {
        phi: 0.2821,
        delta_e: 0.2286,
        delta_c: 0.0,
    };
    (dcom::Model::new(&parameters), start, u)
}

#[test]
fn a_flight_with_a_fast_mode_takes_long_steps() {
    let (model, start, u) = fast_flight();
    let (mut long, mut explicit, mut fine) = (start, start, start);
    for _ in 0..100 {
        Fixed::new(Rodas4, 0.005)
            .step(&model, &mut long, &u)
            .expect("finite");
    }
    for _ in 0..50_000 {
        Rk4::new(1e-5).step(&model, &mut fine, &u).expect("finite");
    }
    assert_relative_eq!(long.alpha, fine.alpha, epsilon = 1e-7);
    assert_relative_eq!(long.eta_1, fine.eta_1, epsilon = 1e-5);
    let blown = (0..100).any(|_| Rk4::new(0.005).step(&model, &mut explicit, &u).is_err());
    assert!(
        blown,
        "the explicit method should have left the finite numbers"
    );
}

#[test]
fn control_of_the_step_size_pays_where_the_model_is_stiff() {
    let (model, start, u) = fast_flight();
    let input = Constant(u);
    let problem = Problem::new(&model, &input);
    let mut absolute = dcom::State::splat(1e-6);
    (absolute.velocity, absolute.altitude) = (1e-3, 1e-3);
    let (mut stiff, mut explicit) = (Progress::new(0.0, start), Progress::new(0.0, start));
    Adaptive::new(Rodas4, 1e-6, absolute)
        .run(&problem, &mut stiff, 1.0, &mut ())
        .expect("a short flight");
    Adaptive::new(Tsit5, 1e-6, absolute)
        .run(&problem, &mut explicit, 1.0, &mut ())
        .expect("a short flight");
    assert!(
        10 * stiff.accepted < explicit.accepted,
        "{} steps",
        stiff.accepted
    );
    assert_relative_eq!(stiff.state.alpha, explicit.state.alpha, epsilon = 1e-4);
}
