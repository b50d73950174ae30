//! States that decay by themselves: coloured noise, which steppers treat exactly.

use super::{Dag, Id, Kind, Node};
use crate::ir;

/// States whose rate is minus what depends on parameters alone times themselves, each with that rate of decay.
pub(crate) fn rates(model: &ir::Model, dag: &mut Dag, roots: &[Vec<Id>]) -> Vec<(String, Id)> {
    let mut found = Vec::new();
    let functions = model.functions.iter().zip(roots);
    for (function, roots) in functions.filter(|(function, _)| function.name == "drift") {
        let entries = function.outputs.iter().flat_map(|output| &output.entries);
        for (entry, &root) in entries.zip(roots) {
            if let Some(rate) = rate(dag, root, &entry.at[0]) {
                found.push((entry.at[0].clone(), rate));
            }
        }
    }
    found
}

fn rate(dag: &mut Dag, id: Id, state: &str) -> Option<Id> {
    let Node::Product(-1.0, factors) = dag.node(id).clone() else {
        return None;
    };
    let is_state =
        |&id: &Id| matches!(dag.node(id), Node::Leaf(Kind::State, name) if name == state);
    let (own, others): (Vec<Id>, Vec<Id>) = factors.into_iter().partition(is_state);
    let is_rate = !others.is_empty() && others.iter().all(|&id| dag.is_parametric(id));
    match others.as_slice() {
        _ if own.len() != 1 || !is_rate => None,
        &[rate] => Some(rate),
        several => Some(dag.product(1.0, several)),
    }
}

#[cfg(test)]
mod tests {
    use super::rates;
    use crate::graph::Dag;
    use crate::graph::passes::Passes;
    use crate::ir::Model;
    use crate::testing::{Point, choices_of_passes, model_with, value_of_node};

    /// A model whose functions, in order, give the state `a` these rates.
    fn model(functions: &[(&str, &str)]) -> Model {
        let text = functions.iter().map(|(name, expr)| {
            format!(
                r#"{{"name": "{name}", "group": "g", "doc": "", "equation": "", "outputs": [{{"name": "", "basis": ["state"],
                "unit": null, "entries": [{{"at": ["a"], "expr": {expr}}}]}}]}}"#
            )
        });
        let text = text.collect::<Vec<_>>().join(", ");
        model_with("", &text)
    }

    /// The states of a model that count as coloured noise, each with the value of its decay rate at d = 3, e = 5.
    fn found(model: &Model, passes: &Passes) -> Vec<(String, f64)> {
        let mut dag = Dag::new(model, passes).unwrap();
        let functions = model.functions.iter();
        let roots: Vec<_> = functions.map(|f| dag.roots(f).unwrap()).collect();
        let at = Point::from([("p.d".to_owned(), 3.0), ("p.e".to_owned(), 5.0)]);
        rates(model, &mut dag, &roots)
            .into_iter()
            .map(|(state, rate)| (state, value_of_node(&dag, rate, &at)))
            .collect()
    }

    #[test]
    fn coloured_noise_decays_with_a_rate_of_parameters_alone() {
        for (drift, rate) in [
            (r#"["neg", ["*", "p.d", "x.a"]]"#, 3.0),
            (r#"["*", "x.a", ["neg", "p.d"]]"#, 3.0),
            (r#"["neg", ["*", "p.d", "x.a", "p.e"]]"#, 15.0),
            (r#"["neg", ["/", "x.a", "p.e"]]"#, 0.2),
            (r#"["neg", ["*", ["+", "p.d", "p.e"], "x.a"]]"#, 8.0),
        ] {
            for passes in choices_of_passes() {
                let found = found(&model(&[("drift", drift)]), &passes);
                assert_eq!(found, [("a".to_owned(), rate)], "{drift}, {passes:?}");
            }
        }
    }

    /// The scheme and the drift share one prepared value, also where equal expressions are several values.
    #[test]
    fn the_rate_is_the_value_that_the_drift_takes() {
        let model = model(&[("drift", r#"["neg", ["/", "x.a", "p.e"]]"#)]);
        for passes in choices_of_passes() {
            let mut dag = Dag::new(&model, &passes).unwrap();
            let roots = vec![dag.roots(&model.functions[0]).unwrap()];
            let (_, rate) = rates(&model, &mut dag, &roots)[0];
            assert!(dag.operands(roots[0][0]).contains(&rate), "{passes:?}");
        }
    }

    /// Each of these, stepped as coloured noise, would be a wrong simulation.
    #[test]
    fn a_state_that_does_not_decay_by_itself_is_no_coloured_noise() {
        for drift in [
            // It grows, it is constant, it has another power.
            r#"["*", "p.d", "x.a"]"#,
            r#"["neg", "p.d"]"#,
            r#"["neg", ["*", "p.d", "p.e"]]"#,
            r#"["neg", ["*", "p.d", "x.a", "x.a"]]"#,
            r#"["neg", ["/", "p.d", "x.a"]]"#,
            // Another state, an input or a time is in the rate.
            r#"["neg", ["*", "p.d", "x.b"]]"#,
            r#"["neg", ["*", "x.a", "x.b"]]"#,
            r#"["neg", ["*", "p.d", "x.a", "x.b"]]"#,
            r#"["neg", ["*", "p.d", "x.a", "u.a"]]"#,
            r#"["neg", ["*", "p.d", "x.a", "t.lag"]]"#,
            // The name of the state as a name of something else.
            r#"["neg", ["*", "p.d", "u.a"]]"#,
            r#"["neg", ["*", "p.d", "p.a"]]"#,
            // Something is added.
            r#"["-", "u.c", ["*", "p.d", "x.a"]]"#,
            // No parameter holds the rate.
            r#"["neg", "x.a"]"#,
        ] {
            for passes in choices_of_passes() {
                let found = found(&model(&[("drift", drift)]), &passes);
                assert_eq!(found, [], "{drift}, {passes:?}");
            }
        }
    }

    #[test]
    fn only_the_drift_says_how_a_state_moves() {
        let decays = r#"["neg", ["*", "p.d", "x.a"]]"#;
        let (drift, other) = (("drift", decays), ("ito_correction", "\"p.e\""));
        for functions in [[drift, other], [other, drift]] {
            let found = found(&model(&functions), &Passes::default());
            assert_eq!(found, [("a".to_owned(), 3.0)]);
        }
        let found = found(
            &model(&[("drift", "\"u.c\""), ("ito_correction", decays)]),
            &Passes::default(),
        );
        assert_eq!(found, []);
    }
}
