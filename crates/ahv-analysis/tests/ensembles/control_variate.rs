//! The linear companions of members, and what is estimated with them.

use ahv_analysis::monte_carlo::{Experiment, Outcome, Scheme, StateSpread};
use ahv_analysis::ordered::Control;
use ahv_analysis::statistics::student_95;
use ahv_core::{Model as _, StochasticModel as _, Vector as _};
use ahv_models::sdcom;

use super::monte_carlo::{INPUT, STATE, Sdcom, experiment, index};

const STEPS: u64 = 100;
const DT: f64 = 2e-3;
/// Coloured noise.
const MODE: &str = "chi_1";

fn beside(scheme: Scheme) -> Experiment {
    let mut experiment = Experiment {
        control_variate: true,
        ..experiment(scheme, DT, vec![0, STEPS / 2, STEPS])
    };
    // Some start beside the nominal flight.
    experiment.state[1][index("altitude")] = 20.0;
    experiment
}

fn run(experiment: &Experiment, members: u64, threads: usize) -> Outcome {
    let engine = experiment.engine::<Sdcom>().expect("the scheme goes");
    let outcome = engine.run(members, threads, &Control::default());
    outcome.expect("it goes")
}

/// The states at the end, member by member, and those of the companions.
fn pairs(experiment: &Experiment, members: u64, state: &str) -> Vec<[f64; 2]> {
    let engine = experiment.engine::<Sdcom>().expect("the scheme goes");
    let (mut pairs, state) = (Vec::new(), index(state));
    let outcome = engine.run_and_list(members, 1, &Control::default(), |_, seen| {
        pairs.extend(seen.iter().map(|seen| {
            let member = seen.state(2).expect("none is lost")[state];
            [member, seen.companion[16 + state]]
        }));
    });
    outcome.expect("it goes");
    pairs
}

fn at_the_end(outcome: &Outcome, state: &str) -> StateSpread {
    outcome.snapshots[2].states[index(state)].clone()
}

/// Coloured noise in Euler's steps, c⁺ = (1 − a dt) c + b √dt ξ, is its own companion, and the variance is that of this recursion.
#[test]
fn a_linear_state_is_its_own_companion() {
    let experiment = beside(Scheme::EulerMaruyama);
    for [member, companion] in pairs(&experiment, 64, MODE) {
        assert!((member - companion).abs() < 1e-9 * (1e-3 + companion.abs()));
    }
    let model = Sdcom::new(&sdcom::NOMINAL);
    let off = sdcom::State {
        chi_1: 1.0,
        ..STATE
    };
    let decay = -model.drift(&off, &INPUT).chi_1;
    let intensity = |channel| {
        let mut dw = sdcom::Noise::splat(0.0);
        dw.set(channel, 1.0).expect("a channel");
        model.noise_increment(&off, &INPUT, &dw).chi_1
    };
    let power: f64 = (0..sdcom::Noise::<f64>::LEN)
        .map(|channel| intensity(channel).powi(2))
        .sum();
    let mut variance = 0.0;
    for _ in 0..STEPS {
        variance = (1.0 - decay * DT).powi(2) * variance + power * DT;
    }
    let found = at_the_end(&run(&experiment, 512, 1), MODE)
        .std
        .expect("an estimate");
    let value = found.value.expect("a value");
    assert!((value / variance.sqrt() - 1.0).abs() < 1e-6, "{value}");
    assert!(found.holds(variance.sqrt()), "{found:?}");
}

