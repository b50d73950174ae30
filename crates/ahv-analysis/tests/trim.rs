//! Trims of the models against values that were computed independently of this project.
#![forbid(unsafe_code)]

use ahv_analysis::trim::{LevelFlight, TrimError, trim};
use ahv_core::{DifferentiableModel, Vector};
use ahv_models::dcom::{Canard, Earth};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};
use approx::{assert_abs_diff_eq, assert_relative_eq};

const VELOCITY: f64 = 7702.0808;
const ALTITUDE: f64 = 85_000.0;

fn dcom_model(canard: Canard) -> dcom::Model<f64> {
    dcom::Model::new(&dcom::NOMINAL.with_canard(canard))
}

#[test]
fn without_canard_the_trim_is_the_recomputed_one() {
    let flight = LevelFlight::new(VELOCITY, ALTITUDE);
    let trim = trim(&dcom_model(Canard::None), &flight).expect("the DCOM trims");
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
    let trim = trim(&dcom_model(Canard::Slaved), &flight).expect("the DCOM trims");
    assert_abs_diff_eq!(trim.state.alpha.to_degrees(), 3.6558, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.phi, 0.2957, epsilon = 6e-5);
    assert_abs_diff_eq!(trim.input.delta_e.to_degrees(), 7.1364, epsilon = 6e-5);
}

/// A cantilever at rest adds nothing to lift, drag or moment: both COMs share their trims.
#[test]
fn the_coms_trim_where_they_were_recomputed_on_both_earths() {
    for (earth, alpha, phi, delta_e) in [
        (com::Earth::Flat, 1.64457, 0.26809, 12.53998),
        (com::Earth::Spherical, 1.4056, 0.2505, 11.984),
    ] {
        let parameters = com::NOMINAL.with_earth(earth);
        let flight = LevelFlight::new(VELOCITY, ALTITUDE);
        let rigid = trim(&com_rigid::Model::new(&parameters), &flight).expect("trims");
        // To the digits given.
        assert_abs_diff_eq!(rigid.state.alpha.to_degrees(), alpha, epsilon = 6e-5);
        assert_abs_diff_eq!(rigid.input.phi, phi, epsilon = 6e-5);
        assert_abs_diff_eq!(rigid.input.delta_e.to_degrees(), delta_e, epsilon = 6e-4);
        assert!(rigid.residual_max < 1e-9, "{rigid:?}");

        let flight = LevelFlight::new(VELOCITY, ALTITUDE);
        let flexible = trim(&com::Model::new(&parameters), &flight).expect("trims");
        assert_abs_diff_eq!(flexible.state.alpha, rigid.state.alpha, epsilon = 1e-12);
        assert_abs_diff_eq!(flexible.input.phi, rigid.input.phi, epsilon = 1e-12);
        assert_abs_diff_eq!(flexible.input.delta_e, rigid.input.delta_e, epsilon = 1e-12);
        let (x, p) = (flexible.state, parameters);
        let force = p.n_1_alpha_2 * x.alpha * x.alpha + p.n_1_alpha * x.alpha + p.n_1_0;
        assert_relative_eq!(
            x.eta_1,
            force / (p.omega_1 * p.omega_1),
            max_relative = 1e-12
        );
        assert!(flexible.iterations < 10, "{flexible:?}");
    }
}

/// With section 5.3's mass, inertia and modes, and with its modes alone.
#[test]
fn the_set_of_section_5_3_trims_where_it_was_recomputed() {
    for (parameters, alpha, phi, delta_e) in [
        (dcom::SECTION5_3, 0.606, 0.2216, 10.996),
        (heavy_section_5_3(), 1.5115, 0.2811, 13.063),
    ] {
        let flight = LevelFlight::new(VELOCITY, ALTITUDE);
        let trim = trim(&dcom::Model::new(&parameters), &flight).expect("the DCOM trims");
        assert_abs_diff_eq!(trim.state.alpha.to_degrees(), alpha, epsilon = 6e-4);
        assert_abs_diff_eq!(trim.input.phi, phi, epsilon = 6e-5);
        assert_abs_diff_eq!(trim.input.delta_e.to_degrees(), delta_e, epsilon = 6e-4);
    }
}

/// The modes of section 5.3 with the mass and inertia of section 5.1.
fn heavy_section_5_3() -> dcom::Parameters<f64> {
    dcom::Parameters {
        m: dcom::NOMINAL.m,
        i_yy: dcom::NOMINAL.i_yy,
        ..dcom::SECTION5_3
    }
}

