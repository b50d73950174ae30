//! What each pass does to the number of operations of a model.

use std::collections::HashMap;

use crate::EmitError;
use crate::graph::passes::{Pass, Passes};
use crate::graph::{Dag, Id};
use crate::ir::{Function, Model};

use super::given::Given;
use super::{Cost, Prepared, body};

/// The functions that are counted, where a model has them.
const COUNTED: [&str; 5] = [
    "drift",
    "drift_and_jacobians",
    "hessian",
    "drift_and_diffusion",
    "drift_and_noise_increment",
];

/// The operations of a function, or of `prepare` for the functions that are counted.
pub(crate) struct Effect {
    pub(crate) function: String,
    /// With all passes.
    pub(crate) all: Cost,
    /// Without each of [`Pass::ALL`].
    pub(crate) without: [Cost; Pass::ALL.len()],
    /// Without any.
    pub(crate) none: Cost,
}

/// The operations of the main functions of a model.
pub(crate) fn of(model: &Model) -> Result<Vec<Effect>, EmitError> {
    let counted = model.functions.iter();
    let counted: Vec<&Function> = counted
        .filter(|f| COUNTED.contains(&f.name.as_str()))
        .collect();
    let graph = Graph::new(model, &counted, &Passes::default())?;
    let all = graph.operations(&Passes::default());
    let none = Graph::new(model, &counted, &Passes::none())?.operations(&Passes::none());
    let mut without = Vec::new();
    for pass in Pass::ALL {
        let passes = Passes::without(&[pass]);
        without.push(if pass.builds_graph() {
            Graph::new(model, &counted, &passes)?.operations(&passes)
        } else {
            graph.operations(&passes)
        });
    }
    let names = counted.iter().map(|function| function.name.as_str());
    let names = names.chain(["prepare"]).enumerate();
    let effect = |(row, name): (usize, &str)| Effect {
        function: name.to_owned(),
        all: all[row].clone(),
        without: std::array::from_fn(|pass| without[pass][row].clone()),
        none: none[row].clone(),
    };
    Ok(names.map(effect).collect())
}

/// A model and some of its functions as a graph.
struct Graph<'a> {
    model: &'a Model,
    dag: Dag,
    /// The entries of each function.
    roots: Vec<(String, Vec<Id>)>,
}

impl<'a> Graph<'a> {
    fn new(model: &'a Model, functions: &[&Function], passes: &Passes) -> Result<Self, EmitError> {
        let mut dag = Dag::new(model, passes)?;
        let mut roots = Vec::new();
        for function in functions {
            roots.push((function.name.clone(), dag.roots(function)?));
        }
        Ok(Self { model, dag, roots })
    }

    /// The operations of the functions, and at the end those of `prepare` for them.
    fn operations(&self, passes: &Passes) -> Vec<Cost> {
        let mut dag = self.dag.written_with(passes);
        let roots = self.roots.iter();
        let roots: Vec<(&str, &[Id])> = roots.map(|(name, ids)| (&**name, &**ids)).collect();
        let prepared = Prepared::gather(&mut dag, self.model, &roots, &[]);
        let mut count = |owner: &str, ids: &[Id], prepared: Option<&HashMap<Id, String>>| {
            let given = Given {
                prepared,
                stages: &[],
            };
            body(&mut dag, self.model, given, owner, ids).cost()
        };
        let functions = self.roots.iter();
        let mut counts: Vec<Cost> = functions
            .map(|(owner, ids)| count(owner, ids, Some(prepared.names())))
            .collect();
        let fields: Vec<Id> = prepared.fields.iter().map(|field| field.id).collect();
        counts.push(count("prepared", &fields, None));
        counts
    }
}
