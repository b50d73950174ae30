//! Draws, spreads and slopes against their laws, repeated trims and differences.
#![forbid(unsafe_code)]

mod common;

use ahv_analysis::disperse::{
    Distribution, DrawError, Draws, Group, Kind, SolutionError, Spread, disperse, nominal, slopes,
    solve, spreads,
};
use ahv_analysis::ordered::Control;
use ahv_analysis::sensitivity::RootVectors;
use ahv_core::{GeneratedModel, ParameterSetOf, Vector};
use ahv_models::{com, com_rigid, dcom, sdcom};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::level;
use nalgebra::{Complex, DMatrix};

fn uncertainty() -> dcom::Parameters<f64> {
    dcom::PROVENANCE.map_into(|provenance| provenance.uncertainty)
}

fn index(name: &str) -> usize {
    dcom::Parameters::<f64>::index_of(name).expect("a parameter")
}

fn draws(distribution: Distribution, groups: Vec<Group>) -> Draws {
    Draws::new(dcom::NOMINAL, uncertainty(), distribution, groups, 11).expect("sound")
}

fn group(correlation: f64, names: &[&str]) -> Group {
    Group {
        name: "group".to_owned(),
        parameters: names.iter().map(|name| index(name)).collect(),
        correlation,
    }
}

/// Relative changes of a parameter over members, in units of its uncertainty.
fn changes(draws: &Draws, name: &str, members: u64) -> Vec<f64> {
    let at = index(name);
    let nominal = draws.nominal()[at];
    let change = |member| (draws.member_values(member)[at] / nominal - 1.0) / 0.4;
    (0..members).map(change).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(a, b) / (product(a, a) * product(b, b)).sqrt()
}

/// Moments within five standard errors of those of the law.
#[test]
fn draws_have_their_distribution() {
    const MEMBERS: u64 = 4000;
    let n = MEMBERS as f64;
    for (distribution, variance, fourth) in [
        (Distribution::Uniform, 1.0 / 3.0, 1.0 / 5.0),
        (Distribution::Normal, 1.0 / 9.0, 3.0 / 81.0),
    ] {
        let draws = draws(distribution, Vec::new());
        for name in ["c_l_alpha", "c_m_0", "i_yy"] {
            let sample = changes(&draws, name, MEMBERS);
            let moment = |power| sample.iter().map(|x| x.powi(power)).sum::<f64>() / n;
            assert_abs_diff_eq!(moment(1), 0.0, epsilon = 5.0 * (variance / n).sqrt());
            let error = ((fourth - variance * variance) / n).sqrt();
            assert_abs_diff_eq!(moment(2), variance, epsilon = 5.0 * error);
            let inside = sample.iter().filter(|x| x.abs() <= 1.0).count();
            assert!(inside as f64 >= 0.99 * n);
            if distribution == Distribution::Uniform {
                assert_eq!(inside, sample.len());
            }
        }
        assert_relative_eq!(
            draws.deviation(index("c_l_0")),
            dcom::NOMINAL.c_l_0 * 0.4 * variance.sqrt(),
            max_relative = 1e-14
        );
    }
}

#[test]
fn groups_move_together_as_far_as_asked() {
    const MEMBERS: u64 = 4000;
    let names = ["c_l_alpha", "c_l_delta_e", "c_l_0"];
    for distribution in [Distribution::Uniform, Distribution::Normal] {
        for rho in [0.0, 0.6, 1.0] {
            let draws = draws(distribution, vec![group(rho, &names)]);
            let samples = names.map(|name| changes(&draws, name, MEMBERS));
            let stranger = changes(&draws, "c_m_alpha", MEMBERS);
            // Standard errors are at most 1/sqrt(4000).
            assert_abs_diff_eq!(correlation(&samples[0], &samples[1]), rho, epsilon = 0.06);
            assert_abs_diff_eq!(correlation(&samples[0], &samples[2]), rho, epsilon = 0.06);
            assert_abs_diff_eq!(correlation(&samples[0], &stranger), 0.0, epsilon = 0.06);
            assert_eq!(draws.correlation(index(names[0]), index(names[2])), rho);
            assert_eq!(draws.correlation(index(names[0]), index("c_m_alpha")), 0.0);
            if rho == 1.0 {
                for (a, b) in samples[0].iter().zip(&samples[2]) {
                    assert_abs_diff_eq!(*a, *b, epsilon = 1e-12);
                }
            }
        }
    }
}

#[test]
fn what_is_certain_stays() {
    let draws = draws(Distribution::Uniform, Vec::new());
    let (nominal, drawn) = (dcom::NOMINAL.to_array(), draws.member_values(5));
    let varied = draws.varied();
    for (index, (nominal, drawn)) in nominal.into_iter().zip(drawn).enumerate() {
        assert_eq!(nominal != drawn, varied.contains(&index), "{index}");
    }
    for name in [
        "g",
        "rho_0",
        "spherical_earth",
        "canard_slaving",
        "c_n_1_alpha_2",
    ] {
        assert!(!varied.contains(&index(name)), "{name}");
    }
    assert!(varied.contains(&index("m")));
}

