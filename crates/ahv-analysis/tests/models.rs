//! What every model of the package says of itself, and the exact derivatives of its outputs.
#![forbid(unsafe_code)]

mod common;

use ahv_analysis::dual::output_slopes;
use ahv_analysis::trim::trim;
use ahv_core::{Bounds, GeneratedModel, ModelList, ModelVisitor, Sign, Vector};
use ahv_models::{Models, flexible_mode};
use common::level;

/// Its equations are as many as its unknowns and name rows, whatever it names is there, and it trims where nothing is asked for.
#[test]
fn what_every_model_says_of_itself_is_there() {
    struct Sound;

    fn are_there<V: Vector<f64>>(names: &[&str], what: &str) {
        for name in names {
            assert!(V::index_of(name).is_some(), "{what}: {name}");
        }
    }

    impl ModelVisitor for Sound {
        fn visit<M: GeneratedModel>(&mut self) {
            let is_state = |name: &str| M::State::index_of(name).is_some();
            let is_input = |name: &str| M::Input::index_of(name).is_some();
            let is_output = |name: &str| M::OutputsOf::<f64>::index_of(name).is_some();
            let problem = M::TRIM;
            assert_eq!(problem.equations.len(), problem.sought.len(), "{}", M::NAME);
            for equation in problem.equations {
                assert!(is_state(equation.name), "{}: {equation:?}", M::NAME);
                if let Some((row, given)) = equation.like {
                    let mut rows = problem.equations.iter();
                    assert!(rows.any(|it| it.name == row), "{}: {equation:?}", M::NAME);
                    let mut all = problem.given.iter();
                    assert!(all.any(|it| it.name == given), "{}: {equation:?}", M::NAME);
                }
            }
            for given in problem.given {
                assert!(is_state(given.name), "{}: {given:?}", M::NAME);
                let sought = problem.sought.iter().any(|it| it.name == given.name);
                assert!(!sought, "{}: {given:?}", M::NAME);
            }
            for sought in problem.sought {
                let known = is_state(sought.name) || is_input(sought.name);
                assert!(known && sought.scale > 0.0, "{}: {sought:?}", M::NAME);
            }
            are_there::<M::State>(problem.moving, M::NAME);
            for &name in problem.shown {
                let known = is_state(name) || is_input(name) || is_output(name);
                assert!(known, "{}: {name}", M::NAME);
            }
            for mode in M::MODES {
                are_there::<M::State>(mode.states, mode.name);
            }
            are_there::<M::Input>(M::DEFAULT_INPUTS, M::NAME);
            for &name in M::DEFAULT_OUTPUTS {
                assert!(is_state(name) || is_output(name), "{}: {name}", M::NAME);
            }
            for &(name, deviation) in M::DEVIATIONS {
                let known = is_state(name) || is_input(name);
                assert!(known && deviation > 0.0, "{}: {name}", M::NAME);
            }
            for set in M::SETS {
                let broken = M::TABLE.rules.iter().find(|it| !it.holds(&set.parameters));
                assert_eq!(broken, None, "{} {}", M::NAME, set.name);
                let found = trim(&M::with_parameters(&set.parameters), &level::<M>());
                let found = found.unwrap_or_else(|error| panic!("{}: {error}", M::NAME));
                let left = found.residual_max;
                assert!(left < 1e-9, "{}: {left}", M::NAME);
                for name in problem.moving {
                    let index = M::State::index_of(name).expect("a state");
                    assert_eq!(found.residuals.get(index), Some(0.0), "{}: {name}", M::NAME);
                }
            }
        }
    }

    Models::visit(&mut Sound);
}

/// The parameters with another value of one of them.
fn with<P: Vector<f64>>(mut parameters: P, name: &str, value: f64) -> P {
    let index = P::index_of(name).expect("a parameter");
    parameters.set(index, value).expect("a parameter");
    parameters
}

/// A fault is one of the first parameter of the first term: there are values of it that break each rule.
#[test]
fn every_rule_of_every_table_can_be_broken() {
    #[derive(Default)]
    struct Broken(Vec<Sign>);

    impl ModelVisitor for Broken {
        fn visit<M: GeneratedModel>(&mut self) {
            let sound = M::SETS[0].parameters;
            for rule in M::TABLE.rules {
                let what = format!("{}: {}", M::NAME, rule.reason);
                assert!(rule.holds(&sound), "{what}");
                let name = rule.terms[0].parameters[0];
                assert!(!rule.holds(&with(sound, name, f64::NAN)), "{what}");
                let value = match rule.must {
                    Sign::Positive | Sign::NotZero => 0.0,
                    Sign::NotNegative => -1e-3,
                };
                let broken = with(sound, name, value);
                assert!(!rule.holds(&broken), "{what}");
                let others = M::TABLE.rules.iter().filter(|it| !it.holds(&broken));
                assert!(others.count() < M::TABLE.rules.len(), "{what}");
                self.0.push(rule.must);
            }
        }
    }

    let mut broken = Broken::default();
    Models::visit(&mut broken);
    for must in [Sign::Positive, Sign::NotNegative, Sign::NotZero] {
        assert!(broken.0.contains(&must), "{must:?}");
    }
}

