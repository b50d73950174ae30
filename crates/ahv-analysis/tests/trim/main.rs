//! Trims of the models against values that were computed independently of this project.
#![forbid(unsafe_code)]

use std::f64::consts::PI;

#[path = "../common/mod.rs"]
mod common;
mod outputs;
mod scan;

use ahv_analysis::trim::{SteadyState, TrimError, trim};
use ahv_core::{Bounds, GeneratedModel, ModelList, ModelVisitor, Vector};
use ahv_models::dcom::Canard;
use ahv_models::{Models, com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::level;

const VELOCITY: f64 = 7702.0808;
const ALTITUDE: f64 = 85_000.0;

fn dcom_model(canard: Canard) -> dcom::Model<f64> {
    dcom::Model::new(&dcom::NOMINAL.with_canard(canard))
}

#[test]
fn without_canard_the_trim_is_the_recomputed_one() {
    let trim =
        trim(&dcom_model(Canard::None), &level::<dcom::Model<f64>>()).expect("the DCOM trims");
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
    let trim =
        trim(&dcom_model(Canard::Slaved), &level::<dcom::Model<f64>>()).expect("the DCOM trims");
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
        let flight = level::<com_rigid::Model<f64>>();
        let rigid = trim(&com_rigid::Model::new(&parameters), &flight).expect("trims");
        // To the digits given.
        assert_abs_diff_eq!(rigid.state.alpha.to_degrees(), alpha, epsilon = 6e-5);
        assert_abs_diff_eq!(rigid.input.phi, phi, epsilon = 6e-5);
        assert_abs_diff_eq!(rigid.input.delta_e.to_degrees(), delta_e, epsilon = 6e-4);
        assert!(rigid.residual_max < 1e-9, "{rigid:?}");

        let flight = level::<com::Model<f64>>();
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
        let flight = level::<dcom::Model<f64>>();
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
fn agree_in_si<M: GeneratedModel>(parameters: &M::ParametersOf<f64>) {
    let in_si = M::with_parameters(&si(*parameters));
    let metres = SteadyState::converted(&M::TRIM, |name| {
        factor::<M::State>(name)
            .or(factor::<M::Input>(name))
            .expect("a state or an input")
    });
    let feet = trim(&M::with_parameters(parameters), &level::<M>()).expect("trims");
    let metres = trim(&in_si, &metres).expect("trims in SI");
    for (index, (name, factor)) in M::State::NAMES.iter().zip(M::State::SI_FACTORS).enumerate() {
        let converted = feet.state.get(index).map(|value| value * factor);
        let own = metres.state.get(index);
        let (converted, own) = converted.zip(own).expect("a component");
        assert!(
            (converted - own).abs() <= 1e-12 * converted.abs().max(1.0),
            "{} {name}: {converted} from feet, {own} in SI",
            M::NAME
        );
    }
    for (index, factor) in M::Input::SI_FACTORS.iter().enumerate() {
        let inputs = feet.input.get(index).zip(metres.input.get(index));
        let (feet, metres) = inputs.expect("a component");
        assert_abs_diff_eq!(feet * factor, metres, epsilon = 1e-12);
    }
}

/// What a component in foot and slug is multiplied with to be in SI.
fn factor<V: Vector<f64>>(name: &str) -> Option<f64> {
    V::SI_FACTORS.get(V::index_of(name)?).copied()
}

fn si<P: Vector<f64>>(parameters: P) -> P {
    let mut factors = P::SI_FACTORS.iter();
    parameters.map(|value| value * factors.next().expect("a factor for each"))
}

/// Every set as it is, and with each option of each choice.
#[test]
fn every_model_trims_alike_in_si() {
    struct InSi(usize);

    impl ModelVisitor for InSi {
        fn visit<M: GeneratedModel>(&mut self) {
            for set in M::SETS {
                agree_in_si::<M>(&set.parameters);
                for option in M::TABLE.choices.iter().flat_map(|choice| choice.options) {
                    agree_in_si::<M>(&option.apply(set.parameters));
                }
            }
            self.0 += 1;
        }
    }

    let mut visitor = InSi(0);
    Models::visit(&mut visitor);
    assert_eq!(visitor.0, 7);
}

/// At rest η is N/ω², which is what the reduction puts in its place: both models share their trims.
#[test]
fn the_stochastic_model_trims_where_the_deterministic_one_does() {
    let full = trim(&dcom_model(Canard::None), &level::<dcom::Model<f64>>()).expect("trims");
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let reduced = trim(&model, &level::<sdcom::Model<f64>>()).expect("the SDCOM trims");
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
    let gust = trim(&model, &level::<sdcom_gust::Model<f64>>()).expect("trims");
    assert_abs_diff_eq!(gust.state.alpha, full.state.alpha, epsilon = 1e-12);
    assert_eq!(gust.state.alpha_gust, 0.0);
}

/// The terms that the printed form omits are most of the drag: its trim is another one.
#[test]
fn the_printed_form_trims_elsewhere() {
    let model = sdcom_printed::Model::new(&sdcom_printed::NOMINAL);
    let trim = trim(&model, &level::<sdcom_printed::Model<f64>>()).expect("trims");
    assert!(trim.residual_max < 1e-9, "{trim:?}");
    assert!(trim.input.phi < 0.5 * 0.2821, "{trim:?}");
}

#[test]
fn held_inputs_are_held() {
    let flight = level::<dcom::Model<f64>>().holding("delta_c", 0.05);
    let trim = trim(&dcom_model(Canard::Free), &flight).expect("the DCOM trims");
    assert_eq!(trim.input.delta_c, 0.05);
    assert!(trim.residual_max < 1e-9, "{trim:?}");
}

/// The forces along and across the path of a point mass, recomputed from the table.
#[test]
fn a_climb_is_steady_with_the_weight_along_the_path() {
    let p = com::NOMINAL;
    for gamma in [-0.06_f64, 0.05] {
        let flight = level::<com_rigid::Model<f64>>().with("gamma", gamma);
        let trim = trim(&com_rigid::Model::new(&p), &flight).expect("trims");
        assert_eq!(trim.state.gamma, gamma);
        assert!(trim.residual_max < 1e-9, "{trim:?}");
        let (alpha, phi, delta_e) = (trim.state.alpha, trim.input.phi, trim.input.delta_e);
        let pressure = 0.5 * p.rho_0 * VELOCITY * VELOCITY * p.s;
        let lift = pressure * (p.c_l_alpha * alpha + p.c_l_delta_e * delta_e + p.c_l_0);
        let drag = pressure
            * (p.c_d_alpha_2 * alpha * alpha
                + p.c_d_alpha * alpha
                + p.c_d_delta_e_2 * delta_e * delta_e
                + p.c_d_delta_e * delta_e
                + p.c_d_0);
        let powers = [alpha.powi(3), alpha.powi(2), alpha, 1.0];
        let sum = |of: [f64; 4]| of.iter().zip(powers).map(|(a, b)| a * b).sum::<f64>();
        let thrust = phi * sum([p.t_phi_alpha_3, p.t_phi_alpha_2, p.t_phi_alpha, p.t_phi])
            + sum([p.t_alpha_3, p.t_alpha_2, p.t_alpha, p.t_0]);
        let weight = p.m * p.g;
        let along = thrust * alpha.cos() - drag;
        let across = lift + thrust * alpha.sin();
        assert_relative_eq!(along, weight * gamma.sin(), max_relative = 1e-9);
        assert_relative_eq!(across, weight * gamma.cos(), max_relative = 1e-9);
    }
}

/// Too little fuel is told, with the point that keeps lift and moment in balance as well as it can.
#[test]
fn the_bound_that_blocks_is_told() {
    let bounds = com::Input {
        phi: Bounds::new(0.05, 0.2),
        ..com::INPUT_BOUNDS
    };
    let flight = level::<com_rigid::Model<f64>>().within(&bounds);
    let error = trim(&com_rigid::Model::new(&com::NOMINAL), &flight).expect_err("too little fuel");
    let nearest = error.nearest().expect("a nearest point");
    // At its minimum the search ends: it does not try ever shorter steps, up to the hopeless damping.
    assert!(nearest.iterations < 20, "{nearest:?}");
    assert_eq!(nearest.input[0], ("phi", 0.2));
    assert_eq!(nearest.worst, "velocity");
    assert!(nearest.worst_residual < 0.0, "{nearest:?}");
    let TrimError::Blocked {
        blocking, beyond, ..
    } = &error
    else {
        panic!("{error:?}");
    };
    assert_eq!(blocking[0].to_string(), "phi <= 0.2");
    let beyond = beyond.as_ref().expect("a trim");
    assert_eq!(beyond[0].0, "phi");
    assert_abs_diff_eq!(beyond[0].1, 0.26809, epsilon = 6e-6);
    assert!(
        error.to_string().contains("no trim inside phi <= 0.2"),
        "{error}"
    );
}

/// Each bound that the trim outside violates is named, whether or not the search for the nearest point ends at it.
#[test]
fn all_violated_bounds_are_named() {
    let bounds = com::Input {
        phi: Bounds::new(0.05, 0.2),
        delta_e: Bounds::new(-0.2, 0.2),
    };
    let flight = level::<com_rigid::Model<f64>>().within(&bounds);
    let error = trim(&com_rigid::Model::new(&com::NOMINAL), &flight).expect_err("out of bounds");
    let TrimError::Blocked { blocking, .. } = &error else {
        panic!("{error:?}");
    };
    let mut named: Vec<String> = blocking.iter().map(ToString::to_string).collect();
    named.sort();
    assert_eq!(named, ["delta_e <= 0.2", "phi <= 0.2"]);
}

/// An elevator that moves nothing blocks nothing, at either of its bounds; without it there is no trim.
#[test]
fn a_bound_of_an_input_without_effect_does_not_block() {
    let parameters = com::Parameters {
        c_l_delta_e: 0.0,
        c_d_delta_e: 0.0,
        c_d_delta_e_2: 0.0,
        c_m_delta_e: 0.0,
        ..com::NOMINAL
    };
    let model = com_rigid::Model::new(&parameters);
    let flight = level::<com_rigid::Model<f64>>();
    let start = flight.input_value("delta_e");
    for delta_e in [
        Bounds::new(start + 0.1, start + 0.2),
        Bounds::new(start - 0.2, start - 0.1),
    ] {
        let phi = Bounds::new(f64::NEG_INFINITY, f64::INFINITY);
        let flight = flight.clone().within(&com::Input { phi, delta_e });
        let error = trim(&model, &flight).expect_err("no balance of moments");
        assert!(matches!(error, TrimError::NoConvergence { .. }), "{error}");
    }
}

#[test]
fn impossible_flight_is_a_typed_error() {
    let model = dcom_model(Canard::None);
    for (name, value) in [
        ("velocity", 0.0),
        ("velocity", -VELOCITY),
        ("velocity", f64::NAN),
        ("altitude", f64::INFINITY),
        ("gamma", 90.0_f64.to_radians()),
        ("gamma", -PI),
        ("gamma", f64::NAN),
    ] {
        let flight = level::<dcom::Model<f64>>().with(name, value);
        let refused = trim(&model, &flight);
        assert!(
            matches!(refused, Err(TrimError::Domain { name: at_fault, .. }) if at_fault == name),
            "{refused:?}"
        );
    }
    // Too slow for the numbers of the machine: the row that fails has a name.
    let slow = trim(
        &model,
        &level::<dcom::Model<f64>>().with("velocity", 1e-300),
    )
    .expect_err("no flight");
    let nearest = slow.nearest().expect("a nearest point");
    assert_eq!(nearest.worst, "gamma");
    let text = slow.to_string();
    assert!(
        text.contains("the derivative of gamma is still -") && text.len() < 120,
        "{text}"
    );
    let high = level::<dcom::Model<f64>>().with("altitude", 1e6);
    let space = trim(&model, &high);
    assert!(
        matches!(space, Err(TrimError::NoConvergence { .. })),
        "{space:?}"
    );
    let space = trim(&model, &high.within(&dcom::INPUT_BOUNDS)).expect_err("there is no air");
    assert!(space.nearest().is_some(), "{space:?}");
    // A name that is no given state, and a bound that is told.
    let unknown = trim(&model, &level::<dcom::Model<f64>>().with("alpha", 0.0));
    assert_eq!(unknown, Err(TrimError::MissingName { name: "alpha" }));
    let steep = trim(&model, &level::<dcom::Model<f64>>().with("gamma", 2.0));
    let half = 0.5 * PI;
    let expected = TrimError::Domain {
        name: "gamma",
        value: 2.0,
        above: -half,
        below: half,
    };
    assert_eq!(steep, Err(expected));
}
