//! Linear systems, poles and zeros against SciPy's on an independent derivation, and against numbers of the paper.
#![forbid(unsafe_code)]

#[path = "../common/mod.rs"]
mod common;
mod zeros;

use std::fs;

use ahv_analysis::linearize::{LinearSystem, LinearizeError, linearize, with_outputs};
use ahv_analysis::poles::{Pole, damping, frequency, poles, zeros};
use ahv_analysis::trim::{SteadyState, trim};
use ahv_core::{GeneratedModel, Vector};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::level;
use nalgebra::{Complex, DMatrix};
use zeros::assert_near;

/// Inputs and outputs of a vehicle where none are asked for.
const INPUTS: &[&str] = <dcom::Model<f64>>::DEFAULT_INPUTS;
const OUTPUTS: &[&str] = <dcom::Model<f64>>::DEFAULT_OUTPUTS;

/// What SciPy found for a model and a set.
struct Reference {
    model: String,
    set: String,
    state: Vec<f64>,
    input: Vec<f64>,
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    poles: Vec<Complex<f64>>,
    zeros: Vec<Complex<f64>>,
}

fn references() -> Vec<Reference> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/roots.txt");
    let text = fs::read_to_string(path).expect("the vectors are there");
    let lines: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|it| it.split(',').collect())
        .collect();
    lines.chunks_exact(7).map(reference).collect()
}

fn reference(rows: &[Vec<&str>]) -> Reference {
    let numbers = |name: &str| -> Vec<f64> {
        let row = rows.iter().find(|row| row[0] == name).expect("a row");
        row[1..]
            .iter()
            .map(|it| it.parse().expect("a number"))
            .collect()
    };
    let matrix = |name: &str| {
        let numbers = numbers(name);
        DMatrix::from_row_slice(numbers[0] as usize, numbers[1] as usize, &numbers[2..])
    };
    let roots = |name: &str| -> Vec<Complex<f64>> {
        let parts = numbers(name);
        parts
            .chunks_exact(2)
            .map(|it| Complex::new(it[0], it[1]))
            .collect()
    };
    Reference {
        model: rows[0][1].to_owned(),
        set: rows[0][2].to_owned(),
        state: numbers("state"),
        input: numbers("input"),
        a: matrix("A"),
        b: matrix("B"),
        poles: roots("poles"),
        zeros: roots("zeros"),
    }
}

