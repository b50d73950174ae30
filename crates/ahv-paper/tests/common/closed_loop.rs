//! The tables of `docs/closed-loop.md`.

use ahv_analysis::linearize::linearize;
use ahv_analysis::lqr::deviations;
use ahv_analysis::ordered::Control;
use ahv_analysis::trim::{SteadyState, trim};
use ahv_core::{Bounds, GeneratedModel, Vector};
use ahv_integrate::WienerSource;
use ahv_models::dcom::{self, NOMINAL, Parameters, STATE_BOUNDS};
use ahv_models::sdcom;
use ahv_paper::backstepping::{Backstepping, DESIGN, Design, Loop};
use ahv_paper::track::{
    ACTUATORS, Controller, Flight, Increments, LoopState, Manoeuvre, PERIOD, SUBSTEPS, Trial,
    silent,
};
use nalgebra::DMatrix;

/// Flights of each measurement.
const FLIGHTS: u64 = 20;
/// Student's 97.5 % point for one degree of freedom less than flights.
const STUDENT: f64 = 2.093_024;
/// Samples between two that count, for the standard deviations of the errors.
const EVERY: usize = 25;
const LOOPS: [&str; 5] = ["V", "h", "γ", "α", "Q"];

/// All tables, in the order of the documentation.
pub(crate) fn tables() -> Vec<String> {
    let trial = Trial::standard(NOMINAL, FLIGHTS, 0);
    vec![
        experiment(&trial),
        boxes(),
        design(&trial),
        limits_of_gains(&trial),
        weights(),
        calm(&trial),
        observers(&trial),
        check(&trial),
    ]
}

fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: Vec<&str>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(head.to_vec());
    text.push_str(&format!("{}|\n", "|---".repeat(head.len())));
    for row in rows {
        text.push_str(&line(row.iter().map(String::as_str).collect()));
    }
    text
}

fn experiment(trial: &Trial) -> String {
    let Manoeuvre {
        start,
        velocity,
        altitude,
    } = trial.manoeuvre;
    let steps = |step: ahv_paper::track::Step, unit: &str| {
        format!(
            "{} {unit}, {} {unit} more at {start} s, triple pole −{} rad/s",
            step.from, step.change, step.bandwidth
        )
    };
    let actuator = |index: usize, unit: &str, shown: fn(f64) -> String| {
        let actuator = ACTUATORS[index];
        format!(
            "lag {} rad/s, rate at most {} {unit}, position {} to {}",
            actuator.bandwidth,
            actuator.rate,
            shown(actuator.bounds.min),
            shown(actuator.bounds.max)
        )
    };
    let (x, u) = at_trim(trial, &trial.backstepping());
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    table(
        &["what", "value"],
        &[
            row(
                "trim of DCOM",
                format!(
                    "α {:.4}°, φ {:.4}, δe {:.4}°",
                    x.alpha.to_degrees(),
                    u.phi,
                    u.delta_e.to_degrees()
                ),
            ),
            row("duration of a flight", format!("{} s", trial.duration)),
            row("V_c", steps(velocity, "ft/s")),
            row("h_c", steps(altitude, "ft")),
            row("sampling period T", format!("{} ms", PERIOD * 1e3)),
            row(
                "step of the truth",
                format!("{} ms", PERIOD * 1e3 / SUBSTEPS as f64),
            ),
            row(
                "actuator of φ",
                actuator(0, "1/s", |value| value.to_string()),
            ),
            row(
                "actuator of δe",
                actuator(1, "rad/s", |value| degrees(value) + "°"),
            ),
        ],
    )
}

fn degrees(value: f64) -> String {
    format!("{:.0}", value.to_degrees())
}

