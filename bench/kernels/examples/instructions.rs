//! `instructions NAME COUNT` makes COUNT calls of one function or stepper, for valgrind to count; `instructions` lists the
//! names. What comes before the calls costs the same for every COUNT, so that it falls out of differences.

use std::env;
use std::hint::black_box;
use std::marker::PhantomData;
use std::process::ExitCode;

use ahv_bench_kernels::lanes::{
    DcomDrift, DcomDriftJacobians, DcomRk4, Packed, Pair, SdcomDriftDiffusion, Side,
};
use ahv_core::Branchless;
use ahv_integrate::{ItoEulerMaruyama, Rk4};
use ahv_models::{dcom, sdcom};
use pulp::WithSimd;

/// Makes as many calls.
type Calls = fn(u32);

/// Evaluates as many times, a multiple of [`BLOCKS`], for all lanes.
macro_rules! lanes {
    ($count:ident, $call:ident<$scalar:ty>, $module:ident, $results:ty, $x:expr, $u:expr) => {
        let model = $module::Model::new(&$module::NOMINAL).map_ref(packed);
        let (states, inputs) = ([$x.map_ref(packed); BLOCKS], [$u.map_ref(packed); BLOCKS]);
        let mut results = <$results as Side>::empty();
        for _ in 0..$count as usize / BLOCKS {
            with_avx2($call::<$scalar> {
                model: see(&model),
                states: see(&states),
                inputs: see(&inputs),
                results: &mut results,
                scalar: PhantomData,
            });
            see(&results);
        }
    };
}

/// What is counted. An entry more is a figure more in instructions.json.
const COUNTED: [(&str, Calls); 10] = [
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
    ("dcom::drift, 8 lanes, AVX2", |count| {
        lanes!(
            count,
            DcomDrift<Pair>,
            dcom,
            dcom::State<Pair>,
            DCOM,
            DCOM_INPUT
        );
    }),
    ("dcom::drift_and_jacobians, 8 lanes, AVX2", |count| {
        lanes!(
            count,
            DcomDriftJacobians<R>,
            dcom,
            (dcom::State<R>, [R; 48], [R; 18]),
            DCOM,
            DCOM_INPUT
        );
    }),
    ("sdcom::drift_and_diffusion, 8 lanes, AVX2", |count| {
        lanes!(
            count,
            SdcomDriftDiffusion<R>,
            sdcom,
            (sdcom::State<R>, sdcom::Diffusion<R>),
            SDCOM,
            SDCOM_INPUT
        );
    }),
    ("dcom, Rk4::step, 8 lanes, AVX2", |count| {
        with_avx2(DcomRk4::<R> {
            model: &dcom::Model::new(&dcom::NOMINAL).map_ref(packed),
            state: &mut DCOM.map_ref(packed),
            input: &DCOM_INPUT.map_ref(packed),
            dt: DT,
            steps: count as usize,
            scalar: PhantomData,
        });
    }),
];

/// Members in lanes that one call evaluates, one block after the other.
const BLOCKS: usize = 100;

/// The scalar of the lanes of long functions.
type R = Branchless<f64>;

fn packed(value: &f64) -> Packed {
    Packed::splat(*value)
}

/// Runs what is done for members side by side as most machines do; on others nothing.
fn with_avx2(work: impl WithSimd) {
    #[cfg(target_arch = "x86_64")]
    if let Some(machine) = pulp::x86::V3::try_new() {
        pulp::Simd::vectorize(machine, work);
    }
    #[cfg(not(target_arch = "x86_64"))]
    drop(work);
}

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
fn see<T: ?Sized>(value: &T) -> &T {
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
