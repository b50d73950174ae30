//! The example in C prints what the same flight gives in Rust, to every digit.
#![forbid(unsafe_code)]

use std::path::Path;
use std::process::Command;

use ahv_core::DifferentiableModel as _;
use ahv_integrate::Rk4;
use ahv_models::dcom::{Canard, Input, Model, NOMINAL, State};
use ahv_tests::c::{compile, write_library};

/// As `examples/c/fly.c` has it.
const DEG_PER_RAD: f64 = 57.295_779_513_082_32;

/// What `examples/c/fly.c` prints, by the Rust library.
fn flown() -> Vec<String> {
    let model = Model::new(&NOMINAL.with_canard(Canard::Free));
    let trim = State {
        velocity: 7702.0808,
        altitude: 85_000.0,
        gamma: 0.0,
        alpha: 0.026_210_5,
        pitch_rate: 0.0,
        eta_1: 0.627_554_7,
        eta_dot_1: 0.0,
        eta_2: -0.013_697_9,
        eta_dot_2: 0.0,
        eta_3: -0.037_191_4,
        eta_dot_3: 0.0,
    };
    let input = Input {
        phi: 0.282_090_6,
        delta_e: 0.228_647_8,
        delta_c: 0.0,
    };
    let (by_state, by_input) = model.jacobians(&trim, &input);
    let mut lines = vec![
        format!(
            "  dQ/dt by alpha   {:12.6} 1/s^2",
            by_state.pitch_rate.alpha
        ),
        format!(
            "  dQ/dt by delta_e {:12.6} 1/s^2",
            by_input.pitch_rate.delta_e
        ),
    ];
    let mut x = trim;
    x.alpha += 0.5 / DEG_PER_RAD;
    let stepper = Rk4::new(0.01);
    for step in 0..=1000 {
        if step % 100 == 0 {
            let [gamma, alpha, pitch_rate] =
                [x.gamma, x.alpha, x.pitch_rate].map(|it| it * DEG_PER_RAD);
            lines.push(format!(
                "{:6.2} {:12.6} {:13.6} {gamma:11.7} {alpha:11.7} {pitch_rate:11.7} {:11.8}",
                f64::from(step) * 0.01,
                x.velocity,
                x.altitude,
                x.eta_1
            ));
        }
        let feedback = (2.0 * (x.alpha - trim.alpha) + 1.0 * x.pitch_rate) + 0.5 * x.gamma;
        let u = Input {
            delta_e: input.delta_e + feedback,
            ..input
        };
        stepper.step(&model, &mut x, &u).expect("a step");
    }
    lines
}

#[test]
fn the_example_in_c_prints_the_flight_of_the_rust() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path());
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/c/fly.c");
    let library = ["dcom", "dcom_parameters", "ahv_elementary"];
    let mut sources = vec![example.to_string_lossy().into_owned()];
    sources.extend(library.map(|name| format!("src/{name}.c")));
    let binary = folder.path().join("fly");
    compile(folder.path(), &["-O2"], &sources, &binary);
    let output = Command::new(&binary).output().expect("the example runs");
    assert!(output.status.success());
    let printed = String::from_utf8(output.stdout).expect("text");
    let printed: Vec<&str> = printed.lines().collect();
    let flown = flown();
    assert_eq!(flown.len(), 13);
    for line in &flown {
        assert!(
            printed.contains(&line.as_str()),
            "no {line:?} in {printed:#?}"
        );
    }
    assert_eq!(printed.last(), flown.last().map(String::as_str).as_ref());
}
