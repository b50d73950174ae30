//! Closed loops: stability of the result, and what would break it.
#![forbid(unsafe_code)]

#[path = "common/closed_loop.rs"]
mod closed_loop;

use ahv_analysis::ordered::Control;
use ahv_core::{DifferentiableModel, Vector};
use ahv_models::dcom::{self, NOMINAL, Parameters};
use ahv_models::sdcom;
use ahv_paper::backstepping::{Backstepping, DESIGN, Design};
use ahv_paper::track::{
    ACTUATORS, Controller, Flight, Increments, LinearTracker, LoopState, Manoeuvre, PERIOD, Sample,
    Statistics, Trial, bands, silent,
};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{Complex, ComplexField, DMatrix, DVector};

/// One flight without noise of a vehicle with the parameters `truth`, by controllers that believe in the table.
fn calm(truth: Parameters<f64>) -> Trial {
    let trial = Trial::standard(silent(NOMINAL), 1, 0);
    Trial {
        truth: silent(truth),
        ..trial
    }
}

/// A member's errors at its end: V in ft/s, h in ft, γ in rad.
fn final_errors(flight: &Flight) -> [f64; 3] {
    assert_eq!(flight.lost, None);
    let last = flight.samples.last().expect("records");
    [
        last.state.velocity - last.reference.velocity,
        last.state.altitude - last.reference.altitude,
        last.state.gamma - last.reference.gamma(),
    ]
}

/// Poles where the loop comes to rest.
fn poles<C: Controller>(trial: &Trial, controller: &C, settling: u64) -> Vec<Complex<f64>> {
    let model = dcom::Model::new(&trial.truth);
    let (closed, mut rest) = trial.closed(&model, controller).expect("a trim");
    for _ in 0..settling {
        advance(&closed, &mut rest);
    }
    closed.poles(&rest).expect("finite")
}

fn advance<C: Controller>(
    closed: &ahv_paper::track::ClosedLoop<'_, C>,
    at: &mut LoopState<C::Memory>,
) {
    closed
        .advance(at, 0.0, |_, _| Increments::splat(0.0))
        .expect("finite");
}

#[test]
fn without_noise_the_errors_vanish() {
    let trial = calm(NOMINAL);
    let flights = trial
        .fly(&trial.backstepping(), &Control::default())
        .expect("a trim");
    let [velocity, altitude, gamma] = final_errors(&flights[0]);
    assert_abs_diff_eq!(velocity, 0.0, epsilon = 0.01);
    assert_abs_diff_eq!(altitude, 0.0, epsilon = 0.5);
    assert_abs_diff_eq!(gamma.to_degrees(), 0.0, epsilon = 1e-3);
    let [velocity, altitude, gamma] = flights[0].errors.map(|size| size.max);
    assert!(velocity < 0.5 && altitude < 20.0 && gamma.to_degrees() < 0.1);
    // The regulator has no integral action, and its linearisation is that of the start.
    let flights = trial
        .fly(&trial.linear().expect("a regulator"), &Control::default())
        .expect("a trim");
    let [velocity, altitude, gamma] = final_errors(&flights[0]);
    assert_abs_diff_eq!(velocity, 0.0, epsilon = 1.0);
    assert_abs_diff_eq!(altitude, 0.0, epsilon = 10.0);
    assert_abs_diff_eq!(gamma.to_degrees(), 0.0, epsilon = 1e-2);
}

/// Errors count every period, 25 between two records.
#[test]
fn the_errors_of_a_flight_are_those_of_its_records() {
    let trial = calm(NOMINAL);
    let flight = &trial
        .fly(&trial.backstepping(), &Control::default())
        .expect("a trim")[0];
    let of_samples = |index: usize| {
        flight.samples.iter().map(
            move |Sample {
                      state, reference, ..
                  }| {
                let errors = [
                    state.velocity - reference.velocity,
                    state.altitude - reference.altitude,
                    state.gamma - reference.gamma(),
                ];
                errors[index].abs()
            },
        )
    };
    for (index, size) in flight.errors.iter().enumerate() {
        let largest = of_samples(index).fold(0.0, f64::max);
        assert!(largest > 0.0 && size.max >= largest);
        assert_relative_eq!(size.max, largest, max_relative = 0.05);
        let count = flight.samples.len() as f64;
        let squares: f64 = of_samples(index).map(|error| error * error).sum();
        assert_relative_eq!(size.rms, (squares / count).sqrt(), max_relative = 0.02);
    }
}

