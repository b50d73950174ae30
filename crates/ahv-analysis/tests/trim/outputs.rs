//! Trims whose equations are outputs, beside the same trims by rows of the drift.

use ahv_analysis::trim::{ModelChange, SteadyState, Trim, TrimError, response, trim};
use ahv_core::{Equation, GeneratedModel, Given, Sought, TrimProblem, Vector};
use ahv_models::com;
use ahv_models::com_rigid::{Input, Model, Outputs, State};
use approx::{assert_abs_diff_eq, assert_relative_eq};

const SOUGHT: &[Sought] = &[
    Sought::new("gamma", 0.01, 0.1),
    Sought::new("alpha", 0.0, 0.1),
    Sought::new("phi", 0.25, 0.1),
    Sought::new("delta_e", 0.2, 0.1),
];
/// The pitch angle is given in the place of the flight-path angle, and the moment vanishes in that of the pitch acceleration.
const BY_OUTPUTS: TrimProblem = TrimProblem {
    given: &[
        Given::new("velocity", 7702.0808, 0.0, f64::INFINITY),
        Given::new("altitude", 85_000.0, f64::NEG_INFINITY, f64::INFINITY),
        Given::new("theta", 0.03, -1.5, 1.5),
    ],
    sought: SOUGHT,
    equations: &[
        Equation::new("velocity", 1.0, None),
        Equation::new("gamma", 1.0, None),
        Equation::new("pitching_moment", 1.0, None),
    ],
    moving: &["altitude"],
    shown: &[],
};

fn found(parameters: &com::Parameters<f64>, flight: &SteadyState) -> Trim<State<f64>, Input<f64>> {
    trim(&Model::new(parameters), flight).expect("it trims")
}

#[test]
fn an_output_that_is_given_has_its_value() {
    for gamma in [0.0, 0.02] {
        let model = Model::new(&com::NOMINAL);
        let by_rows = SteadyState::new(&Model::TRIM).with("gamma", gamma);
        let rows = trim(&model, &by_rows).expect("it trims");
        let theta = gamma + rows.state.alpha;
        let flight = SteadyState::new(&BY_OUTPUTS).with("theta", theta);
        let outputs = found(&com::NOMINAL, &flight);
        let away = outputs.state.zip_with(rows.state, |own, other| own - other);
        for away in away.to_array() {
            assert_abs_diff_eq!(away, 0.0, epsilon = 1e-12);
        }
        assert_relative_eq!(outputs.input.phi, rows.input.phi, max_relative = 1e-10);
        assert_relative_eq!(
            outputs.input.delta_e,
            rows.input.delta_e,
            max_relative = 1e-10
        );
        assert!(outputs.residual_max < 1e-4, "{outputs:?}");
    }
}

/// What a parameter does to the trim: the response beside trims of changed vehicles.
#[test]
fn the_response_knows_how_outputs_change() {
    let flight = SteadyState::new(&BY_OUTPUTS);
    let model = Model::new(&com::NOMINAL);
    let trim = found(&com::NOMINAL, &flight);
    let changed = |by: f64| com::Parameters {
        c_m_alpha: com::NOMINAL.c_m_alpha + by,
        ..com::NOMINAL
    };
    // The moment is linear in this parameter, the drift is too.
    let at = |by: f64| {
        let model = Model::new(&changed(by));
        let drift = ahv_core::Model::drift(&model, &trim.state, &trim.input);
        let outputs: Outputs<f64> = Model::outputs(&model, &trim.state, &trim.input);
        (drift, outputs)
    };
    let ((drift, outputs), (before, outputs_before)) = (at(1.0), at(0.0));
    let change = ModelChange {
        drift: drift.zip_with(before, |after, before| after - before),
        outputs: outputs.zip_with(outputs_before, |after, before| after - before),
    };
    let shifts = response(&model, &flight, &trim, &[change]).expect("smooth");
    let shift = shifts.expect("determined")[0];
    let step = 1e-4;
    let [above, below] = [step, -step].map(|by| found(&changed(by), &flight));
    let slope = |above: f64, below: f64| (above - below) / (2.0 * step);
    assert!(shift.input.delta_e.abs() > 0.01, "{shift:?}");
    for (own, above, below) in [
        (shift.state.gamma, above.state.gamma, below.state.gamma),
        (shift.state.alpha, above.state.alpha, below.state.alpha),
        (shift.input.phi, above.input.phi, below.input.phi),
        (
            shift.input.delta_e,
            above.input.delta_e,
            below.input.delta_e,
        ),
    ] {
        assert_relative_eq!(own, slope(above, below), max_relative = 1e-6);
    }
}

/// The air is as thin as it is at the given altitude.
const OUT_OF_REACH: TrimProblem = TrimProblem {
    given: &[
        Given::new("velocity", 7702.0808, 0.0, f64::INFINITY),
        Given::new("altitude", 85_000.0, f64::NEG_INFINITY, f64::INFINITY),
        Given::new("density", 1.0, 0.0, f64::INFINITY),
    ],
    ..BY_OUTPUTS
};
const MISSING: TrimProblem = TrimProblem {
    given: &[Given::new("thickness", 1.0, 0.0, 2.0)],
    ..BY_OUTPUTS
};

#[test]
fn an_output_that_cannot_be_had_is_named() {
    let model = Model::new(&com::NOMINAL);
    let error = trim(&model, &SteadyState::new(&OUT_OF_REACH)).expect_err("no such air");
    let nearest = error.nearest().expect("a nearest point");
    assert_eq!((nearest.worst, nearest.worst_is_rate()), ("density", false));
    let text = error.to_string();
    assert!(text.contains("density is still off by -0.99"), "{text}");
    let error = trim(&model, &SteadyState::new(&MISSING)).expect_err("no such output");
    assert_eq!(error, TrimError::MissingName { name: "thickness" });
    let below = SteadyState::new(&BY_OUTPUTS).with("theta", -2.0);
    let error = trim(&model, &below).expect_err("below the domain");
    assert!(
        matches!(error, TrimError::Domain { name: "theta", .. }),
        "{error}"
    );
}
