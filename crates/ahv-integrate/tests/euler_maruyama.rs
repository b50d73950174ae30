//! Euler–Maruyama against the closed forms of geometric Brownian motion and of an Ornstein–Uhlenbeck process.
#![forbid(unsafe_code)]

mod common;
#[path = "common/order.rs"]
mod order;

use ahv_core::{Model, StochasticModel, Vector};
use ahv_integrate::{ItoEulerMaruyama, StepError};
use approx::assert_relative_eq;
use common::vector;
use order::observed_order;

vector!(State, price, ornstein);
vector!(Noise, w_price, w_ornstein);

const MU: f64 = 0.3;
const SIGMA: f64 = 0.4;
const DECAY: f64 = 1.5;
const INTENSITY: f64 = 0.8;
const START: State<f64> = State {
    price: 1.0,
    ornstein: 0.5,
};

/// dS = μ S dt + σ S dW and dχ = −a χ dt + b dW, side by side.
struct Pair;

impl Model for Pair {
    type Scalar = f64;
    type State = State<f64>;
    type Input = State<f64>;

    fn drift(&self, x: &State<f64>, _: &State<f64>) -> State<f64> {
        State {
            price: MU * x.price,
            ornstein: -DECAY * x.ornstein,
        }
    }
}

impl StochasticModel for Pair {
    type Noise = Noise<f64>;

    fn noise_increment(&self, x: &State<f64>, _: &State<f64>, dw: &Noise<f64>) -> State<f64> {
        State {
            price: SIGMA * x.price * dw.w_price,
            ornstein: INTENSITY * dw.w_ornstein,
        }
    }
}

/// SplitMix64 and the sum of twelve uniforms: mean 0, variance 1, near enough to normal for moments.
struct Normal(u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn draw(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    fn increments(&mut self, dt: f64, steps: usize) -> Vec<Noise<f64>> {
        (0..steps)
            .map(|_| Vector::from_fn(|_| dt.sqrt() * self.draw()))
            .collect()
    }
}

fn path(dt: f64, increments: &[Noise<f64>]) -> State<f64> {
    let stepper = ItoEulerMaruyama::new(dt);
    let mut x = START;
    for dw in increments {
        stepper
            .step(&Pair, &mut x, &START, dw)
            .expect("both processes stay finite");
    }
    x
}

/// The Itô solution; that of Stratonovich would lack the −σ²/2.
fn exact_price(t: f64, w: f64) -> f64 {
    START.price * ((MU - 0.5 * SIGMA * SIGMA) * t + SIGMA * w).exp()
}

#[test]
fn the_strong_order_on_multiplicative_noise_is_one_half() {
    let (t_end, finest, paths) = (1.0, 1024, 2000);
    let levels = [16, 32, 64, 128, 256, 512];
    let mut squares = [0.0; 6];
    let mut normal = Normal(1);
    for _ in 0..paths {
        let fine = normal.increments(t_end / finest as f64, finest);
        let w: f64 = fine.iter().map(|dw| dw.w_price).sum();
        for (&steps, square) in levels.iter().zip(&mut squares) {
            let coarse: Vec<Noise<f64>> = fine
                .chunks(finest / steps)
                .map(|part| {
                    part.iter()
                        .fold(Noise::splat(0.0), |a, &b| a.zip_with(b, |a, b| a + b))
                })
                .collect();
            let price = path(t_end / steps as f64, &coarse).price;
            *square += (price - exact_price(t_end, w)).powi(2) / f64::from(paths);
        }
    }
    let points: Vec<(f64, f64)> = levels
        .iter()
        .zip(squares)
        .map(|(&steps, square)| (t_end / steps as f64, square.sqrt()))
        .collect();
    let order = observed_order(&points);
    assert!((order - 0.5).abs() < 0.06, "observed strong order {order}");
}

#[test]
fn the_moments_are_those_of_the_closed_forms() {
    let (t_end, steps, paths) = (1.0, 200, 20_000);
    let dt = t_end / f64::from(steps);
    let mut normal = Normal(2);
    let (mut price, mut ornstein, mut ornstein_2) = (0.0, 0.0, 0.0);
    for _ in 0..paths {
        let x = path(dt, &normal.increments(dt, steps as usize));
        price += x.price / f64::from(paths);
        ornstein += x.ornstein / f64::from(paths);
        ornstein_2 += x.ornstein * x.ornstein / f64::from(paths);
    }
    let variance = ornstein_2 - ornstein * ornstein;
    // Tolerances are some four standard errors of 20 000 paths, and more than the bias of the step.
    assert_relative_eq!(price, START.price * MU.exp(), max_relative = 0.015);
    assert_relative_eq!(ornstein, START.ornstein * (-DECAY).exp(), epsilon = 0.015);
    let closed = INTENSITY * INTENSITY * (1.0 - (-2.0 * DECAY).exp()) / (2.0 * DECAY);
    assert_relative_eq!(variance, closed, max_relative = 0.05);
}

#[test]
fn a_non_finite_increment_is_named_and_the_last_good_state_kept() {
    let mut x = START;
    let dw = Noise {
        w_price: 0.0,
        w_ornstein: f64::INFINITY,
    };
    let result = ItoEulerMaruyama::new(0.1).step(&Pair, &mut x, &START, &dw);
    assert_eq!(
        result,
        Err(StepError::NonFinite {
            name: "ornstein",
            value: f64::INFINITY
        })
    );
    assert_eq!(x, START);
    let result = ItoEulerMaruyama::new(-0.1).step(&Pair, &mut x, &START, &Noise::splat(0.0));
    assert_eq!(result, Err(StepError::StepSize { dt: -0.1 }));
}
