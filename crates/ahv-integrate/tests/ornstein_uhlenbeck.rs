//! Exact transitions against closed forms, and the splitting that uses them.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[path = "common/order.rs"]
mod order;

use ahv_core::{ColouredNoise, ItoCorrected, Model, NoiseClass, StochasticModel, Vector};
use ahv_integrate::{Heun, ItoStrangSplitting, LinearTransition, NoiseError, Rk4, StepError};
use ahv_models::flexible_mode;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::vector;
use normal::Normal;
use order::observed_order;

vector!(State, position, rate, chi_1, chi_2);
vector!(Noise, w, xi_1, xi_2);
vector!(Nothing, held);

const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };

fn mode(omega: f64, zeta: f64, dt: f64) -> LinearTransition<f64, 2> {
    LinearTransition::mode(omega, zeta, 3.0, dt).expect("a step size of the test")
}

#[test]
fn the_coloured_noise_has_its_closed_form_at_every_step_size() {
    // The last two are far faster than the step: 5e8 1/s is the decay rate of a mode of 30 rad/s with a damping ratio of 3e-8.
    for (decay, diffusion) in [
        (13.8, 0.6),
        (500.0, 7.0),
        (0.02, 1.0),
        (5e8, 5.6e6),
        (1e150, 1e75),
    ] {
        for dt in [1e-6, 1e-3, 0.02, 1.0, 50.0] {
            let exact = LinearTransition::ornstein_uhlenbeck(decay, diffusion, dt).expect("a step");
            let spread: f64 = -f64::exp_m1(-2.0 * decay * dt) / (2.0 * decay);
            let ([[kept]], [[variance]]) = (*exact.transition(), *exact.covariance());
            assert_abs_diff_eq!(kept, (-decay * dt).exp(), epsilon = 1e-14);
            assert_relative_eq!(variance, diffusion.powi(2) * spread, max_relative = 1e-13);
            let forced = -f64::exp_m1(-decay * dt) / decay;
            assert_relative_eq!(exact.forced()[0][0], forced, max_relative = 1e-13);
        }
    }
}

/// σ² ∫ h² of the impulse response h, under-, critically and overdamped.
#[test]
fn the_mode_has_its_closed_form_at_any_damping() {
    let omega: f64 = 19.7437;
    for dt in [1e-4, 0.01, 0.1, 2.0] {
        for zeta in [0.02, 0.7] {
            let exact = mode(omega, zeta, dt);
            let (z, d) = (zeta * omega, omega * f64::sqrt(1.0 - zeta * zeta));
            let (e, (s, c)) = ((-z * dt).exp(), (d * dt).sin_cos());
            let expected = [
                [e * (c + z / d * s), e * s / d],
                [-omega * omega * e * s / d, e * (c - z / d * s)],
            ];
            for (row, own) in expected.iter().zip(exact.transition()) {
                for (entry, own) in row.iter().zip(own) {
                    assert_abs_diff_eq!(entry, own, epsilon = 1e-12 * omega);
                }
            }
        }
        let exact = mode(omega, 1.0, dt);
        let e = (-omega * dt).exp();
        assert_abs_diff_eq!(exact.transition()[0][1], e * dt, epsilon = 1e-14);
        // Overdamped, from the poles.
        let (fast, slow) = (omega * 2.0, omega * 0.5);
        let exact = mode(omega, 1.25, dt);
        let response = ((-slow * dt).exp() - (-fast * dt).exp()) / (fast - slow);
        assert_abs_diff_eq!(exact.transition()[0][1], response, epsilon = 1e-14);
    }
}