impl Reference {
    /// The system of the vectors, its states and outputs by name.
    fn system(&self, states: &[&'static str]) -> LinearSystem {
        let output =
            |row: usize, column: usize| f64::from(u8::from(states[column] == OUTPUTS[row]));
        LinearSystem {
            states: states.to_vec(),
            inputs: INPUTS.to_vec(),
            outputs: OUTPUTS.to_vec(),
            a: self.a.clone(),
            b: self.b.clone(),
            c: DMatrix::from_fn(2, states.len(), output),
            d: DMatrix::zeros(2, 2),
        }
    }
}

/// Every root has a partner of its own among `expected`, to 1e-12 of the largest.
fn assert_same(found: &[Complex<f64>], expected: &[Complex<f64>], what: &str) {
    assert_eq!(
        found.len(),
        expected.len(),
        "{what}: {found:?}, not {expected:?}"
    );
    let tolerance = 1e-12 * expected.iter().map(|&it| frequency(it)).fold(1.0, f64::max);
    let mut left = expected.to_vec();
    for &root in found {
        let nearest = (0..left.len())
            .min_by(|&i, &j| frequency(left[i] - root).total_cmp(&frequency(left[j] - root)));
        let partner = left.swap_remove(nearest.expect("as many"));
        // A root near 0 that is nearly double moves by the root of the rounding.
        assert!(
            frequency(partner - root) < tolerance,
            "{what}: {root}, not {partner}"
        );
    }
}

fn values(poles: &[Pole]) -> Vec<Complex<f64>> {
    poles.iter().map(|pole| pole.value).collect()
}

#[test]
fn poles_and_zeros_are_scipys_on_the_same_matrices() {
    for reference in references() {
        let states: &[&'static str] = match reference.model.as_str() {
            "com" => &com::State::<f64>::NAMES,
            "com_rigid" => &com_rigid::State::<f64>::NAMES,
            "dcom" => &dcom::State::<f64>::NAMES,
            _ => &sdcom::State::<f64>::NAMES,
        };
        let what = format!("{} {}", reference.model, reference.set);
        let system = reference.system(states);
        let found = values(&poles(&system, &[]).expect("poles"));
        assert_same(&found, &reference.poles, &what);
        let found = zeros(&system).expect("zeros");
        let finite: Vec<_> = found.finite.iter().map(|it| it.value).collect();
        assert_same(&finite, &reference.zeros, &what);
        assert_eq!(found.infinite_orders, [1, 1], "{what}");
        assert_eq!(
            (finite.len(), found.infinite(), found.normal_rank),
            (states.len() - 2, 4, 2),
            "{what}"
        );
    }
}

fn trimmed<M: GeneratedModel>(model: &M) -> (M::State, M::Input) {
    let trim = trim(model, &level::<M>()).expect("the model trims");
    (trim.state, trim.input)
}

/// From its default inputs to its default outputs.
fn system<M: GeneratedModel>(model: &M) -> LinearSystem {
    let (x, u) = trimmed(model);
    linearize(model, &x, &u, M::DEFAULT_INPUTS, M::DEFAULT_OUTPUTS).expect("the model is smooth")
}

fn poles_of<M: GeneratedModel>(model: &M) -> Vec<Pole> {
    poles(&system(model), M::MODES).expect("poles")
}

/// Trim, A and B are those that SciPy finds with an independent derivation.
fn agrees<M: GeneratedModel>(model: &M, set: &str) {
    let references = references();
    let mut references = references.iter();
    let reference = references.find(|it| it.model == M::NAME && it.set == set);
    let reference = reference.expect("the case is in the vectors");
    let (x, u) = trimmed(model);
    for (index, expected) in reference.state.iter().enumerate() {
        let found = x.get(index).expect("a component");
        assert_abs_diff_eq!(found, *expected, epsilon = 1e-9);
    }
    for (index, expected) in reference.input.iter().enumerate() {
        assert_abs_diff_eq!(
            u.get(index).expect("a component"),
            *expected,
            epsilon = 1e-9
        );
    }
    let system = system(model);
    for (found, expected) in [(&system.a, &reference.a), (&system.b, &reference.b)] {
        for (found, expected) in found.iter().zip(expected) {
            assert_relative_eq!(*found, *expected, max_relative = 1e-8, epsilon = 1e-9);
        }
    }
}

#[test]
fn trims_and_linear_systems_are_those_of_the_independent_derivation() {
    agrees(&com::Model::new(&com::NOMINAL), "section5.1");
    agrees(&com_rigid::Model::new(&com::NOMINAL), "section5.1");
    agrees(&dcom::Model::new(&dcom::NOMINAL), "section5.1");
    agrees(&dcom::Model::new(&dcom::SECTION5_3), "section5.3");
    agrees(&sdcom::Model::new(&dcom::NOMINAL), "section5.1");
    agrees(&sdcom::Model::new(&dcom::SECTION5_3), "section5.3");
}

/// The poles of `mode`.
fn of(mode: &str, poles: &[Pole]) -> Vec<Complex<f64>> {
    let those = poles.iter().filter(|pole| pole.mode == Some(mode));
    those.map(|pole| pole.value).collect()
}

/// The real short-period poles, stable and unstable.
fn short_period(poles: &[Pole]) -> (f64, f64) {
    let mut real: Vec<f64> = of("short period", poles).iter().map(|it| it.re).collect();
    real.sort_by(f64::total_cmp);
    assert_eq!(real.len(), 2, "{poles:?}");
    (real[0], real[1])
}

#[test]
fn modes_are_told_by_participation() {
    let found = poles_of(&dcom::Model::new(&dcom::SECTION5_3));
    // Table 3 prints -3.97 and +3.86.
    let (stable, unstable) = short_period(&found);
    assert_abs_diff_eq!(stable, -3.9694, epsilon = 6e-5);
    assert_abs_diff_eq!(unstable, 3.8612, epsilon = 6e-5);
    for (mode, real, imaginary) in [
        ("flexible 1", -0.41, 20.5),
        ("flexible 2", -1.05, 52.5),
        ("flexible 3", -2.10, 105.0),
    ] {
        let pair = of(mode, &found);
        assert_eq!(pair.len(), 2, "{found:?}");
        for pole in pair {
            assert_abs_diff_eq!(pole.re, real, epsilon = 0.01);
            assert_abs_diff_eq!(pole.im.abs(), imaginary, epsilon = 0.1);
            assert_abs_diff_eq!(damping(pole), 0.02, epsilon = 1e-4);
        }
    }
    assert_eq!(of("phugoid", &found).len(), 2);
    assert_eq!(of("height", &found).len(), 1);
    assert!(
        found.iter().all(|pole| pole.participation > 0.5),
        "{found:?}"
    );
}

/// Participation factors are pure numbers: those of the model in SI are the same.
#[test]
fn participation_does_not_depend_on_units() {
    let feet = com::NOMINAL;
    let mut factors = com::Parameters::<f64>::SI_FACTORS.iter();
    let metres = feet.map(|value| value * factors.next().expect("a factor for each"));
    let model = com::Model::new(&metres);
    let factor = |name: &str| {
        let states = com::State::<f64>::index_of(name).map(|it| com::State::<f64>::SI_FACTORS[it]);
        states.unwrap_or(1.0)
    };
    let flight = SteadyState::converted(&<com::Model<f64>>::TRIM, factor);
    let trim = trim(&model, &flight).expect("the model trims in SI");
    let in_si = linearize(&model, &trim.state, &trim.input, &[], &[]).expect("smooth");
    let found = poles_of(&com::Model::new(&feet));
    let found_in_si = poles(&in_si, <com::Model<f64>>::MODES).expect("poles in SI");
    for (pole, in_si) in found.iter().zip(&found_in_si) {
        assert_eq!(pole.mode, in_si.mode);
        assert_abs_diff_eq!(pole.participation, in_si.participation, epsilon = 1e-7);
    }
}

#[test]
fn coloured_noise_and_gust_have_their_own_decay_rates() {
    let p = dcom::NOMINAL;
    let found = poles_of(&sdcom_gust::Model::new(&p));
    let modes = [
        ("coloured noise 1", p.omega_1 * p.zeta_1),
        ("coloured noise 2", p.omega_2 * p.zeta_2),
        ("coloured noise 3", p.omega_3 * p.zeta_3),
    ];
    for (mode, decay) in modes {
        let pole = of(mode, &found);
        assert_relative_eq!(pole[0].re, -decay, max_relative = 1e-12);
    }
    let gust = of("gust", &found);
    assert_relative_eq!(gust[0].re, -1.0 / p.gust_time, max_relative = 1e-12);
}

#[test]
fn the_rigid_com_has_the_recomputed_short_period() {
    let found = poles_of(&com_rigid::Model::new(&com_rigid::NOMINAL));
    let (stable, unstable) = short_period(&found);
    assert_abs_diff_eq!(stable, -1.764, epsilon = 6e-4);
    assert_abs_diff_eq!(unstable, 1.694, epsilon = 6e-4);
}

#[test]
fn inertia_does_most_of_the_short_period_of_section_5_3() {
    let (heavy, light) = (dcom::NOMINAL, dcom::SECTION5_3);
    for (m, i_yy, stable, unstable) in [
        (heavy.m, light.i_yy, -4.134, 4.065),
        (heavy.m, heavy.i_yy, -1.742, 1.673),
    ] {
        let parameters = dcom::Parameters { m, i_yy, ..light };
        let found = poles_of(&dcom::Model::new(&parameters));
        let found = short_period(&found);
        assert_abs_diff_eq!(found.0, stable, epsilon = 6e-4);
        assert_abs_diff_eq!(found.1, unstable, epsilon = 6e-4);
    }
}

#[test]
fn what_cannot_be_is_a_typed_error() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let (x, u) = trimmed(&model);
    let unknown = linearize(&model, &x, &u, &["delta_f"], OUTPUTS);
    assert_eq!(
        unknown,
        Err(LinearizeError::UnknownInput("delta_f".to_owned()))
    );
    let unknown = linearize(&model, &x, &u, INPUTS, &["theta"]);
    assert_eq!(
        unknown,
        Err(LinearizeError::UnknownOutput("theta".to_owned()))
    );
    let still = dcom::State { velocity: 0.0, ..x };
    let still = linearize(&model, &still, &u, INPUTS, OUTPUTS);
    assert!(
        matches!(still, Err(LinearizeError::NonFinite { .. })),
        "{still:?}"
    );
}