/// A vector that lies in the box at this share of its sides.
fn inside<B: Vector<Bounds>, V: Vector<f64>>(bounds: &B, share: f64) -> V {
    V::from_fn(|index| {
        let Bounds { min, max } = bounds.get(index).expect("a component");
        // Where a side is open, any number.
        let value = min + share * (max - min);
        if value.is_finite() { value } else { share }
    })
}

/// f'(0) from six values of f around 0.
fn sixth_order(f: impl Fn(f64) -> f64, step: f64) -> f64 {
    let difference = |k: f64| f(k * step) - f(-k * step);
    (45.0 * difference(1.0) - 9.0 * difference(2.0) + difference(3.0)) / (60.0 * step)
}

/// All slopes of all outputs against central differences.
fn slopes_are_those_of_differences<M: GeneratedModel>(share: f64) -> usize {
    let states = M::State::LEN;
    let names: Vec<&str> = M::State::NAMES
        .iter()
        .chain(M::Input::NAMES)
        .copied()
        .collect();
    let mut moving = 0;
    for set in M::SETS {
        let model = M::generic(&set.parameters);
        let x: M::State = inside(&M::STATE_BOUNDS, share);
        let u: M::Input = inside(&M::INPUT_BOUNDS, share);
        let slopes = output_slopes(&M::with_parameters(&set.parameters), &x, &u);
        assert_eq!(slopes.len(), names.len(), "{}", M::NAME);
        let values = M::outputs(&model, &x, &u);
        for (output, name) in M::OutputsOf::<f64>::NAMES.iter().enumerate() {
            let component = |values: M::OutputsOf<f64>| values.get(output).expect("an output");
            let slope = |variable: usize| component(slopes[variable]);
            let at = |variable: usize| {
                let state = x.get(variable);
                state
                    .or_else(|| u.get(variable - states))
                    .expect("a component")
            };
            let sizes = (0..names.len()).map(|it| slope(it).abs() * at(it).abs().max(1.0));
            let scale = component(values).abs() + sizes.sum::<f64>();
            for (variable, by) in names.iter().enumerate() {
                let moved = |change: f64| {
                    let (mut x, mut u) = (x, u);
                    let value = at(variable) + change;
                    match variable.checked_sub(states) {
                        None => x.set(variable, value),
                        Some(input) => u.set(input, value),
                    }
                    .expect("a component");
                    component(M::outputs(&model, &x, &u))
                };
                let size = at(variable).abs().max(1.0);
                let found = sixth_order(moved, 2e-3 * size);
                assert!(
                    (found - slope(variable)).abs() <= 1e-10 * scale / size,
                    "{}: {name} by {by}: {} and {found}",
                    M::NAME,
                    slope(variable)
                );
                moving += usize::from(slope(variable) != 0.0);
            }
        }
    }
    moving
}

#[test]
fn slopes_of_outputs_are_those_of_differences() {
    struct Differences;

    impl ModelVisitor for Differences {
        fn visit<M: GeneratedModel>(&mut self) {
            for share in [0.37, 0.71] {
                let moving = slopes_are_those_of_differences::<M>(share);
                assert!(moving > 0, "{}: nothing moves", M::NAME);
            }
        }
    }

    Models::visit(&mut Differences);
}

/// Of those that the package has no function for, the closed form; the others are compared with their functions in
/// `tests/build.rs`.
#[test]
fn outputs_without_a_function_are_their_closed_form() {
    struct Theta(usize);

    impl ModelVisitor for Theta {
        fn visit<M: GeneratedModel>(&mut self) {
            let x: M::State = inside(&M::STATE_BOUNDS, 0.37);
            let u: M::Input = inside(&M::INPUT_BOUNDS, 0.37);
            let model = M::generic(&M::SETS[0].parameters);
            let outputs = M::outputs(&model, &x, &u);
            let state = |name| M::State::index_of(name).and_then(|index| x.get(index));
            let theta = M::OutputsOf::<f64>::index_of("theta").and_then(|it| outputs.get(it));
            let expected = state("gamma").zip(state("alpha"));
            assert_eq!(theta, expected.map(|(gamma, alpha)| gamma + alpha));
            self.0 += usize::from(theta.is_some());
        }
    }

    let mut theta = Theta(0);
    Models::visit(&mut theta);
    assert_eq!(theta.0, 6);
    let p = flexible_mode::NOMINAL;
    let (x, u) = (Vector::splat(0.3), flexible_mode::Input { force: 7.0 });
    let model = flexible_mode::Model::new(&p);
    let eta = <flexible_mode::Model<f64> as GeneratedModel>::outputs(&model, &x, &u).eta_static;
    assert!((eta - 7.0 / (p.omega * p.omega)).abs() <= 1e-16);
}