#[test]
fn the_covariance_solves_its_differential_equation_and_tends_to_the_stationary_one() {
    let (omega, zeta, sigma) = (19.7437_f64, 0.7, 3.0);
    // Simpson's rule over the impulse response, fine enough for ten digits.
    let dt = 0.13;
    let parts = 4000;
    let h = dt / f64::from(parts);
    let z = zeta * omega;
    let d = omega * f64::sqrt(1.0 - zeta * zeta);
    let mut sums = [0.0; 3];
    for index in 0..=parts {
        let weight = match index {
            0 => 1.0,
            i if i == parts => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let s = f64::from(index) * h;
        let response = (-z * s).exp() * (d * s).sin() / d;
        let slope = (-z * s).exp() * ((d * s).cos() - z / d * (d * s).sin());
        let products = [response * response, response * slope, slope * slope];
        for (sum, product) in sums.iter_mut().zip(products) {
            *sum += weight * h / 3.0 * sigma * sigma * product;
        }
    }
    let [[a, b], [c, e]] = *mode(omega, zeta, dt).covariance();
    assert_relative_eq!(a, sums[0], max_relative = 1e-10);
    assert_relative_eq!(b, sums[1], max_relative = 1e-8);
    assert_relative_eq!(e, sums[2], max_relative = 1e-10);
    assert_relative_eq!(b, c, max_relative = 1e-12);

    let [[a, b], [_, e]] = *mode(omega, zeta, 10.0).covariance();
    assert_relative_eq!(a, 9.0 / (4.0 * zeta * omega.powi(3)), max_relative = 1e-12);
    assert_relative_eq!(e, 9.0 / (4.0 * zeta * omega), max_relative = 1e-12);
    assert_abs_diff_eq!(b, 0.0, epsilon = 1e-12);
}

#[test]
fn a_held_force_is_carried_exactly() {
    let exact = mode(20.0, 0.3, 0.05);
    let at_rest = [7.0 / 400.0, 0.0];
    let x = exact.step(&at_rest, &[0.0, 7.0], &[0.0; 2]);
    assert_relative_eq!(x[0], at_rest[0], max_relative = 1e-13);
    assert_abs_diff_eq!(x[1], 0.0, epsilon = 1e-13);
}

/// Mean and variance of an equilibrium sample within three standard errors of the closed forms. Consecutive
/// samples are correlated; every twentieth is taken.
#[test]
fn the_stationary_moments_of_mode_and_coloured_noise_are_the_closed_ones() {
    let model = flexible_mode::Model::new(&flexible_mode::NOMINAL).prepared;
    let exact = LinearTransition::mode_and_coloured_noise(
        [model.omega, model.zeta, model.sigma],
        [model.chi_decay, model.chi_diffusion],
        0.02,
    )
    .expect("a step size of the test");
    let (count, mut normal, mut x) = (20_000, Normal(8), [0.0; 3]);
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    for _ in 0..count {
        for _ in 0..20 {
            let z = [normal.draw(), normal.draw(), normal.draw()];
            x = exact.step(&x, &[0.0; 3], &z);
        }
        for i in 0..3 {
            sums[i] += x[i] / f64::from(count);
            squares[i] += x[i] * x[i] / f64::from(count);
        }
    }
    let (omega, zeta, sigma) = (model.omega, model.zeta, model.sigma);
    let closed = [
        sigma.powi(2) / (4.0 * zeta * omega.powi(3)),
        sigma.powi(2) / (4.0 * zeta * omega),
        model.chi_diffusion.powi(2) / (2.0 * model.chi_decay),
    ];
    for i in 0..3 {
        let variance: f64 = closed[i];
        let (mean_error, variance_error) = (
            (variance / f64::from(count)).sqrt(),
            variance * (2.0 / f64::from(count)).sqrt(),
        );
        assert_abs_diff_eq!(sums[i], 0.0, epsilon = 3.0 * mean_error);
        assert_abs_diff_eq!(squares[i], variance, epsilon = 3.0 * variance_error);
    }
}

#[test]
fn a_wiener_increment_and_the_coloured_noise_that_it_drives_have_their_joint_law() {
    let (a, b, dt) = (13.8_f64, 0.6, 0.02);
    let exact = LinearTransition::new([[0.0, 0.0], [0.0, -a]], [[1.0, b], [b, b * b]], dt)
        .expect("a step size of the test");
    let [[w, both], [_, chi]] = *exact.covariance();
    assert_relative_eq!(w, dt, max_relative = 1e-14);
    assert_relative_eq!(both, -b * f64::exp_m1(-a * dt) / a, max_relative = 1e-13);
    let own = LinearTransition::ornstein_uhlenbeck(a, b, dt).expect("a step size of the test");
    assert_relative_eq!(chi, own.covariance()[0][0], max_relative = 1e-14);
}

#[test]
fn single_precision_serves_too() {
    let single = LinearTransition::mode(19.7_f32, 0.7, 3.0, 0.02).expect("a step");
    let double =
        LinearTransition::mode(f64::from(19.7_f32), f64::from(0.7_f32), 3.0, 0.02).expect("a step");
    for (row, own) in double.covariance().iter().zip(single.covariance()) {
        for (&entry, &own) in row.iter().zip(own) {
            assert_relative_eq!(entry, f64::from(own), max_relative = 1e-5);
        }
    }
}

#[test]
fn a_direction_without_noise_is_left_out() {
    // Both processes decay alike and share their noise: they are one.
    let exact = LinearTransition::new([[-2.0, 0.0], [0.0, -2.0]], [[1.0, 3.0], [3.0, 9.0]], 0.1)
        .expect("a step size of the test");
    let x = exact.step(&[0.0; 2], &[0.0; 2], &[1.0, 1.0]);
    assert_relative_eq!(x[1], 3.0 * x[0], max_relative = 1e-6);
    let still = LinearTransition::new([[-2.0]], [[0.0]], 0.1).expect("a step size of the test");
    assert_eq!(still.step(&[0.0], &[0.0], &[5.0]), [0.0]);
    let refused = LinearTransition::new([[-2.0]], [[0.0]], 0.0);
    assert_eq!(refused, Err(StepError::StepSize { dt: 0.0 }));
}

/// A driven pendulum, moved by two coloured noises and a white one that depends on the state.
#[derive(Clone, Copy)]
struct Pendulum {
    white: f64,
    shared: f64,
    /// What the first coloured noise's channel does to the rate: the splitting must refuse it.
    leak: f64,
}

const DECAY: [f64; 2] = [1.5, 4.0];
const QUIET: Pendulum = Pendulum {
    white: 0.0,
    shared: 0.0,
    leak: 0.0,
};

impl Model for Pendulum {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &State<f64>, _: &Nothing<f64>) -> State<f64> {
        State {
            position: x.rate,
            rate: -2.0 * x.position - 0.5 * x.rate + x.chi_1 - 0.5 * x.chi_2,
            chi_1: -DECAY[0] * x.chi_1,
            chi_2: -DECAY[1] * x.chi_2,
        }
    }
}