#[test]
fn with_noise_no_flight_leaves_the_validity_box() {
    let trial = Trial {
        duration: 15.0,
        ..Trial::standard(NOMINAL, 8, 7)
    };
    let linear = trial.linear().expect("a regulator");
    for flights in [
        trial.fly(&trial.backstepping(), &Control::default()),
        trial.fly(&linear, &Control::default()),
    ] {
        let flights = flights.expect("a trim");
        let statistics = Statistics::of(&flights).expect("flights");
        assert_eq!(statistics.runs, 8);
        assert_eq!(statistics.lost.flights, 0);
        assert_eq!(statistics.left_validity_box.flights, 0);
        assert!(flights.iter().all(|flight| flight.errors[1].max < 60.0));
        // The noise acts: no two members are alike.
        assert!(flights[0].errors[1].rms != flights[1].errors[1].rms);
    }
}

/// A flight that was lost stands in the bands up to its last record.
#[test]
fn bands_are_of_the_flights_that_still_fly() {
    let trial = Trial {
        duration: 0.5,
        ..Trial::standard(NOMINAL, 3, 7)
    };
    let flights = trial.fly(&trial.backstepping(), &Control::default());
    let mut flights = flights.expect("a trim");
    flights[0].samples.truncate(1);
    let bands = bands(&flights, |sample| sample.state.gamma);
    let flying: Vec<_> = bands.iter().map(|band| (band.time, band.flying)).collect();
    assert_eq!(flying, [(0.0, 3), (0.25, 2), (0.5, 2)]);
    // The median of two numbers is their mean.
    let [a, b] = [1, 2].map(|flight: usize| flights[flight].samples[2].state.gamma);
    assert_relative_eq!(bands[2].spread.value, 0.5 * (a + b), max_relative = 1e-12);
}

#[test]
fn the_trim_is_a_rest_point_with_poles_in_the_left_half_plane() {
    let trial = calm(NOMINAL);
    let model = dcom::Model::new(&trial.truth);
    let controller = trial.backstepping();
    let (closed, start) = trial.closed(&model, &controller).expect("a trim");
    let mut at = start;
    for _ in 0..100 {
        advance(&closed, &mut at);
    }
    let moved = at.state.zip_with(start.state, |a, b| (a - b).abs());
    assert!(
        moved.velocity < 1e-6 && moved.altitude < 1e-6 && moved.alpha < 1e-9,
        "{moved:?}"
    );
    let backstepping = closed.poles(&start).expect("finite");
    let linear = poles(&trial, &trial.linear().expect("a regulator"), 0);
    // Vehicle, actuators, memory.
    assert_eq!((backstepping.len(), linear.len()), (11 + 2 + 10, 11 + 2));
    assert!(backstepping[0].re < -0.1, "{}", backstepping[0]);
    assert!(linear[0].re < -0.2, "{}", linear[0]);
}

#[test]
fn coefficients_may_be_wrong() {
    let scaled: [fn(&mut Parameters<f64>) -> &mut f64; 5] = [
        |p| &mut p.c_l_alpha,
        |p| &mut p.c_m_alpha,
        |p| &mut p.c_m_delta_e,
        |p| &mut p.c_t_phi,
        |p| &mut p.c_d_0,
    ];
    for coefficient in scaled {
        for factor in [0.85, 1.15] {
            let mut truth = NOMINAL;
            *coefficient(&mut truth) *= factor;
            let trial = calm(truth);
            let controller = trial.backstepping();
            let rightmost = poles(&trial, &controller, 4000)[0];
            assert!(rightmost.re < -0.05, "{factor}: {rightmost}");
        }
    }
    // The observers take constant errors of the model away.
    let trial = calm(Parameters {
        c_d_0: 1.15 * NOMINAL.c_d_0,
        c_l_alpha: 0.9 * NOMINAL.c_l_alpha,
        ..NOMINAL
    });
    let flights = trial
        .fly(&trial.backstepping(), &Control::default())
        .expect("a trim");
    let [velocity, altitude, _] = final_errors(&flights[0]);
    assert_abs_diff_eq!(velocity, 0.0, epsilon = 0.05);
    assert_abs_diff_eq!(altitude, 0.0, epsilon = 1.0);
}

#[test]
fn a_wrong_sign_of_a_gain_shows() {
    for (wrong, what) in [
        (
            Parameters {
                c_m_delta_e: -NOMINAL.c_m_delta_e,
                ..NOMINAL
            },
            "g_Q",
        ),
        (
            Parameters {
                c_t_phi: -NOMINAL.c_t_phi,
                ..NOMINAL
            },
            "g_V",
        ),
        (
            Parameters {
                c_l_alpha: -NOMINAL.c_l_alpha,
                ..NOMINAL
            },
            "g_gamma",
        ),
    ] {
        let trial = Trial {
            believed: wrong,
            duration: 20.0,
            ..Trial::standard(silent(NOMINAL), 1, 0)
        };
        let controller = trial.backstepping();
        assert!(poles(&trial, &controller, 0)[0].re > 0.0, "{what}");
        let flights = trial.fly(&controller, &Control::default()).expect("a trim");
        assert!(
            flights[0].departure.is_some() || flights[0].errors[0].max > 20.0,
            "{what}"
        );
    }
}

