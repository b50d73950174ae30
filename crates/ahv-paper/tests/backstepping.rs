//! Backstepping: what (C9) and (C10) say of its decays and of its margin.
#![forbid(unsafe_code)]

use ahv_analysis::ordered::Control;
use ahv_analysis::trim::{SteadyState, trim};
use ahv_core::{ColouredNoise, GeneratedModel, Vector};
use ahv_models::dcom::{NOMINAL, Parameters};
use ahv_models::sdcom::{self, Input, State};
use ahv_paper::backstepping::{Backstepping, DESIGN, Design, Loop};
use ahv_paper::track::{Trial, silent};
use approx::assert_relative_eq;

/// Where the standard manoeuvre starts.
fn start() -> (State<f64>, Input<f64>) {
    let flight = Trial::standard(silent(NOMINAL), 1, 0).manoeuvre;
    let flight = SteadyState::new(&sdcom::Model::TRIM)
        .with("velocity", flight.velocity.from)
        .with("altitude", flight.altitude.from);
    let at = trim(&sdcom::Model::new(&NOMINAL), &flight).expect("a trim");
    (at.state, at.input)
}

fn loops(design: &Design) -> [Loop; 5] {
    [
        design.velocity,
        design.altitude,
        design.gamma,
        design.alpha,
        design.pitch_rate,
    ]
}

#[test]
fn the_lyapunov_function_decays_along_the_manoeuvre() {
    let trial = Trial::standard(silent(NOMINAL), 1, 0);
    let controller = Backstepping::new(DESIGN, &NOMINAL);
    for sample in &trial.fly(&controller, &Control::default()).expect("a trim")[0].samples {
        let x = sdcom::State {
            velocity: sample.state.velocity,
            altitude: sample.state.altitude,
            gamma: sample.state.gamma,
            alpha: sample.state.alpha,
            pitch_rate: sample.state.pitch_rate,
            ..sdcom::State::splat(0.0)
        };
        let u = sample.input.to_array().into();
        assert!(controller.margin(&x, &u) > 0.02, "{}", sample.time);
    }
}

/// (C10): each loop loses 3/4 of the gain into it from the next and 1/4 of the gain from it into the one before.
#[test]
fn the_weakest_loop_is_the_margin() {
    let (x, u) = start();
    let r = loops(&DESIGN).map(|of| of.scale);
    let p = sdcom::Model::new(&NOMINAL).prepared;
    let into = [
        x.velocity * r[2] / r[1],
        sdcom::g_gamma(&x, &u, &p) * r[3] / r[2],
        sdcom::g_alpha(&x, &u, &p) * r[4] / r[3],
    ];
    let losses = [
        0.0,
        0.75 * into[0],
        0.75 * into[1] + 0.25 * into[0],
        0.75 * into[2] + 0.25 * into[1],
        0.25 * into[2],
    ];
    for (weakest, loss) in losses.into_iter().enumerate() {
        let mut design = DESIGN;
        let loops = [
            &mut design.velocity,
            &mut design.altitude,
            &mut design.gamma,
            &mut design.alpha,
            &mut design.pitch_rate,
        ];
        for (index, of) in loops.into_iter().enumerate() {
            of.decay = if index == weakest { 7.0 } else { 1e3 };
        }
        let margin = Backstepping::new(design, &silent(NOMINAL)).margin(&x, &u);
        assert_relative_eq!(margin, 7.0 - loss, max_relative = 1e-12);
    }
}

/// What the noise of these parameters adds to the decays, in 1/s.
fn additions(parameters: Parameters<f64>) -> [f64; 5] {
    let (x, u) = start();
    let decays = Backstepping::new(DESIGN, &parameters).decays(&x, &u);
    std::array::from_fn(|index| decays[index] - loops(&DESIGN)[index].decay)
}

/// (C9): 3/4 of |G|^4/(c r^4) and of the disturbance's standard deviation over r. White noise G leaves an observer of
/// bandwidth l an error of the variance l |G|²/2; that of γ stands in the loop of α too.
#[test]
fn decays_grow_with_white_noise() {
    assert_eq!(additions(silent(NOMINAL)), [0.0; 5]);
    let (x, u) = start();
    let parameters = Parameters {
        w_gamma: 0.03,
        w_alpha: 0.01,
        w_q: 2e-4,
        ..silent(NOMINAL)
    };
    let p = sdcom::Model::new(&parameters).prepared;
    let white = [
        sdcom::H_V(&x, &u, &p) * 0.01,
        x.velocity * 0.03,
        sdcom::H_gamma(&x, &u, &p) * 0.01,
        (sdcom::H_alpha(&x, &u, &p) * 0.01).hypot(2e-4),
        sdcom::H_Q(&x, &u, &p) * 0.01,
    ];
    let [l_v, l_gamma, l_q] = DESIGN.observers;
    let disturbances = [
        (l_v / 2.0).sqrt() * white[0],
        0.0,
        (l_gamma / 2.0).sqrt() * white[2],
        (l_gamma / 2.0).sqrt() * white[2],
        (l_q / 2.0).sqrt() * white[4],
    ];
    let found = additions(parameters);
    for (index, of) in loops(&DESIGN).into_iter().enumerate() {
        let fourth = (white[index] / of.scale).powi(4) / of.decay;
        let expected = 0.75 * (fourth + disturbances[index].abs() / of.scale);
        assert!(expected > 0.0);
        assert_relative_eq!(found[index], expected, max_relative = 1e-9);
    }
}

/// Coloured noise alone: 3/4 of the stationary standard deviation of h χ over r, for dχ = −a χ dt + b dW with b²/(2a).
#[test]
fn decays_grow_with_coloured_noise() {
    let (x, u) = start();
    for mode in 0..3 {
        let mut parameters = silent(NOMINAL);
        let intensities = [
            &mut parameters.sigma_1,
            &mut parameters.sigma_2,
            &mut parameters.sigma_3,
        ];
        for (index, intensity) in intensities.into_iter().enumerate() {
            *intensity = if index == mode { 17.0 } else { 0.0 };
        }
        let model = sdcom::Model::new(&parameters);
        let p = model.prepared;
        let state = State::<f64>::LEN - 3 + mode;
        let decay = model.decay(state).expect("coloured noise");
        let row = sdcom::diffusion(&x, &u, &p).get(state).expect("a row");
        let strength: f64 = row.to_array().iter().map(|b| b * b).sum();
        let deviation = (strength / (2.0 * decay)).sqrt();
        let shares = [
            sdcom::h_V(&x, &u, &p)[mode],
            0.0,
            sdcom::h_gamma(&x, &u, &p)[mode],
            sdcom::h_alpha(&x, &u, &p)[mode],
            sdcom::h_Q(&x, &u, &p)[mode],
        ];
        let found = additions(parameters);
        for (index, of) in loops(&DESIGN).into_iter().enumerate() {
            let expected = 0.75 * (shares[index] * deviation).abs() / of.scale;
            assert_relative_eq!(found[index], expected, max_relative = 1e-9, epsilon = 1e-13);
        }
        assert!(found[0] > 1e-6 && found[2] > 1e-6 && found[4] > 1e-6);
    }
}