fn boxes() -> String {
    let row = |name: &str, bounds: Bounds, unit: &str| {
        let (least, largest) = (degrees(bounds.min), degrees(bounds.max));
        vec![name.to_owned(), format!("{least} to {largest} {unit}")]
    };
    table(
        &["virtual control", "kept within"],
        &[
            row("γ₀", STATE_BOUNDS.gamma, "deg"),
            row("α₀", STATE_BOUNDS.alpha, "deg"),
            row("Q₀", STATE_BOUNDS.pitch_rate, "deg/s"),
        ],
    )
}

fn design(trial: &Trial) -> String {
    let Design {
        velocity,
        altitude,
        gamma,
        alpha,
        pitch_rate,
        filters,
        observers,
        ..
    } = DESIGN;
    let loops: [Loop; 5] = [velocity, altitude, gamma, alpha, pitch_rate];
    let [of_gamma, of_alpha, of_pitch_rate] = filters.map(|pole| pole.to_string());
    let [l_v, l_gamma, l_q] = observers.map(|bandwidth| bandwidth.to_string());
    let none = String::new;
    let filters = [none(), none(), of_gamma, of_alpha, of_pitch_rate];
    let observers = [l_v, none(), l_gamma, none(), l_q];
    let units = ["ft/s", "ft", "rad", "rad", "rad/s"];
    let added = added_by_noise(trial);
    let deviations = deviations_of_errors(trial);
    let rows: Vec<_> = (0..5)
        .map(|index| {
            let Loop { decay, scale } = loops[index];
            vec![
                LOOPS[index].to_owned(),
                decay.to_string(),
                format!("{scale} {}", units[index]),
                format!("{:.1}", scale / deviations[index]),
                format!("{:.4}", added[index]),
                filters[index].clone(),
                observers[index].clone(),
            ]
        })
        .collect();
    table(
        &[
            "loop",
            "c [1/s]",
            "r",
            "r / σ_z",
            "n [1/s]",
            "filter ω [rad/s]",
            "observer l [1/s]",
        ],
        &rows,
    )
}

/// Rightmost pole of SDCOM at its trim and rightmost zero from φ, δe to V, γ, in 1/s.
pub(crate) fn unstable(trial: &Trial) -> [f64; 2] {
    let model = sdcom::Model::new(&trial.believed);
    let level = SteadyState::new(&sdcom::Model::TRIM)
        .with("velocity", trial.manoeuvre.velocity.from)
        .with("altitude", trial.manoeuvre.altitude.from);
    let at = trim(&model, &level).expect("a trim");
    let system = linearize(&model, &at.state, &at.input, &["phi", "delta_e"], &[]).expect("finite");
    let outputs = DMatrix::from_fn(2, system.a.nrows(), |row, column| {
        f64::from(u8::from(column == [0, 2][row]))
    });
    // C B is regular: held outputs leave the inputs −(C B)⁻¹ C A x.
    let held = (&outputs * &system.b).try_inverse().expect("regular") * &outputs * &system.a;
    let without = &system.a - &system.b * held;
    [system.a, without].map(|matrix| {
        let parts = matrix.complex_eigenvalues();
        parts
            .iter()
            .map(|root| root.re)
            .fold(f64::NEG_INFINITY, f64::max)
    })
}

fn limits_of_gains(trial: &Trial) -> String {
    let [pole, zero] = unstable(trial);
    table(
        &["SDCOM at its trim", "1/s"],
        &[
            vec![
                "unstable pole, of the short period".to_owned(),
                format!("{pole:.3}"),
            ],
            vec![
                "unstable zero, from φ, δe to V, γ".to_owned(),
                format!("{zero:.3}"),
            ],
        ],
    )
}

/// n of the loops at the trim, in 1/s.
fn added_by_noise(trial: &Trial) -> [f64; 5] {
    let controller = trial.backstepping();
    let (x, u) = at_trim(trial, &controller);
    let noisy = controller.decays(&x, &u);
    let calm = Backstepping::new(DESIGN, &silent(NOMINAL)).decays(&x, &u);
    std::array::from_fn(|index| noisy[index] - calm[index])
}