/// The trims of a model in foot and slug, and of the same model in SI, agree to rounding.
fn agree_in_si<M: DifferentiableModel<Scalar = f64>>(model: &M, in_si: &M) {
    let feet = LevelFlight::new(VELOCITY, ALTITUDE);
    let metres = LevelFlight::new(VELOCITY * 0.3048, ALTITUDE * 0.3048);
    let (feet, metres) = (trim(model, &feet), trim(in_si, &metres));
    let (feet, metres) = (feet.expect("trims"), metres.expect("trims in SI"));
    for (index, (name, factor)) in M::State::NAMES.iter().zip(M::State::SI_FACTORS).enumerate() {
        let converted = feet.state.get(index).map(|value| value * factor);
        let own = metres.state.get(index);
        let (converted, own) = converted.zip(own).expect("a component");
        assert!(
            (converted - own).abs() <= 1e-12 * converted.abs().max(1.0),
            "{name}: {converted} from feet, {own} in SI"
        );
    }
    for index in 0..M::Input::LEN {
        let inputs = feet.input.get(index).zip(metres.input.get(index));
        let (feet, metres) = inputs.expect("a component");
        assert_abs_diff_eq!(feet, metres, epsilon = 1e-12);
    }
}

fn si<P: Vector<f64>>(parameters: P) -> P {
    let mut factors = P::SI_FACTORS.iter();
    parameters.map(|value| value * factors.next().expect("a factor for each"))
}

#[test]
fn every_model_trims_alike_in_si() {
    for (_, p) in com::SETS {
        agree_in_si(&com::Model::new(&p), &com::Model::new(&si(p)));
        agree_in_si(&com_rigid::Model::new(&p), &com_rigid::Model::new(&si(p)));
    }
    for (_, set) in dcom::SETS {
        for p in [
            set,
            set.with_canard(Canard::Slaved).with_earth(Earth::Spherical),
        ] {
            agree_in_si(&dcom::Model::new(&p), &dcom::Model::new(&si(p)));
            agree_in_si(&sdcom::Model::new(&p), &sdcom::Model::new(&si(p)));
            agree_in_si(&sdcom_gust::Model::new(&p), &sdcom_gust::Model::new(&si(p)));
            agree_in_si(
                &sdcom_printed::Model::new(&p),
                &sdcom_printed::Model::new(&si(p)),
            );
        }
    }
}

/// At rest η is N/ω², which is what the reduction puts in its place: both models share their trims.
#[test]
fn the_stochastic_model_trims_where_the_deterministic_one_does() {
    let full = trim(
        &dcom_model(Canard::None),
        &LevelFlight::new(VELOCITY, ALTITUDE),
    )
    .expect("trims");
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

    let model = sdcom_gust::Model::new(&sdcom::NOMINAL);
    let gust = trim(&model, &LevelFlight::new(VELOCITY, ALTITUDE)).expect("trims");
    assert_abs_diff_eq!(gust.state.alpha, full.state.alpha, epsilon = 1e-12);
    assert_eq!(gust.state.alpha_gust, 0.0);
}

/// The terms that the printed form omits are most of the drag: its trim is another one.
#[test]
fn the_printed_form_trims_elsewhere() {
    let model = sdcom_printed::Model::new(&sdcom_printed::NOMINAL);
    let trim = trim(&model, &LevelFlight::new(VELOCITY, ALTITUDE)).expect("trims");
    assert!(trim.residual_max < 1e-9, "{trim:?}");
    assert!(trim.input.phi < 0.5 * 0.2821, "{trim:?}");
}

#[test]
fn held_inputs_are_held() {
    let mut flight = LevelFlight::<dcom::Input<f64>>::new(VELOCITY, ALTITUDE);
    flight.input.delta_c = 0.05;
    let trim = trim(&dcom_model(Canard::Free), &flight).expect("the DCOM trims");
    assert_eq!(trim.input.delta_c, 0.05);
    assert!(trim.residual_max < 1e-9, "{trim:?}");
}

#[test]
fn trims_are_found_over_the_box() {
    for velocity in [7000.0, 9000.0, 11_000.0] {
        for altitude in [80_000.0, 95_000.0, 110_000.0] {
            let trim = trim(
                &dcom_model(Canard::None),
                &LevelFlight::new(velocity, altitude),
            );
            assert!(trim.is_ok(), "{velocity} ft/s, {altitude} ft: {trim:?}");
        }
    }
}

#[test]
fn impossible_flight_is_a_typed_error() {
    let still = trim(&dcom_model(Canard::None), &LevelFlight::new(0.0, ALTITUDE));
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
    let space = trim(&dcom_model(Canard::None), &LevelFlight::new(VELOCITY, 1e6));
    assert!(
        matches!(
            space,
            Err(TrimError::NoConvergence { .. } | TrimError::Singular { .. })
        ),
        "{space:?}"
    );
    let nowhere = trim(
        &dcom_model(Canard::None),
        &LevelFlight::new(f64::NAN, ALTITUDE),
    );
    assert!(
        matches!(nowhere, Err(TrimError::NonFinite { .. })),
        "{nowhere:?}"
    );
}
