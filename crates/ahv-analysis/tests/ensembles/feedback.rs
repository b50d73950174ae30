//! Feedback of a flight: its actuators, and a reference that moves.

use ahv_analysis::actuator::Actuator;
use ahv_analysis::erased::{values, vector};
use ahv_analysis::monte_carlo::{Experiment, Feedback, Point, Scheme};
use ahv_analysis::trim::trim;
use ahv_core::{Bounds, Vector};
use ahv_models::sdcom;
use approx::assert_relative_eq;
use nalgebra::DMatrix;

use super::monte_carlo::{INPUT, STATE, Sdcom, experiment, index};
use crate::common::level;

/// Number of δe among the inputs.
const ELEVATOR: usize = 1;

/// Flights about a reference, by an elevator with these gains and this actuator.
fn about(
    state: sdcom::State<f64>,
    rate: sdcom::State<f64>,
    gains: &[(&str, f64)],
    actuator: Actuator,
) -> Experiment {
    let mut gain = DMatrix::zeros(3, 8);
    for &(name, value) in gains {
        gain[(ELEVATOR, index(name))] = value;
    }
    let mut actuators = vec![None; 3];
    actuators[ELEVATOR] = Some(actuator);
    let feedback = Feedback {
        state: values(&state),
        rate: values(&rate),
        input: values(&INPUT),
        gain,
        actuators,
    };
    Experiment {
        feedback: Some(feedback),
        ..experiment(Scheme::EulerMaruyama, 1e-3, vec![0, 1, 2, 50])
    }
}

fn trajectory(experiment: &Experiment) -> Vec<Point> {
    let engine = experiment.engine::<Sdcom>().expect("the scheme goes");
    engine.trajectory(2, 1).expect("it goes")
}

#[test]
fn feedback_moves_the_inputs_as_the_actuator_does() {
    let actuator = Actuator {
        bandwidth: 20.0,
        rate: 0.5,
        bounds: Bounds::new(0.15, 0.22),
    };
    let reference = sdcom::State {
        alpha: 0.01,
        ..STATE
    };
    let gains = [("alpha", -3.0), ("pitch_rate", -1.0)];
    let points = trajectory(&about(
        reference,
        sdcom::State::splat(0.0),
        &gains,
        actuator,
    ));
    assert_eq!(points.len(), 51);
    let mut position = INPUT.delta_e;
    for (before, after) in points.iter().zip(&points[1..]) {
        let x: sdcom::State<f64> = vector(&before.state);
        let command = INPUT.delta_e + 3.0 * (x.alpha - 0.01) + x.pitch_rate;
        position = actuator.moved(position, command, 1e-3).0;
        assert_relative_eq!(after.input[ELEVATOR], position, max_relative = 1e-12);
        assert_eq!(after.input[0], INPUT.phi);
    }
    let moved = points[50].input[ELEVATOR] - INPUT.delta_e;
    assert!(moved.abs() > 1e-3, "it moves");
}

/// What moves the elevator where the altitude is regulated.
const QUICK: Actuator = Actuator {
    bandwidth: 20.0,
    rate: 5.0,
    bounds: Bounds::new(-1.0, 1.0),
};

/// Flights that regulate the altitude, about a reference with these rates.
fn about_a_reference(rate: sdcom::State<f64>) -> Experiment {
    about(STATE, rate, &[("altitude", 1e-2)], QUICK)
}

#[test]
fn the_reference_moves_with_the_flight() {
    let rate = sdcom::State {
        altitude: 134.0,
        ..sdcom::State::splat(0.0)
    };
    let points = trajectory(&about_a_reference(rate));
    let mut position = INPUT.delta_e;
    for (step, (before, after)) in points.iter().zip(&points[1..]).enumerate() {
        let reference = STATE.altitude + 134.0 * (step as f64 * 1e-3);
        let command = INPUT.delta_e - 1e-2 * (before.state[index("altitude")] - reference);
        position = QUICK.moved(position, command, 1e-3).0;
        assert_relative_eq!(after.input[ELEVATOR], position, max_relative = 1e-12);
    }
    assert!(position > INPUT.delta_e + 1e-3, "it moves");
}

/// A rate of 0 changes no bit: one that is not 0, but too small to move anything, gives the same.
#[test]
fn a_reference_that_stays_costs_no_bit() {
    let tiny = sdcom::State::splat(1e-300);
    let [still, moving] = [sdcom::State::splat(0.0), tiny].map(|rate| {
        let last = trajectory(&about_a_reference(rate)).pop();
        last.map(|point| (point.state, point.input))
    });
    assert_eq!(still, moving);
}

#[test]
fn a_reference_that_is_no_equilibrium_has_a_state_that_leaves_it() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let climb = level::<Sdcom>().with("gamma", 1.0_f64.to_radians());
    let trim = trim(&model, &climb).expect("a trim");
    let mut feedback = about_a_reference(sdcom::State::splat(0.0))
        .feedback
        .expect("a feedback");
    (feedback.state, feedback.input) = (values(&trim.state), values(&trim.input));
    let still = feedback.unsteady(&model).expect("the altitude climbs");
    assert_eq!((still.state, still.rate), ("altitude", 0.0));
    assert_relative_eq!(still.expected, 134.42, max_relative = 1e-4);
    feedback.rate[index("altitude")] = still.expected;
    assert_eq!(feedback.unsteady(&model), None);
    feedback.rate[index("velocity")] = 1.0;
    let faster = feedback.unsteady(&model).expect("the velocity stays");
    assert_eq!(
        (faster.state, faster.rate, faster.expected),
        ("velocity", 1.0, 0.0)
    );
    feedback.rate[index("velocity")] = 0.0;
    feedback.state[index("alpha")] += 1e-6;
    assert!(feedback.unsteady(&model).is_some());
}