fn at_trim(trial: &Trial, controller: &Backstepping) -> (sdcom::State<f64>, sdcom::Input<f64>) {
    let model = dcom::Model::new(&trial.truth);
    let (_, rest) = trial.closed(&model, controller).expect("a trim");
    let x = sdcom::State {
        velocity: rest.state.velocity,
        altitude: rest.state.altitude,
        gamma: rest.state.gamma,
        alpha: rest.state.alpha,
        pitch_rate: rest.state.pitch_rate,
        ..sdcom::State::splat(0.0)
    };
    (x, rest.input.to_array().into())
}

/// Standard deviations of z of the loops, over the flights, root mean square over time.
fn deviations_of_errors(trial: &Trial) -> [f64; 5] {
    let flights: Vec<_> = (0..FLIGHTS).map(|member| errors(trial, member)).collect();
    let records = flights[0].len();
    let count = flights.len() as f64;
    std::array::from_fn(|index| {
        let variances = (0..records).map(|record| {
            let values = || flights.iter().map(|flight| flight[record][index]);
            let mean = values().sum::<f64>() / count;
            values().map(|z| (z - mean).powi(2)).sum::<f64>() / (count - 1.0)
        });
        (variances.sum::<f64>() / records as f64).sqrt()
    })
}

/// z of the loops over a flight.
fn errors(trial: &Trial, member: u64) -> Vec<[f64; 5]> {
    let controller = trial.backstepping();
    let model = dcom::Model::new(&trial.truth);
    let (closed, mut at) = trial.closed(&model, &controller).expect("a trim");
    let mut wiener = WienerSource::<{ dcom::Noise::<()>::LEN }>::new(trial.seed, member);
    let mut errors = Vec::new();
    for period in 0..(trial.duration / PERIOD).round() as u64 {
        let time = period as f64 * PERIOD;
        if (period as usize).is_multiple_of(EVERY) {
            errors.push(errors_at(&at, trial, time));
        }
        let noise =
            |substep, dt| -> Increments { wiener.increments(period * SUBSTEPS + substep, dt) };
        closed.advance(&mut at, time, noise).expect("finite");
    }
    errors
}

fn errors_at<M: AsRef<[f64]>>(at: &LoopState<M>, trial: &Trial, time: f64) -> [f64; 5] {
    let reference = trial.manoeuvre.at(time);
    let memory = at.memory.as_ref();
    let x = &at.state;
    [
        x.velocity - reference.velocity,
        x.altitude - reference.altitude,
        x.gamma - memory[0],
        x.alpha - memory[2],
        x.pitch_rate - memory[4],
    ]
}

fn weights() -> String {
    let by_state = deviations::<sdcom::State<f64>>(sdcom::Model::DEVIATIONS);
    let by_input = deviations::<sdcom::Input<f64>>(sdcom::Model::DEVIATIONS);
    let row = |name: &str, value: f64, unit: &str| {
        vec![
            name.to_owned(),
            format!("{value} {unit}").trim_end().to_owned(),
        ]
    };
    assert!(by_state.chi_1.is_infinite() && by_state.chi_3.is_infinite());
    table(
        &["state or input", "deviation that costs 1"],
        &[
            row("V", by_state.velocity, "ft/s"),
            row("h", by_state.altitude, "ft"),
            row("γ", by_state.gamma, "rad"),
            row("α", by_state.alpha, "rad"),
            row("Q", by_state.pitch_rate, "rad/s"),
            row("φ", by_input.phi, ""),
            row("δe", by_input.delta_e, "rad"),
        ],
    )
}

fn flown<C: Controller>(trial: &Trial, controller: &C) -> Vec<Flight> {
    trial.fly(controller, &Control::default()).expect("a trim")
}

/// One flight without noise. The controller knows the noise that the vehicle does not have here.
fn quiet(trial: &Trial) -> Trial {
    Trial {
        truth: silent(trial.truth),
        runs: 1,
        ..*trial
    }
}