/// The numbers of the method in the plain form of textbooks, from the members one by one.
#[test]
fn estimates_are_those_of_the_regression() {
    let members = 500;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    for state in ["velocity", "alpha"] {
        let experiment = beside(Scheme::Heun);
        let pairs = pairs(&experiment, members, state);
        let [y, x] = [0, 1].map(|place| pairs.iter().map(|it| it[place]).collect::<Vec<_>>());
        let n = members as f64;
        // Of the pairs (y, x) with a mean of x that is known: estimate, its error, and what remains.
        let regressed = |y: &[f64], x: &[f64], known: f64, about: bool| {
            let (my, mx) = (mean(y), mean(x));
            let sum = |a: &[f64], ma: f64, b: &[f64], mb: f64| -> f64 {
                a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum()
            };
            let (yy, xy, xx) = (sum(y, my, y, my), sum(y, my, x, mx), sum(x, mx, x, mx));
            let rest = yy - xy * xy / xx;
            let off = if about {
                (mx - known).powi(2) / xx
            } else {
                0.0
            };
            let error = (rest / (n - 2.0) * (1.0 / n + off)).sqrt();
            (my - xy / xx * (mx - known), error, rest / yy)
        };
        let found = at_the_end(&run(&experiment, members, 1), state);
        let remains = found.remains.expect("it was used");
        let near = |a: f64, b: f64, tolerance: f64| {
            assert!((a - b).abs() <= tolerance * b.abs(), "{state}: {a} and {b}");
        };
        let (value, error, rest) = regressed(&y, &x, 0.0, true);
        let told = found.mean.expect("a mean");
        near(told.value, value, 1e-12);
        near(
            0.5 * (told.high - told.low),
            student_95(n - 2.0) * error,
            1e-4,
        );
        near(remains.mean, rest, 1e-4);
        // Of the squares; what is known of them is not told.
        let squares = |values: &[f64]| {
            let mean = mean(values);
            values
                .iter()
                .map(|it| (it - mean).powi(2))
                .collect::<Vec<_>>()
        };
        let (qy, qx) = (squares(&y), squares(&x));
        let (_, error, rest) = regressed(&qy, &qx, 0.0, false);
        near(remains.std, rest, 1e-3);
        let told = found.std.expect("a deviation");
        let [value, low, high] = [told.value, told.low, told.high].map(|it| it.expect("a number"));
        near(
            (high / low).ln(),
            student_95(n - 2.0) * error / value.powi(2),
            1e-3,
        );
    }
}

#[test]
fn it_narrows_intervals_and_agrees_with_many_members() {
    for scheme in [Scheme::Splitting, Scheme::Heun, Scheme::EulerMaruyama] {
        let with = run(&beside(scheme), 600, 2);
        let many = run(
            &Experiment {
                control_variate: false,
                ..beside(scheme)
            },
            20_000,
            2,
        );
        for state in ["velocity", "altitude", "gamma", "alpha", "pitch_rate"] {
            let (with, many) = (at_the_end(&with, state), at_the_end(&many, state));
            let (few, plenty) = (with.std.expect("few"), many.std.expect("many"));
            let width = |it: &ahv_analysis::statistics::OpenEstimate| {
                it.high.expect("an end") - it.low.expect("an end")
            };
            assert!(
                width(&few) < width(&plenty),
                "{scheme:?}, {state}: {few:?}, {plenty:?}"
            );
            // Both hold the truth, but for one in twenty each.
            let apart = (few.value.expect("few") - plenty.value.expect("many")).abs();
            assert!(
                apart < 1.5 * (width(&few) + width(&plenty)) / 2.0,
                "{state}"
            );
            let (few, plenty) = (with.mean.expect("few"), many.mean.expect("many"));
            let reach = 0.5 * (few.high - few.low + plenty.high - plenty.low);
            assert!((few.value - plenty.value).abs() < 1.5 * reach, "{state}");
        }
    }
}

#[test]
fn estimates_have_the_same_bits_whatever_the_threads() {
    let told = |threads| {
        let outcome = run(&beside(Scheme::Splitting), 700, threads);
        let states = outcome.snapshots.into_iter().flat_map(|it| it.states);
        let told = states.map(|it| (it.mean, it.std, it.remains));
        (outcome.digest, told.collect::<Vec<_>>())
    };
    assert_eq!(told(1), told(2));
    let plain = Experiment {
        control_variate: false,
        ..beside(Scheme::Splitting)
    };
    assert_eq!(
        run(&plain, 700, 2).digest,
        told(2).0,
        "members fly as they do"
    );
}

/// Who is left of members that were lost is no sample of what is known of their companions.
#[test]
fn where_members_are_lost_the_sample_speaks_for_itself() {
    let mut experiment = beside(Scheme::EulerMaruyama);
    experiment.state[1][index("altitude")] = 2e5;
    let with = run(&experiment, 512, 2);
    assert!(with.lost > 0);
    experiment.control_variate = false;
    let without = run(&experiment, 512, 2);
    for (with, without) in with.snapshots[2]
        .states
        .iter()
        .zip(&without.snapshots[2].states)
    {
        assert_eq!(with.remains, None);
        assert_eq!((with.mean, with.std), (without.mean, without.std));
    }
    // And where they are too few.
    assert_eq!(
        at_the_end(&run(&beside(Scheme::EulerMaruyama), 499, 1), "alpha").remains,
        None
    );
    assert!(
        at_the_end(&run(&beside(Scheme::EulerMaruyama), 500, 1), "alpha")
            .remains
            .is_some()
    );
}
