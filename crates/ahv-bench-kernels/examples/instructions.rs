//! `instructions NAME COUNT` makes COUNT calls of one function or stepper, for valgrind to count; `instructions` lists the
//! names. What comes before the calls costs the same for every COUNT, so that it falls out of differences.

use std::env;
use std::hint::black_box;
use std::process::ExitCode;

use ahv_integrate::{ItoEulerMaruyama, Rk4};
use ahv_models::{dcom, sdcom};

/// Makes as many calls.
type Calls = fn(u32);

/// What is counted. An entry more is a figure more in instructions.json.
const COUNTED: [(&str, Calls); 6] = [
    ("dcom::drift", |count| {
        let (p, x, u) = (dcom::prepare(&dcom::NOMINAL), DCOM, DCOM_INPUT);
        calls(count, || dcom::drift(see(&x), see(&u), see(&p)));
    }),
    ("dcom::drift_and_jacobians", |count| {
        let (p, x, u) = (dcom::prepare(&dcom::NOMINAL), DCOM, DCOM_INPUT);
        calls(count, || {
            dcom::drift_and_jacobians(see(&x), see(&u), see(&p))
        });
    }),
    ("sdcom::drift_and_diffusion", |count| {
        let (p, x, u) = (sdcom::prepare(&sdcom::NOMINAL), SDCOM, SDCOM_INPUT);
        calls(count, || {
            sdcom::drift_and_diffusion(see(&x), see(&u), see(&p))
        });
    }),
    ("sdcom::noise_increment", |count| {
        let (p, x, u) = (sdcom::prepare(&sdcom::NOMINAL), SDCOM, SDCOM_INPUT);
        calls(count, || {
            sdcom::noise_increment(see(&x), see(&u), see(&p), see(&NOISE))
        });
    }),
    ("dcom, Rk4::step", |count| {
        let (model, stepper) = (dcom::Model::new(&dcom::NOMINAL), Rk4::new(DT));
        calls(count, || {
            let mut x = *see(&DCOM);
            let stepped = stepper.step(see(&model), &mut x, see(&DCOM_INPUT));
            see(&x);
            stepped
        });
    }),
    ("sdcom, ItoEulerMaruyama::step", |count| {
        let model = sdcom::Model::new(&sdcom::NOMINAL);
        let stepper = ItoEulerMaruyama::new(DT);
        calls(count, || {
            let mut x = *see(&SDCOM);
            let stepped = stepper.step(see(&model), &mut x, see(&SDCOM_INPUT), see(&NOISE));
            see(&x);
            stepped
        });
    }),
];

/// Step size in s.
const DT: f64 = 1e-3;
/// Near the trim, with ringing modes.
const DCOM: dcom::State<f64> = dcom::State {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.002,
    alpha: 0.0262,
    pitch_rate: 0.01,
    eta_1: 0.5,
    eta_dot_1: 0.0,
    eta_2: -0.8,
    eta_dot_2: 20.0,
    eta_3: 0.6,
    eta_dot_3: 0.0,
};
const DCOM_INPUT: dcom::Input<f64> = dcom::Input {
    phi: 0.2821,
    delta_e: 0.2286,
    delta_c: 0.0,
};
const SDCOM: sdcom::State<f64> = sdcom::State {
    velocity: DCOM.velocity,
    altitude: DCOM.altitude,
    gamma: DCOM.gamma,
    alpha: DCOM.alpha,
    pitch_rate: DCOM.pitch_rate,
    chi_1: 0.1,
    chi_2: -0.2,
    chi_3: 0.3,
};
const SDCOM_INPUT: sdcom::Input<f64> = sdcom::Input {
    phi: DCOM_INPUT.phi,
    delta_e: DCOM_INPUT.delta_e,
    delta_c: DCOM_INPUT.delta_c,
};
/// Wiener increments, in s^½.
const NOISE: sdcom::Noise<f64> = sdcom::Noise {
    w_gamma: 0.01,
    w_alpha: -0.02,
    w_q: 0.03,
    xi_1: -0.01,
    xi_2: 0.02,
    xi_3: -0.03,
};

/// The value as if it were another at each call.
fn see<T>(value: &T) -> &T {
    black_box(value)
}

/// Calls, whose results nobody may leave out.
fn calls<T>(count: u32, call: impl Fn() -> T) {
    for _ in 0..count {
        black_box(&call());
    }
}

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let [name, count] = &words[..] else {
        for (name, _) in COUNTED {
            println!("{name}");
        }
        return ExitCode::SUCCESS;
    };
    let run = COUNTED.iter().find(|(known, _)| known == name);
    match (run, count.parse()) {
        (Some((_, run)), Ok(count)) => {
            run(count);
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("error: no calls \"{name}\" \"{count}\"");
            ExitCode::FAILURE
        }
    }
}