/// The errors of one flight without noise.
fn calm(trial: &Trial) -> String {
    let trial = quiet(trial);
    let row = |name: &str, flights: Vec<Flight>| {
        let [velocity, altitude, gamma] = flights[0].errors.map(|error| error.rms);
        vec![
            name.to_owned(),
            format!("{velocity:.3}"),
            format!("{altitude:.3}"),
            format!("{:.4}", gamma.to_degrees()),
        ]
    };
    let linear = trial.linear().expect("a regulator");
    table(
        &[
            "without noise",
            "V − V_c, rms [ft/s]",
            "h − h_c, rms [ft]",
            "γ − γ_r, rms [deg]",
        ],
        &[
            row("backstepping", flown(&trial, &trial.backstepping())),
            row("LQR", flown(&trial, &linear)),
        ],
    )
}

/// What the observers do, on the vehicle that the controller knows and on one with other coefficients.
fn observers(trial: &Trial) -> String {
    let other = Parameters {
        c_d_0: 1.15 * NOMINAL.c_d_0,
        c_l_alpha: 0.9 * NOMINAL.c_l_alpha,
        ..NOMINAL
    };
    let vehicles = [
        ("as the controller knows it", NOMINAL),
        ("C_D⁰ 15 % more, C_L^α 10 % less", other),
    ];
    let mut rows = Vec::new();
    for (name, truth) in vehicles {
        let trial = Trial { truth, ..*trial };
        let blind = Design {
            observers: [0.0; 3],
            ..DESIGN
        };
        let with = flown(&trial, &trial.backstepping());
        let without = flown(&trial, &Backstepping::new(blind, &trial.believed));
        for (index, (figure, unit)) in [("V − V_c", "ft/s"), ("h − h_c", "ft")].iter().enumerate()
        {
            let sizes = |flights: &[Flight]| -> Vec<f64> {
                flights
                    .iter()
                    .map(|flight| flight.errors[index].rms)
                    .collect()
            };
            let (with, without) = (sizes(&with), sizes(&without));
            let differences: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
            rows.push(vec![
                name.to_owned(),
                format!("{figure}, rms [{unit}]"),
                format!("{:.4}", mean(&with)),
                format!("{:.4}", mean(&without)),
                interval(&differences),
            ]);
        }
    }
    table(
        &[
            "vehicle",
            "error",
            "with observers",
            "without",
            "difference and its interval of 95 %",
        ],
        &rows,
    )
}

/// States and actuators of the flight without noise, for a program that does the same.
fn check(trial: &Trial) -> String {
    let trial = quiet(trial);
    let flight = &flown(&trial, &trial.backstepping())[0];
    let rows: Vec<_> = flight
        .samples
        .iter()
        .filter(|sample| sample.time % 15.0 == 0.0)
        .map(|sample| {
            let (x, u) = (&sample.state, &sample.input);
            let angles = [x.gamma, x.alpha, x.pitch_rate, u.delta_e];
            let [gamma, alpha, pitch_rate, delta_e] =
                angles.map(|angle| format!("{:.6}", angle.to_degrees()));
            vec![
                format!("{:.0}", sample.time),
                format!("{:.5}", x.velocity),
                format!("{:.4}", x.altitude),
                gamma,
                alpha,
                pitch_rate,
                format!("{:.6}", u.phi),
                delta_e,
            ]
        })
        .collect();
    table(
        &[
            "t [s]",
            "V [ft/s]",
            "h [ft]",
            "γ [deg]",
            "α [deg]",
            "Q [deg/s]",
            "φ",
            "δe [deg]",
        ],
        &rows,
    )
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The mean with its interval, by Student's distribution.
fn interval(values: &[f64]) -> String {
    let (count, mean) = (values.len() as f64, mean(values));
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let half = STUDENT * (variance / count).sqrt();
    format!("{mean:.4} [{:.4}, {:.4}]", mean - half, mean + half)
}