impl StochasticModel for Pendulum {
    type Noise = Noise<f64>;

    fn noise_increment(&self, x: &State<f64>, _: &Nothing<f64>, dw: &Noise<f64>) -> State<f64> {
        State {
            position: 0.0,
            rate: self.white * x.rate * dw.w + self.leak * dw.xi_1,
            chi_1: 0.8 * dw.xi_1,
            chi_2: 1.2 * (self.shared * dw.xi_1 + (1.0 - self.shared) * dw.xi_2),
        }
    }

    fn noise_class(channel: usize) -> NoiseClass {
        if channel == 0 {
            NoiseClass::Diagonal
        } else {
            NoiseClass::Constant
        }
    }
}

impl ItoCorrected for Pendulum {
    fn ito_correction(&self, x: &State<f64>, _: &Nothing<f64>) -> State<f64> {
        State {
            rate: 0.5 * self.white.powi(2) * x.rate,
            ..State::splat(0.0)
        }
    }
}

impl ColouredNoise for Pendulum {
    fn decay(&self, state: usize) -> Option<f64> {
        state
            .checked_sub(2)
            .and_then(|index| DECAY.get(index).copied())
    }
}

/// Variance of the position at t = 1 from rest. The splitting is linear, so the covariance takes a step as the
/// steps of unit vectors say.
fn variance_by_splitting(model: &Pendulum, steps: u32) -> f64 {
    let dt = 1.0 / f64::from(steps);
    let splitting = ItoStrangSplitting::<f64, 2>::new(model, &State::splat(0.0), &NO_INPUT, dt)
        .expect("the pendulum's coloured noise stands apart");
    let stepped = |x: State<f64>, normals: [[f64; 2]; 2]| {
        let mut x = x;
        splitting
            .step(model, &mut x, &normals, |others, x, dt| {
                Heun::new(dt).step(others, x, &NO_INPUT)
            })
            .expect("the pendulum stays finite");
        x.to_array()
    };
    let columns: [[f64; 4]; 4] = std::array::from_fn(|j| {
        stepped(
            State::from_fn(|i| f64::from(u8::from(i == j))),
            [[0.0; 2]; 2],
        )
    });
    let kicks: [[f64; 4]; 4] = std::array::from_fn(|j| {
        let mut normals = [[0.0; 2]; 2];
        normals[j / 2][j % 2] = 1.0;
        stepped(State::splat(0.0), normals)
    });
    let mut p = [[0.0; 4]; 4];
    for _ in 0..steps {
        p = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let noise: f64 = kicks.iter().map(|kick| kick[i] * kick[j]).sum();
                let carried: f64 = (0..16)
                    .map(|n| columns[n / 4][i] * p[n / 4][n % 4] * columns[n % 4][j])
                    .sum();
                noise + carried
            })
        });
    }
    p[0][0]
}