fn with<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    outputs: &[&str],
) -> Result<LinearSystem, LinearizeError> {
    let (x, u) = trimmed(&M::with_parameters(parameters));
    let owned = |names: &[&str]| -> Vec<String> { names.iter().map(ToString::to_string).collect() };
    with_outputs::<M>(
        parameters,
        &x,
        &u,
        &owned(M::DEFAULT_INPUTS),
        &owned(outputs),
    )
}

/// θ = γ + α: its row of C says so, and its zeros are those of the same system with θ in the place of the state α.
#[test]
fn an_output_that_is_no_state_has_its_zeros() {
    let system = with::<dcom::Model<f64>>(&dcom::NOMINAL, &["velocity", "theta"]);
    let system = system.expect("the model is smooth");
    assert_eq!(system.outputs, ["velocity", "theta"]);
    let index = |name: &str| dcom::State::<f64>::index_of(name).expect("a state");
    for (column, entry) in system.c.row(1).iter().enumerate() {
        let expected = column == index("gamma") || column == index("alpha");
        assert_eq!(
            *entry,
            f64::from(u8::from(expected)),
            "{}",
            system.states[column]
        );
    }
    assert_eq!(system.d, DMatrix::zeros(2, 2));
    let found = zeros(&system).expect("zeros");
    // With S x = (…, γ + α, …) the system is S A S⁻¹, S B, C S⁻¹, in which θ is a state.
    let mut to = DMatrix::identity(11, 11);
    to[(index("alpha"), index("gamma"))] = 1.0;
    let from = to.clone().try_inverse().expect("regular");
    let moved = LinearSystem {
        a: &to * &system.a * &from,
        b: &to * &system.b,
        c: &system.c * &from,
        ..system.clone()
    };
    let theta = moved.c.row(1);
    assert!(
        theta
            .iter()
            .enumerate()
            .all(|(it, c)| (*c == 1.0) == (it == index("alpha")))
    );
    let expected = zeros(&moved).expect("zeros");
    assert_eq!(found.infinite_orders, expected.infinite_orders);
    let [found, expected] = [found, expected].map(|zeros| {
        let values = zeros.finite.iter().map(|it| it.value);
        values.collect::<Vec<_>>()
    });
    assert!(!found.is_empty());
    assert_near(&found, &expected, "theta");
    // The poles do not know of outputs.
    let default = poles_of(&dcom::Model::new(&dcom::NOMINAL));
    assert_eq!(
        poles(&system, <dcom::Model<f64>>::MODES).expect("poles"),
        default
    );
}