#[test]
fn draws_without_sense_are_refused() {
    let make = |uncertainty, groups| {
        Draws::new(dcom::NOMINAL, uncertainty, Distribution::Uniform, groups, 0).err()
    };
    let negative = dcom::Parameters {
        c_l_0: -0.1,
        ..uncertainty()
    };
    assert!(matches!(
        make(negative, vec![]),
        Some(DrawError::Uncertainty { name: "c_l_0", .. })
    ));
    let beyond = vec![group(1.5, &["c_l_0"])];
    assert!(matches!(
        make(uncertainty(), beyond),
        Some(DrawError::Correlation { .. })
    ));
    let twice = vec![group(0.5, &["c_l_0"]), group(0.5, &["c_m_0", "c_l_0"])];
    assert!(matches!(
        make(uncertainty(), twice),
        Some(DrawError::Twice { name: "c_l_0", .. })
    ));
    let certain = dcom::Parameters::splat(0.0);
    assert_eq!(make(certain, vec![]), Some(DrawError::Nothing));
}

/// Slopes of every quantity against central differences of the whole way: trim, linearisation, roots.
fn slopes_are_those_of_repeated_trims<M: GeneratedModel>(set: &ParameterSetOf<M>) {
    let (centre, uncertainty) = (set.parameters, set.uncertainty());
    let draws = Draws::new(centre, uncertainty, Distribution::Uniform, vec![], 0).expect("sound");
    let about = nominal::<M>(&centre, level::<M>()).expect("it trims");
    let slopes = slopes::<M>(&draws, &about).expect("derivatives");
    for (column, &parameter) in slopes.parameters.iter().enumerate() {
        let value = centre.get(parameter).expect("a parameter");
        let step = 1e-4 * value.abs();
        let values = |step: f64| {
            let mut moved = centre;
            moved.set(parameter, value + step);
            about.values_of(&solve::<M>(&moved, &level::<M>()).expect("it trims"))
        };
        let (above, below) = (values(step), values(-step));
        for (index, quantity) in about.quantities.iter().enumerate() {
            let difference =
                (above[index].expect("a value") - below[index].expect("a value")) / (2.0 * step);
            let slope = slopes.by_quantity[index].as_ref().expect("a simple root")[column];
            // What a change of the parameter by itself does to the quantity, beside the quantity.
            let size =
                (about.values()[index].abs() + (slope * value).abs()).max(1e-3) / value.abs();
            assert!(
                (slope - difference).abs() <= 2e-6 * size,
                "{} {:?} by {}: {slope} {difference}",
                quantity.name,
                quantity.part,
                M::ParametersOf::<f64>::NAMES[parameter]
            );
        }
    }
}

#[test]
fn slopes_of_every_kind_of_model() {
    slopes_are_those_of_repeated_trims::<dcom::Model<f64>>(&dcom::SETS[0]);
    slopes_are_those_of_repeated_trims::<sdcom::Model<f64>>(&sdcom::SETS[1]);
    slopes_are_those_of_repeated_trims::<com::Model<f64>>(&com::SETS[0]);
    slopes_are_those_of_repeated_trims::<com_rigid::Model<f64>>(&com_rigid::SETS[0]);
}

/// λ = −p ± √(p² − q) of λ² + 2pλ + q: ∂λ/∂q = −1/(2(λ + p)).
#[test]
fn a_root_moves_as_its_closed_form() {
    let (p, q) = (0.3, 400.0_f64);
    let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -q, -2.0 * p]);
    let root = Complex::new(-p, (q - p * p).sqrt());
    let by_q = DMatrix::from_row_slice(2, 2, &[0.0, 0.0, -1.0, 0.0]);
    let one = DMatrix::identity(2, 2);
    let slope = RootVectors::new(&matrix, &one, root)
        .expect("simple")
        .slope(&by_q);
    let expected = -Complex::new(0.5, 0.0) / (root + p);
    assert_relative_eq!(slope.re, expected.re, epsilon = 1e-15);
    assert_relative_eq!(slope.im, expected.im, max_relative = 1e-12);
    let double = DMatrix::from_row_slice(2, 2, &[-1.0, 1.0, 0.0, -1.0]);
    assert_eq!(
        RootVectors::new(&double, &one, Complex::new(-1.0, 0.0)),
        None
    );
}

/// Uncertainties of 1 % leave little room for curvature.
#[test]
fn small_uncertainties_spread_as_slopes_say() {
    const MEMBERS: u64 = 300;
    let small = uncertainty().map(|share| 0.025 * share);
    let groups = vec![group(0.8, &["c_l_alpha", "c_m_alpha", "c_l_0"])];
    let draws = Draws::new(dcom::NOMINAL, small, Distribution::Uniform, groups, 4).expect("sound");
    let about = nominal::<dcom::Model<f64>>(&dcom::NOMINAL, level::<dcom::Model<f64>>());
    let about = about.expect("it trims");
    let slopes = slopes::<dcom::Model<f64>>(&draws, &about).expect("derivatives");
    let members = disperse::<dcom::Model<f64>>(&draws, &about, MEMBERS, &Control::default());
    let spreads = spreads(&members, about.quantities.len());
    for (index, (quantity, spread)) in about.quantities.iter().zip(spreads).enumerate() {
        let spread = spread.expect("numbers");
        assert_eq!(spread.count, members.len());
        let linear = slopes.std(index, &draws).expect("slopes");
        if linear < 1e-9 {
            continue;
        }
        let distance = (spread.std - linear).abs();
        assert!(
            distance < 4.5 * spread.std_error.expect("many members") + 0.02 * linear,
            "{} {spread:?} {linear}",
            quantity.name
        );
        let ranked = slopes.ranked(index, &draws);
        assert!(ranked.is_sorted_by(|a, b| a.effect.abs() >= b.effect.abs()));
    }
}