fn exact_variance(shared: f64) -> f64 {
    let a = [
        [0.0, 1.0, 0.0, 0.0],
        [-2.0, -0.5, 1.0, -0.5],
        [0.0, 0.0, -DECAY[0], 0.0],
        [0.0, 0.0, 0.0, -DECAY[1]],
    ];
    let g = [
        [0.0, 0.0],
        [0.0, 0.0],
        [0.8, 0.0],
        [1.2 * shared, 1.2 * (1.0 - shared)],
    ];
    let q = g.map(|row| g.map(|column| row[0] * column[0] + row[1] * column[1]));
    LinearTransition::new(a, q, 1.0)
        .expect("a step size of the test")
        .covariance()[0][0]
}

#[test]
fn the_splitting_has_weak_order_two() {
    for shared in [0.0, 1.0] {
        let model = Pendulum { shared, ..QUIET };
        let points = [4, 8, 16, 32, 64, 128].map(|steps| {
            let error = variance_by_splitting(&model, steps) - exact_variance(shared);
            (1.0 / f64::from(steps), error.abs())
        });
        let order = observed_order(&points);
        println!("order {order:.3}, errors {points:?}");
        assert!((order - 2.0).abs() < 0.1, "observed weak order {order}");
    }
}

/// White noise in the Itô sense does not move the mean.
#[test]
fn white_noise_beside_the_coloured_is_stepped_in_the_ito_sense() {
    let model = Pendulum {
        white: 0.5,
        ..QUIET
    };
    let (dt, paths, mut normal) = (0.05, 4000, Normal(2));
    let splitting = ItoStrangSplitting::<f64, 2>::new(&model, &State::splat(0.0), &NO_INPUT, dt)
        .expect("the pendulum's coloured noise stands apart");
    let start = State {
        position: 1.0,
        rate: 0.5,
        chi_1: 0.2,
        chi_2: 0.0,
    };
    let mut reference = start;
    for _ in 0..1000 {
        Rk4::new(0.001)
            .step(&QUIET, &mut reference, &NO_INPUT)
            .expect("the pendulum is smooth");
    }
    let (mut mean, mut square) = (0.0, 0.0);
    for _ in 0..paths {
        let mut x = start;
        for _ in 0..20 {
            let dw = normal.draws::<Noise<f64>>().map(|z| f64::sqrt(dt) * z);
            let normals = [
                [normal.draw(), normal.draw()],
                [normal.draw(), normal.draw()],
            ];
            splitting
                .step_heun(&model, &mut x, &NO_INPUT, &dw, &normals)
                .expect("the pendulum stays finite");
        }
        mean += x.rate / f64::from(paths);
        square += x.rate * x.rate / f64::from(paths);
    }
    let error = ((square - mean * mean) / f64::from(paths)).sqrt();
    assert_abs_diff_eq!(mean, reference.rate, epsilon = 3.0 * error);
}

#[test]
fn the_splitting_refuses_what_it_cannot_split() {
    let x = State::splat(0.0);
    let count = ItoStrangSplitting::<f64, 3>::new(&QUIET, &x, &NO_INPUT, 0.1);
    assert_eq!(
        count,
        Err(NoiseError::ColouredStates {
            expected: 3,
            found: 2
        })
    );
    let leaking = Pendulum { leak: 0.1, ..QUIET };
    let shared = ItoStrangSplitting::<f64, 2>::new(&leaking, &x, &NO_INPUT, 0.1);
    assert_eq!(
        shared,
        Err(NoiseError::SharedChannel {
            channel: "xi_1",
            state: "rate"
        })
    );
    let size = ItoStrangSplitting::<f64, 2>::new(&QUIET, &x, &NO_INPUT, -0.1);
    assert_eq!(size, Err(NoiseError::StepSize { dt: -0.1 }));
}

#[test]
fn an_error_inside_the_splitting_keeps_the_state() {
    let splitting = ItoStrangSplitting::<f64, 2>::new(&QUIET, &State::splat(0.0), &NO_INPUT, 0.1)
        .expect("the pendulum's coloured noise stands apart");
    let start = State {
        position: f64::NAN,
        rate: 0.0,
        chi_1: 1.0,
        chi_2: 1.0,
    };
    let mut x = start;
    let dw = Noise::splat(0.0);
    let result = splitting.step_heun(&QUIET, &mut x, &NO_INPUT, &dw, &[[1.0; 2]; 2]);
    assert!(matches!(
        result,
        Err(StepError::NonFinite {
            name: "position",
            ..
        })
    ));
    assert_eq!((x.chi_1, x.chi_2), (1.0, 1.0));
}