/// States are rows of 0 and 1 as before, and an output that depends on an input has a direct path.
#[test]
fn outputs_may_be_states_and_others_at_once() {
    let mixed = with::<com::Model<f64>>(&com::NOMINAL, &["gamma", "lift", "velocity"]);
    let mixed = mixed.expect("the model is smooth");
    let plain = system(&com::Model::new(&com::NOMINAL));
    assert_eq!((&mixed.a, &mixed.b), (&plain.a, &plain.b));
    assert_eq!(mixed.c.row(0), plain.c.row(1));
    assert_eq!(mixed.c.row(2), plain.c.row(0));
    let (x, u) = trimmed(&com::Model::new(&com::NOMINAL));
    let p = com::NOMINAL;
    let density = p.rho_0 * ((p.h_0 - x.altitude) / p.h_s).exp();
    let force = 0.5 * density * x.velocity * x.velocity * p.s;
    let c_l = p.c_l_0 + p.c_l_alpha * x.alpha + p.c_l_delta_e * u.delta_e;
    for (found, expected) in [
        (mixed.d[(1, 0)], 0.0),
        (mixed.d[(1, 1)], force * p.c_l_delta_e),
        (mixed.c[(1, 0)], 2.0 * force * c_l / x.velocity),
        (mixed.c[(1, 1)], -force * c_l / p.h_s),
        (mixed.c[(1, 3)], force * p.c_l_alpha),
    ] {
        assert_relative_eq!(found, expected, max_relative = 1e-12);
    }
    assert_eq!(
        with::<com::Model<f64>>(&com::NOMINAL, &["theta", "height"]),
        Err(LinearizeError::UnknownOutput("height".to_owned()))
    );
}

/// Flows between tanks keep what all of them hold: one pole is 0, and rounding does not hide it; the others are stable.
/// From eight tanks on rounding is below a tenth of what it may be.
#[test]
fn what_is_conserved_has_a_pole_at_zero() {
    for (size, step) in (8..=16).flat_map(|size| (1..=6).map(move |step| (size, step))) {
        // Whole numbers, so that each column's sum is 0 exactly.
        let flow = |to: usize, from: usize| ((step * (7 + 5 * to * to + 3 * from)) % 13 + 1) as f64;
        let mut a = DMatrix::from_fn(size, size, flow);
        for tank in 0..size {
            a[(tank, tank)] -= a.column(tank).sum();
        }
        let system = LinearSystem {
            states: vec!["tank"; size],
            inputs: Vec::new(),
            outputs: Vec::new(),
            a,
            b: DMatrix::zeros(size, 0),
            c: DMatrix::zeros(0, size),
            d: DMatrix::zeros(0, 0),
        };
        let found = values(&poles(&system, &[]).expect("poles"));
        assert_eq!(found[0], Complex::new(0.0, 0.0), "{size} {step}");
        assert!(found[1..].iter().all(|pole| pole.re < -1.0), "{found:?}");
    }
}