#[test]
fn cancelling_the_elevators_present_lift_would_destabilise() {
    let trial = calm(NOMINAL);
    let design = Design {
        elevator: 100.0,
        ..DESIGN
    };
    let controller = Backstepping::new(design, &NOMINAL);
    assert!(poles(&trial, &controller, 0)[0].re > 0.5);
}

#[test]
fn threads_do_not_matter() {
    let trial = Trial {
        duration: 3.0,
        ..Trial::standard(NOMINAL, 5, 3)
    };
    let controller = trial.backstepping();
    let flights = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        pool.install(|| trial.fly(&controller, &Control::default()).expect("a trim"))
    });
    assert_eq!(flights[0], flights[1]);
    // A member is the same in any experiment, and another seed is another noise.
    let one = Trial { runs: 1, ..trial };
    assert_eq!(
        one.fly(&controller, &Control::default()).expect("a trim")[0],
        flights[0][0]
    );
    let other = Trial { seed: 4, ..one };
    assert_ne!(
        other.fly(&controller, &Control::default()).expect("a trim")[0],
        flights[0][0]
    );
}

/// The matrix exponential, by Taylor's series for a small part and squaring.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    const SQUARINGS: i32 = 10;
    let part = matrix / 2.0_f64.powi(SQUARINGS);
    let one = DMatrix::identity(matrix.nrows(), matrix.ncols());
    let series = (1..16)
        .rev()
        .fold(one.clone(), |sum, k| &one + &part * sum / f64::from(k));
    (0..SQUARINGS).fold(series, |root, _| &root * &root)
}

/// The sampled regulator about the trim, by the matrix exponential: a map over vehicle and actuators.
fn sampled(trial: &Trial, rest: &LoopState<[f64; 0]>, tracker: &LinearTracker) -> DMatrix<f64> {
    let model = dcom::Model::new(&trial.truth);
    let (by_state, by_input) = model.jacobians(&rest.state, &rest.input);
    let n = dcom::State::<()>::LEN;
    let mut system = DMatrix::zeros(n + 4, n + 4);
    for (row, (states, inputs)) in by_state
        .to_array()
        .into_iter()
        .zip(by_input.to_array())
        .enumerate()
    {
        for (column, entry) in states.to_array().into_iter().enumerate() {
            system[(row, column)] = entry;
        }
        system[(row, n)] = inputs.phi;
        system[(row, n + 1)] = inputs.delta_e;
    }
    for (index, actuator) in ACTUATORS.iter().enumerate() {
        system[(n + index, n + index)] = -actuator.bandwidth;
        system[(n + index, n + 2 + index)] = actuator.bandwidth;
    }
    let held = exponential(&(system * PERIOD));
    let mut map = held.view((0, 0), (n + 2, n + 2)).into_owned();
    // The command's slope by the rigid states, which it is linear in.
    let command = |x: &sdcom::State<f64>| {
        let reference = trial.manoeuvre.at(0.0);
        let u = tracker.command(&mut [], &reference, x, &sdcom::Input::splat(0.0));
        DVector::from_vec(vec![u.phi, u.delta_e])
    };
    let at = |index, by| {
        let mut x = sdcom::State::splat(0.0);
        for (own, value) in (0..5).zip(rest.state.to_array()) {
            x.set(own, value);
        }
        x.get(index).and_then(|value| x.set(index, value + by));
        x
    };
    for column in 0..5 {
        let slope = 0.5 * (command(&at(column, 1.0)) - command(&at(column, -1.0)));
        let moved = held.view((0, n + 2), (n + 2, 2)) * slope;
        let sum = map.column(column) + moved;
        map.set_column(column, &sum);
    }
    map
}

