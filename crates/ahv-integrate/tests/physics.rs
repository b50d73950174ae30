//! What the physics conserves, and the symmetries of the equations.
#![forbid(unsafe_code)]

#[path = "common/order.rs"]
mod order;

use ahv_core::{Model as _, Vector};
use ahv_integrate::{
    Adaptive, Constant, DormandPrince54, Euler, Exponential, Fixed, FlexibleMode, Heun, Problem,
    Progress, Rk4, Rodas4, StepError, Tsit5,
};
use ahv_models::dcom;
use approx::assert_relative_eq;
use order::observed_order;

type Flight = dcom::State<f64>;
type Model = dcom::Model<f64>;
type Outcome = Result<(), StepError<f64>>;

const INPUT: dcom::Input<f64> = dcom::Input {
    phi: 0.28,
    delta_e: 0.2,
    delta_c: 0.0,
};
const RISING: Flight = Flight {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.3,
    alpha: 0.03,
    pitch_rate: 0.02,
    eta_1: 0.0,
    eta_dot_1: 0.0,
    eta_2: 0.0,
    eta_dot_2: 0.0,
    eta_3: 0.0,
    eta_dot_3: 0.0,
};
const RINGING: Flight = Flight {
    eta_1: 0.7,
    eta_dot_1: -6.0,
    ..RISING
};
const OMEGA: f64 = dcom::NOMINAL.omega_1;

/// DCOM in a vacuum: a point mass under gravity, and modes that swing by themselves without damping.
fn vacuum(spherical: bool) -> Model {
    Model::new(&dcom::Parameters {
        rho_0: 0.0,
        spherical_earth: f64::from(u8::from(spherical)),
        zeta_1: 0.0,
        zeta_2: 0.0,
        zeta_3: 0.0,
        ..dcom::NOMINAL
    })
}

/// Twice the energy of the first mode, η̇² + ω² η².
fn mode_energy(x: &Flight) -> f64 {
    x.eta_dot_1 * x.eta_dot_1 + OMEGA * OMEGA * x.eta_1 * x.eta_1
}

/// Relative change of the mode's energy over a second.
fn energy_change(steps: u32, step: fn(f64, &Model, &mut Flight) -> Outcome) -> f64 {
    let (model, mut x) = (vacuum(false), RINGING);
    for _ in 0..steps {
        step(1.0 / f64::from(steps), &model, &mut x).expect("a swing is finite");
    }
    mode_energy(&x) / mode_energy(&RINGING) - 1.0
}

#[test]
fn the_exponential_method_conserves_the_energy_of_a_mode_at_any_step() {
    for steps in [1, 3, 10, 1000] {
        let change = energy_change(steps, |dt, model, x| {
            let mode = FlexibleMode::new::<Model>("eta_1", "eta_dot_1", OMEGA, 0.0);
            Exponential::new(dt, [mode.expect("a good mode")]).step(model, x, &INPUT)
        });
        assert!(change.abs() < 2e-12, "{steps} steps: {change:e}");
    }
}

/// A step multiplies the energy by |R(iωh)|² with the stability function R of the method. Its series is 1 + (ωh)² for
/// Euler's, 1 + (ωh)⁴/4 for Heun's and 1 − (ωh)⁶/72 for the classical one.
#[test]
fn explicit_methods_change_the_energy_of_a_mode_as_their_stability_functions_say() {
    let euler = |steps| energy_change(steps, |dt, m, x| Euler::new(dt).step(m, x, &INPUT));
    let heun = |steps| energy_change(steps, |dt, m, x| Heun::new(dt).step(m, x, &INPUT));
    let rk4 = |steps| energy_change(steps, |dt, m, x| Rk4::new(dt).step(m, x, &INPUT));
    for steps in [1000, 4000] {
        let turn = OMEGA / f64::from(steps);
        for (change, growth) in [
            (euler(steps), turn.powi(2)),
            (heun(steps), turn.powi(4) / 4.0),
            (rk4(steps / 10), -(10.0 * turn).powi(6) / 720.0),
        ] {
            let expected = (f64::from(steps) * growth.ln_1p()).exp_m1();
            assert_relative_eq!(change, expected, max_relative = 1e-2);
        }
    }
}

/// |R(iy)|² is even in y: what a method of order 5 or 4 leaves over a step is of order 6, over a run of order 5.
#[test]
fn the_pairs_lose_the_energy_of_a_mode_at_their_order() {
    let order = |step: fn(f64, &Model, &mut Flight) -> Outcome| {
        let points = [181, 256, 362, 512, 724].map(|steps| {
            let change = energy_change(steps, step);
            (1.0 / f64::from(steps), change.abs())
        });
        println!("{points:?}");
        observed_order(&points)
    };
    for observed in [
        order(|dt, m, x| Fixed::new(DormandPrince54, dt).step(m, x, &INPUT)),
        order(|dt, m, x| Fixed::new(Tsit5, dt).step(m, x, &INPUT)),
        order(|dt, m, x| Fixed::new(Rodas4, dt).step(m, x, &INPUT)),
    ] {
        assert!((observed - 5.0).abs() < 0.2, "{observed}");
    }
}

/// What a point mass conserves: energy per mass V²/2 + Φ(h), and momentum V cos γ over flat ground, angular momentum
/// r V cos γ over a sphere, where gravity is g (R/r)².
fn invariants(x: &Flight, spherical: bool) -> [f64; 2] {
    let (g, radius) = (dcom::NOMINAL.g, dcom::NOMINAL.r_e);
    let r = radius + x.altitude;
    let level = x.velocity * x.gamma.cos();
    let kinetic = 0.5 * x.velocity * x.velocity;
    if spherical {
        // The potential from the ground, g R h / r: its differences do not cancel.
        [kinetic + g * radius * x.altitude / r, r * level]
    } else {
        [kinetic + g * x.altitude, level]
    }
}