/// The real poles of a mode are numbered from right to left, from 1 on.
#[test]
fn real_poles_of_a_mode_are_numbered_from_the_right() {
    let about = nominal::<dcom::Model<f64>>(&dcom::NOMINAL, level::<dcom::Model<f64>>());
    let about = about.expect("it trims");
    let place = |name: &str| {
        let mut quantities = about.quantities.iter();
        let index = quantities.position(|it| (it.kind, it.name.as_str()) == (Kind::Pole, name));
        about.values()[index.unwrap_or_else(|| panic!("{name}: {:?}", about.quantities))]
    };
    assert!(place("short_period_1") > 0.0 && place("short_period_2") < 0.0);
}

#[test]
fn members_do_not_depend_on_each_other() {
    let draws = draws(
        Distribution::Uniform,
        vec![group(0.5, &["c_l_alpha", "c_l_0"])],
    );
    let about = nominal::<sdcom::Model<f64>>(&dcom::NOMINAL, level::<sdcom::Model<f64>>());
    let about = about.expect("it trims");
    let on = |threads, members| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let run = || disperse::<sdcom::Model<f64>>(&draws, &about, members, &Control::default());
        pool.expect("threads").install(run)
    };
    let (one, two) = (on(1, 40), on(2, 60));
    assert_eq!(one, two[..40]);
    assert_ne!(draws.member_values(1), draws.member_values(2));
    let other = Draws::new(
        dcom::NOMINAL,
        uncertainty(),
        Distribution::Uniform,
        vec![],
        12,
    );
    assert_ne!(
        other.expect("sound").member_values(1),
        draws.member_values(1)
    );
}

/// 40 % of uncertainty: what fails says why, and counts.
#[test]
fn failures_are_counted_with_their_reasons() {
    let draws = draws(Distribution::Uniform, Vec::new());
    let flight = level::<dcom::Model<f64>>().within(&dcom::INPUT_BOUNDS);
    let about = nominal::<dcom::Model<f64>>(&dcom::NOMINAL, flight).expect("it trims");
    let members = disperse::<dcom::Model<f64>>(&draws, &about, 100, &Control::default());
    let failed: Vec<_> = members
        .iter()
        .filter_map(|it| it.solution.as_ref().err())
        .collect();
    assert_eq!(members.len(), 100);
    assert!(!failed.is_empty() && failed.len() < 60, "{}", failed.len());
    for failure in failed {
        assert!(
            failure.to_string().contains("delta_e") || failure.to_string().contains("phi"),
            "{failure}"
        );
    }
    let alpha = spreads(&members, 1)[0].expect("numbers");
    let trimmed = members.iter().filter(|it| it.solution.is_ok()).count();
    assert_eq!(alpha.count, trimmed);
    assert!(about.quantities.iter().any(|it| it.kind == Kind::Zero));
    // Beams heavier than the body they are clamped to.
    let heavy = com::Parameters {
        i_yy: 2e5,
        ..com::NOMINAL
    };
    let broken = solve::<com::Model<f64>>(&heavy, &level::<com::Model<f64>>());
    let broken = broken.expect_err("no such vehicle");
    assert!(matches!(broken, SolutionError::Rule(_)), "{broken:?}");
    assert!(broken.to_string().contains("mass matrix"), "{broken}");
}

#[test]
fn a_spread_has_its_numbers() {
    let sample: Vec<f64> = (0..=100).map(f64::from).collect();
    let spread = Spread::of(&sample).expect("numbers");
    assert_eq!(
        (
            spread.count,
            spread.min,
            spread.p05,
            spread.p50,
            spread.p95,
            spread.max
        ),
        (101, 0.0, 5.0, 50.0, 95.0, 100.0)
    );
    assert_relative_eq!(
        spread.std,
        (101.0 * 102.0 / 12.0_f64).sqrt(),
        max_relative = 1e-12
    );
    // A uniform distribution has a kurtosis of 1.8: the standard error is std * sqrt(0.8 / (4 n)).
    assert_relative_eq!(
        spread.std_error.expect("many numbers"),
        spread.std * (0.2 / 101.0_f64).sqrt(),
        max_relative = 0.03
    );
    assert_eq!(Spread::of(&[1.0]), None);
    let few = Spread::of(&[1.0, 2.0, 4.0]).expect("a spread");
    assert_eq!(
        (few.std_error, few.std_low, few.std_high),
        (None, None, None)
    );
}
