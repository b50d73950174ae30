//! States that decay by themselves: coloured noise, which steppers treat exactly.

use crate::dag::{Dag, Id, Kind, Node};
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
