//! Trims of the models against values that were computed independently of this project.
#![forbid(unsafe_code)]

use ahv_analysis::trim::{LevelFlight, TrimError, trim};
use ahv_models::{com, dcom, sdcom};
use approx::assert_abs_diff_eq;

const VELOCITY: f64 = 7702.0808;
const ALTITUDE: f64 = 85_000.0;

fn dcom_model(canard_slaving: f64) -> dcom::Model<f64> {
    dcom::Model::new(&dcom::Parameters {
        canard_slaving,
        ..dcom::NOMINAL
    })
}

#[test]
fn without_canard_the_trim_is_the_recomputed_one() {
    let flight = LevelFlight::new(VELOCITY, ALTITUDE);
    let trim = trim(&dcom_model(0.0), &flight).expect("the DCOM trims");
    assert_abs_diff_eq!(trim.state.alpha.to_degrees(), 1.5018, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.phi, 0.2821, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.delta_e.to_degrees(), 13.1006, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.state.eta_1, 0.6276, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.state.eta_2, -0.0137, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.state.eta_3, -0.0372, epsilon = 6e-5);
    assert!(trim.residual_max < 1e-9, "{trim:?}");
    assert!(trim.iterations < 10, "{trim:?}");
    assert_eq!(
        (trim.state.velocity, trim.state.altitude),
        (VELOCITY, ALTITUDE)
    );
    assert_eq!((trim.state.gamma, trim.state.pitch_rate), (0.0, 0.0));
}

#[test]
fn with_a_slaved_canard_the_trim_is_the_recomputed_one() {
    let flight = LevelFlight::new(VELOCITY, ALTITUDE);
    let trim = trim(&dcom_model(1.0), &flight).expect("the DCOM trims");
    assert_abs_diff_eq!(trim.state.alpha.to_degrees(), 3.6558, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.phi, 0.2957, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.delta_e.to_degrees(), 7.1364, epsilon = 6e-5);
}

#[test]
fn the_rigid_body_trims_where_it_was_recomputed_on_both_earths() {
    for (spherical_earth, alpha, phi, delta_e) in [
        (0.0, 1.64457, 0.26809, 12.53998),
        (1.0, 1.4056, 0.2505, 11.984),
    ] {
        let model = com::Model::new(&com::Parameters {
            spherical_earth,
            ..com::NOMINAL
        });
        let trim = trim(&model, &LevelFlight::new(VELOCITY, ALTITUDE)).expect("the COM trims");
        // To the digits given.
        assert_abs_diff_eq!(trim.state.alpha.to_degrees(), alpha, epsilon = 6e-5);
        assert_abs_diff_eq!(trim.input.phi, phi, epsilon = 6e-5);
        assert_abs_diff_eq!(trim.input.delta_e.to_degrees(), delta_e, epsilon = 6e-4);
    }
}

/// At rest η is N/ω², which is what the reduction puts in its place: both models share their trims.
#[test]
fn the_stochastic_model_trims_where_the_deterministic_one_does() {
    let full = trim(&dcom_model(0.0), &LevelFlight::new(VELOCITY, ALTITUDE)).expect("trims");
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let reduced = trim(&model, &LevelFlight::new(VELOCITY, ALTITUDE)).expect("the SDCOM trims");
    assert_abs_diff_eq!(reduced.state.alpha, full.state.alpha, epsilon = 1e-12);
    assert_abs_diff_eq!(reduced.input.phi, full.input.phi, epsilon = 1e-12);
    assert_abs_diff_eq!(reduced.input.delta_e, full.input.delta_e, epsilon = 1e-12);
    assert_eq!(
        (
            reduced.state.chi_1,
            reduced.state.chi_2,
            reduced.state.chi_3
        ),
        (0.0, 0.0, 0.0)
    );
}

#[test]
fn the_com_trims_too() {
    let flight = LevelFlight::new(VELOCITY, ALTITUDE);
    let trim = trim(&com::Model::new(&com::NOMINAL), &flight).expect("the COM trims");
    assert!(trim.residual_max < 1e-9, "{trim:?}");
}

#[test]
fn held_inputs_are_held() {
    let mut flight = LevelFlight::<dcom::Input<f64>>::new(VELOCITY, ALTITUDE);
    flight.input.delta_c = 0.05;
    let trim = trim(&dcom_model(0.0), &flight).expect("the DCOM trims");
    assert_eq!(trim.input.delta_c, 0.05);
    assert!(trim.residual_max < 1e-9, "{trim:?}");
}

#[test]
fn trims_are_found_over_the_box() {
    for velocity in [7000.0, 9000.0, 11_000.0] {
        for altitude in [80_000.0, 95_000.0, 110_000.0] {
            let trim = trim(&dcom_model(0.0), &LevelFlight::new(velocity, altitude));
            assert!(trim.is_ok(), "{velocity} ft/s, {altitude} ft: {trim:?}");
        }
    }
}

#[test]
fn impossible_flight_is_a_typed_error() {
    let still = trim(&dcom_model(0.0), &LevelFlight::new(0.0, ALTITUDE));
    assert!(
        matches!(
            still,
            Err(TrimError::NonFinite {
                name: "gamma" | "alpha",
                ..
            })
        ),
        "{still:?}"
    );
    let space = trim(&dcom_model(0.0), &LevelFlight::new(VELOCITY, 1e6));
    assert!(
        matches!(
            space,
            Err(TrimError::NoConvergence { .. } | TrimError::Singular { .. })
        ),
        "{space:?}"
    );
    let nowhere = trim(&dcom_model(0.0), &LevelFlight::new(f64::NAN, ALTITUDE));
    assert!(
        matches!(nowhere, Err(TrimError::NonFinite { .. })),
        "{nowhere:?}"
    );
}
