//! Trims of the models against values that were computed independently of this project.
#![forbid(unsafe_code)]

use std::f64::consts::PI;

mod common;

use ahv_analysis::trim::{SteadyState, TrimError, trim};
use ahv_core::{Bounds, DifferentiableModel, GeneratedModel, ModelList, ModelVisitor, Vector};
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

/// Points along each side of the grid over the validity box of velocity and altitude.
const GRID: u32 = 20;

/// Whether there is a level trim inside the bounds, by scanning.
///
/// At each angle of attack the elevator is found from the pitching moment, which is all but linear in it, and phi from the
/// row of velocity, which is affine in it; both with the modes at rest. A trim is where the flight path stops turning.
fn exists<M: DifferentiableModel<Scalar = f64>>(
    model: &M,
    velocity: f64,
    altitude: f64,
    [phi, delta_e]: [Bounds; 2],
) -> bool {
    let at = |alpha: f64, input: [f64; 2]| {
        let (mut x, mut u) = (M::State::splat(0.0), M::Input::splat(0.0));
        for (name, value) in [
            ("velocity", velocity),
            ("altitude", altitude),
            ("alpha", alpha),
        ] {
            x.set(M::State::index_of(name).expect("a state"), value);
        }
        for (name, value) in ["phi", "delta_e"].into_iter().zip(input) {
            u.set(M::Input::index_of(name).expect("an input"), value);
        }
        // What the modes rest at: their equations are affine in eta, with -omega^2.
        for mode in 1..=3 {
            let indices = ["eta", "eta_dot"].map(|it| M::State::index_of(&format!("{it}_{mode}")));
            if let [Some(eta), Some(rate)] = indices {
                let force = model.drift(&x, &u).get(rate).expect("a row");
                let mut unit = x;
                unit.set(eta, 1.0);
                let stiffness = force - model.drift(&unit, &u).get(rate).expect("a row");
                x.set(eta, force / stiffness);
            }
        }
        let drift = model.drift(&x, &u);
        ["velocity", "gamma", "pitch_rate"].map(|row| {
            M::State::index_of(row)
                .and_then(|it| drift.get(it))
                .expect("a row")
        })
    };
    // At an elevator: phi, and the turn and pitch that are left.
    let balanced = |alpha: f64, elevator: f64| {
        let (zero, one) = (at(alpha, [0.0, elevator])[0], at(alpha, [1.0, elevator])[0]);
        let fuel = zero / (zero - one);
        let [_, turn, pitch] = at(alpha, [fuel, elevator]);
        (fuel, turn, pitch)
    };
    let settled = |alpha: f64| {
        let elevator = secant([0.0, 0.3], |elevator| balanced(alpha, elevator).2);
        let (fuel, turn, pitch) = balanced(alpha, elevator);
        // No elevator balances the largest angles; nothing falls through NaN.
        let turn = if pitch.abs() < 1e-9 { turn } else { f64::NAN };
        (turn, [fuel, elevator])
    };
    let scan: Vec<f64> = (-8..=16).map(|step| f64::from(step) * 2e-2).collect();
    scan.windows(2).any(|pair| {
        let [low, high] = [pair[0], pair[1]];
        let turns = settled(low).0 * settled(high).0 <= 0.0;
        turns && {
            let alpha = bisect([low, high], |alpha| -settled(alpha).0);
            let [fuel, elevator] = settled(alpha).1;
            phi.contains(fuel) && delta_e.contains(elevator)
        }
    })
}

/// Where a function that is all but linear is 0.
fn secant([mut old, mut new]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let mut before = of(old);
    for _ in 0..10 {
        let now = of(new);
        if now == before {
            break;
        }
        (old, new, before) = (new, new - now * (new - old) / (now - before), now);
    }
    new
}

/// Where a function that falls through 0 does so.
fn bisect([mut low, mut high]: [f64; 2], falling: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if falling(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// A trim is found from the cold start exactly where there is one, and else the bound that blocks is told.
///
/// `scanned` is a model with the same trims whose modes do not act on each other.
fn trims_wherever_it_can<M, N>(model: &M, scanned: &N)
where
    M: GeneratedModel,
    N: DifferentiableModel<Scalar = f64>,
{
    fn of<V: Vector<Bounds>>(bounds: &V, name: &str) -> Bounds {
        V::index_of(name)
            .and_then(|index| bounds.get(index))
            .expect("a component")
    }

    let place = |bounds: Bounds, step| {
        let share = f64::from(step) / f64::from(GRID - 1);
        bounds.min + (bounds.max - bounds.min) * share
    };
    let [over_velocity, over_altitude] =
        ["velocity", "altitude"].map(|name| of(&M::STATE_BOUNDS, name));
    let bounds = ["phi", "delta_e"].map(|name| of(&M::INPUT_BOUNDS, name));
    let mut found = 0;
    for (i, j) in (0..GRID).flat_map(|i| (0..GRID).map(move |j| (i, j))) {
        let (velocity, altitude) = (place(over_velocity, i), place(over_altitude, j));
        let flight = at::<M>(velocity, altitude).within(&M::INPUT_BOUNDS);
        let there = exists(scanned, velocity, altitude, bounds);
        let what = format!("{} at {velocity} ft/s, {altitude} ft", M::NAME);
        match trim(model, &flight) {
            Ok(trim) => {
                assert!(there, "{what}: a trim that the scan does not see");
                assert!(trim.residual_max < 1e-9, "{what}: {}", trim.residual_max);
                found += 1;
            }
            Err(TrimError::Blocked {
                blocking,
                beyond,
                nearest,
            }) => {
                assert!(!there, "{what}: a trim that was not found");
                let at = |name| {
                    nearest
                        .input
                        .iter()
                        .find(|it| it.0 == name)
                        .expect("an input")
                        .1
                };
                assert_eq!(at(blocking[0].input), blocking[0].bound, "{what}");
                let beyond = beyond.expect("far from the bounds there is one");
                let mut outside = beyond.iter().zip(bounds);
                assert!(
                    outside.any(|((_, value), bounds)| !bounds.contains(*value)),
                    "{what}"
                );
            }
            Err(error) => panic!("{what}: {error}"),
        }
    }
    assert!((100..=400).contains(&found), "{}: {found}", M::NAME);
}

/// Level flight at this velocity and altitude.
fn at<M: GeneratedModel>(velocity: f64, altitude: f64) -> SteadyState {
    level::<M>()
        .with("velocity", velocity)
        .with("altitude", altitude)
}

#[test]
fn the_com_trims_over_the_box_wherever_it_can() {
    let rigid = com_rigid::Model::new(&com::NOMINAL);
    trims_wherever_it_can(&com::Model::new(&com::NOMINAL), &rigid);
}

#[test]
fn the_dcom_trims_over_the_box_wherever_it_can() {
    for canard in [Canard::None, Canard::Slaved] {
        let model = dcom_model(canard);
        trims_wherever_it_can(&model, &model);
    }
}

#[test]
fn the_sdcom_trims_over_the_box_wherever_it_can() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    trims_wherever_it_can(&model, &model);
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