#[test]
fn a_point_mass_conserves_energy_and_momentum() {
    for spherical in [false, true] {
        let model = vacuum(spherical);
        let input = Constant(INPUT);
        let mut absolute = Flight::splat(1e-10);
        (absolute.velocity, absolute.altitude) = (1e-7, 1e-7);
        let mut progress = Progress::new(0.0, RISING);
        Adaptive::new(DormandPrince54, 1e-12, absolute)
            .run(&Problem::new(&model, &input), &mut progress, 60.0, &mut ())
            .expect("a minute of flight");
        let end = progress.state;
        assert!(
            (end.altitude - RISING.altitude).abs() > 5e4,
            "it has to fly"
        );
        let pairs = invariants(&RISING, spherical)
            .into_iter()
            .zip(invariants(&end, spherical));
        for (before, after) in pairs {
            assert_relative_eq!(before, after, max_relative = 1e-11);
        }
        // No moment: the attitude θ = α + γ turns with the pitch rate, which stays.
        assert_eq!(end.pitch_rate, RISING.pitch_rate);
        let turned = end.alpha + end.gamma - RISING.alpha - RISING.gamma;
        assert_relative_eq!(turned, 60.0 * RISING.pitch_rate, max_relative = 1e-11);
    }
}

/// A parabola over flat ground, in closed form.
#[test]
fn a_point_mass_over_flat_ground_flies_a_parabola() {
    let (model, mut x) = (vacuum(false), RISING);
    for _ in 0..2000 {
        Rk4::new(0.01).step(&model, &mut x, &INPUT).expect("finite");
    }
    let (t, g) = (20.0, dcom::NOMINAL.g);
    let (level, up) = (
        RISING.velocity * RISING.gamma.cos(),
        RISING.velocity * RISING.gamma.sin(),
    );
    assert_relative_eq!(x.velocity, level.hypot(up - g * t), max_relative = 1e-12);
    assert_relative_eq!(x.gamma, (up - g * t).atan2(level), max_relative = 1e-11);
    let altitude = RISING.altitude + up * t - 0.5 * g * t * t;
    assert_relative_eq!(x.altitude, altitude, max_relative = 1e-12);
}

/// Without air γ → −γ turns a flight back in time: (V, h, −γ) flown forward is (V, h, γ) flown backward.
#[test]
fn without_air_a_flight_can_be_flown_back() {
    for spherical in [false, true] {
        let model = vacuum(spherical);
        let there_and_back = |steps: u32| {
            let mut x = RISING;
            let dt = 40.0 / f64::from(steps);
            for _ in 0..2 {
                for _ in 0..steps {
                    Rk4::new(dt).step(&model, &mut x, &INPUT).expect("finite");
                }
                x.gamma = -x.gamma;
            }
            let gap = (x.velocity / RISING.velocity - 1.0).abs()
                + (x.altitude / RISING.altitude - 1.0).abs()
                + (x.gamma - RISING.gamma).abs();
            (dt, gap)
        };
        let points = [16, 23, 32, 45, 64, 91].map(there_and_back);
        let observed = observed_order(&points);
        assert!(observed > 3.9, "order {observed}: {points:?}");
        assert!(there_and_back(2000).1 < 1e-12);
    }
}

/// Over flat ground with air whose density falls as exp(−h/h_s), a higher flight in denser air is the same flight.
#[test]
fn a_shift_in_altitude_is_a_change_of_density() {
    let shift = 3000.0;
    let p = dcom::NOMINAL;
    let flat = dcom::Parameters {
        spherical_earth: 0.0,
        ..p
    };
    let low = dcom::Model::new(&flat);
    let high = dcom::Model::new(&dcom::Parameters {
        h_0: p.h_0 + shift,
        ..flat
    });
    let mut x = RISING;
    let mut y = Flight {
        altitude: RISING.altitude + shift,
        ..RISING
    };
    let rates = low.drift(&x, &INPUT).to_array().into_iter();
    for (a, b) in rates.zip(high.drift(&y, &INPUT).to_array()) {
        assert_relative_eq!(a, b, max_relative = 1e-13);
    }
    for _ in 0..500 {
        Rk4::new(0.001).step(&low, &mut x, &INPUT).expect("finite");
        Rk4::new(0.001).step(&high, &mut y, &INPUT).expect("finite");
    }
    y.altitude -= shift;
    for (a, b) in x.to_array().into_iter().zip(y.to_array()) {
        assert_relative_eq!(a, b, max_relative = 1e-10, epsilon = 1e-12);
    }
}

/// A held input, and no time in the equations: two flights of half the time are one of the whole.
#[test]
fn a_flight_does_not_know_what_time_it_is() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let input = Constant(INPUT);
    let fly = |from: f64| {
        let mut progress = Progress::new(from, RISING);
        progress.step = Some(1.0 / 1024.0);
        Adaptive::new(Tsit5, 1e-8, Flight::splat(1e-8))
            .run(
                &Problem::new(&model, &input),
                &mut progress,
                from + 0.5,
                &mut (),
            )
            .expect("a short flight");
        progress.state
    };
    for (a, b) in fly(0.0).to_array().into_iter().zip(fly(1024.0).to_array()) {
        assert_relative_eq!(a, b, max_relative = 1e-9, epsilon = 1e-11);
    }
}