#[test]
fn the_sampled_regulator_is_as_the_linear_prediction() {
    let trial = calm(NOMINAL);
    let tracker = trial.linear().expect("a regulator");
    let model = dcom::Model::new(&trial.truth);
    let (closed, rest) = trial.closed(&model, &tracker).expect("a trim");
    let map = sampled(&trial, &rest, &tracker);
    let mut predicted: Vec<_> = map
        .complex_eigenvalues()
        .iter()
        .map(|z| ComplexField::ln(*z) / PERIOD)
        .collect();
    predicted.sort_by(|a, b| b.re.total_cmp(&a.re).then(a.im.total_cmp(&b.im)));
    let mut found = closed.poles(&rest).expect("finite");
    found.sort_by(|a, b| b.re.total_cmp(&a.re).then(a.im.total_cmp(&b.im)));
    // The truth's steps of 2.5 ms cost the fastest mode some per cent.
    for (predicted, found) in predicted.iter().zip(&found).take(8) {
        assert_relative_eq!(predicted.re, found.re, max_relative = 2e-3);
        assert_abs_diff_eq!(
            predicted.im,
            found.im,
            epsilon = 2e-3 * predicted.im.abs().max(1.0)
        );
    }
    let mut at = rest;
    at.state.velocity += 0.5;
    at.state.altitude += 5.0;
    at.state.alpha += 2e-4;
    let deviation = |flight: &LoopState<[f64; 0]>| {
        let x = flight.state.zip_with(rest.state, |a, b| a - b).to_array();
        let u = flight.input.zip_with(rest.input, |a, b| a - b).to_array();
        DVector::from_iterator(13, x.into_iter().chain(u.into_iter().take(2)))
    };
    let mut linear = deviation(&at);
    let scale = linear.clone();
    for _ in 0..300 {
        advance(&closed, &mut at);
        linear = &map * linear;
    }
    let flown = deviation(&at);
    assert_abs_diff_eq!(flown[0], linear[0], epsilon = 5e-3 * scale[0]);
    assert_abs_diff_eq!(flown[1], linear[1], epsilon = 5e-3 * scale[1]);
    assert_abs_diff_eq!(flown[2], linear[2], epsilon = 5e-3 * scale[3]);
    assert_abs_diff_eq!(flown[3], linear[3], epsilon = 5e-3 * scale[3]);
}

#[test]
fn commands_and_their_derivatives_agree() {
    let manoeuvre = Manoeuvre::standard(7700.0, 85_000.0);
    let before = manoeuvre.at(1.0);
    assert_eq!(
        (before.velocity, before.altitude, before.climb_rate),
        (7700.0, 85_000.0, 0.0)
    );
    for time in [2.5, 9.0, 30.0, 80.0] {
        let [behind, at, ahead] = [time - 1e-3, time, time + 1e-3].map(|time| manoeuvre.at(time));
        let slope = |a: f64, b: f64| (b - a) / 2e-3;
        assert_abs_diff_eq!(
            at.acceleration,
            slope(behind.velocity, ahead.velocity),
            epsilon = 1e-5
        );
        assert_abs_diff_eq!(
            at.climb_rate,
            slope(behind.altitude, ahead.altitude),
            epsilon = 1e-5
        );
        assert_abs_diff_eq!(
            at.climb_acceleration,
            slope(behind.climb_rate, ahead.climb_rate),
            epsilon = 1e-5
        );
    }
    let after = manoeuvre.at(400.0);
    assert_relative_eq!(after.velocity, 8000.0, max_relative = 1e-12);
    assert_relative_eq!(after.altitude, 86_500.0, max_relative = 1e-12);
}

#[test]
fn an_actuator_lags_and_tells_its_limits() {
    let [_, elevator] = ACTUATORS;
    let (position, limits) = elevator.moved(0.1, 0.11, 0.05);
    assert_relative_eq!(
        position,
        0.11 - 0.01 * (-1.0_f64).exp(),
        max_relative = 1e-12
    );
    assert!(!limits.position && !limits.rate);
    let (position, limits) = elevator.moved(0.0, 1.0, 0.01);
    assert_relative_eq!(position, 0.01, max_relative = 1e-12);
    assert!(limits.position && limits.rate);
    let bound = elevator.bounds.max;
    let (position, limits) = elevator.moved(bound, 2.0 * bound, 0.01);
    assert_eq!(position, bound);
    assert!(limits.position && !limits.rate);
}

#[test]
fn the_documentation_has_the_tables_of_the_code() {
    let documentation = include_str!("../../../docs/closed-loop.md");
    for slow in ["δe through a lag of {} rad/s", "(1 − e^{−{} T})"] {
        let sentence = slow.replace("{}", &DESIGN.elevator.to_string());
        assert!(documentation.contains(&sentence), "{sentence}");
    }
    let tables = closed_loop::tables();
    let mut lacking = tables
        .iter()
        .filter(|table| !documentation.contains(*table))
        .peekable();
    assert!(
        lacking.peek().is_none(),
        "docs/closed-loop.md lacks tables of `cargo run --release -p ahv-analysis --example closed_loop`:\n{}",
        lacking.map(String::as_str).collect::<Vec<_>>().join("\n")
    );
}

#[test]
fn the_gains_lie_between_the_unstable_pole_and_the_unstable_zero() {
    let [pole, zero] = closed_loop::unstable(&calm(NOMINAL));
    assert!(pole > 0.0);
    for above in [DESIGN.alpha.decay, DESIGN.pitch_rate.decay] {
        assert!(above > pole, "{above} {pole}");
    }
    let [_, of_alpha, _] = DESIGN.filters;
    for below in [DESIGN.gamma.decay, of_alpha] {
        assert!(below < zero, "{below} {zero}");
    }
}
