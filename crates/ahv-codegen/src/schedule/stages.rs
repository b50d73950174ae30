//! What several functions of a model need, computed once: the intermediates of the drift, the slopes of the Jacobians.
//!
//! A value of such a function that another function needs as well becomes a field of a struct. Functions take the struct, so
//! that each formula stands once in a model. What parameters alone decide is in [`Prepared`] already.

use std::collections::{HashMap, HashSet};

use super::prepared::Prepared;
use super::scope::Scope;
use super::tree::{Body, Source};
use crate::graph::{Dag, Id, Node};
use crate::ir;

/// Fewer fields are no struct.
const FEWEST: usize = 4;

/// What a stage is called, and whose values it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// The function whose values they are.
    of: &'static str,
    /// The function that computes them.
    pub(crate) function: &'static str,
    /// The struct.
    pub(crate) type_name: &'static str,
    /// The argument of functions that take it.
    pub(crate) argument: &'static str,
    pub(crate) doc: &'static str,
}

/// The stages, each may take those before it.
const KINDS: [Kind; 3] = [
    Kind {
        of: "drift",
        function: "intermediates",
        type_name: "Intermediates",
        argument: "i",
        doc: "Quantities of the drift that other functions need",
    },
    Kind {
        of: "jacobians",
        function: "slopes",
        type_name: "Slopes",
        argument: "s",
        doc: "Quantities of the Jacobians that other functions need",
    },
    Kind {
        of: "diffusion",
        function: "noise_terms",
        type_name: "NoiseTerms",
        argument: "n",
        doc: "Quantities of the diffusion that other functions need",
    },
];

/// A stage of a model.
pub(crate) struct Stage<'a> {
    pub(crate) kind: &'static Kind,
    pub(crate) fields: Vec<Field<'a>>,
    /// Its results are the fields.
    pub(crate) body: Body,
    names: HashMap<Id, String>,
}

/// A field of a stage.
pub(crate) struct Field<'a> {
    pub(crate) name: String,
    /// The quantity that it is; `None` where its formula says it.
    pub(crate) quantity: Option<&'a ir::Quantity>,
}

/// What a body may refer to besides its arguments.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) prepared: Option<&'a Prepared>,
    pub(crate) stages: &'a [Stage<'a>],
}

impl Given<'_> {
    /// Where a value is given, and its name there.
    pub(super) fn find(&self, id: Id) -> Option<(Source, &str)> {
        let prepared = self.prepared.and_then(|it| it.field(id));
        let prepared = prepared.map(|name| (Source::Argument(crate::graph::Kind::Parameter), name));
        prepared.or_else(|| {
            self.stages
                .iter()
                .find_map(|stage| Some((Source::Stage(stage.kind), stage.names.get(&id)?.as_str())))
        })
    }

    /// What given values are called in names.
    pub(super) fn names(&self) -> HashMap<Id, String> {
        let prepared = self.prepared.into_iter().flat_map(Prepared::names);
        let stages = self.stages.iter().flat_map(|stage| &stage.names);
        let names = prepared.chain(stages);
        names.map(|(id, name)| (*id, name.clone())).collect()
    }
}

/// The stages of a model whose functions have these roots.
pub(super) fn of<'a>(
    dag: &mut Dag,
    model: &'a ir::Model,
    prepared: &Prepared,
    roots: &[(&str, &[Id])],
) -> Vec<Stage<'a>> {
    let mut stages: Vec<Stage<'a>> = Vec::new();
    let mut done = Vec::new();
    for kind in &KINDS {
        let Some(&(owner, own)) = roots.iter().find(|(name, _)| *name == kind.of) else {
            continue;
        };
        done.push(owner);
        let given = Given {
            prepared: Some(prepared),
            stages: &stages,
        };
        let mut scope = Scope::new(dag, model, given);
        scope.write(owner, own);
        let named = scope.described();
        let others = roots.iter().filter(|(name, _)| !done.contains(name));
        let needed: HashSet<Id> = others
            .flat_map(|(_, ids)| reached(dag, given, ids, &named))
            .collect();
        // In the order in which they are computed.
        let fields: Vec<(Id, String)> = named
            .into_iter()
            .filter(|(id, _)| needed.contains(id))
            .collect();
        if fields.len() < FEWEST {
            continue;
        }
        let ids: Vec<Id> = fields.iter().map(|(id, _)| *id).collect();
        let body = super::body(dag, model, given, owner, &ids);
        let quantity = |id: Id| {
            let position = dag.quantities(id).first();
            position.map(|&position| &model.quantities[position])
        };
        stages.push(Stage {
            kind,
            fields: fields
                .iter()
                .map(|(id, name)| Field {
                    name: name.clone(),
                    quantity: quantity(*id),
                })
                .collect(),
            body,
            names: fields.into_iter().collect(),
        });
    }
    stages
}

/// Which of some values the roots need directly.
fn reached(dag: &mut Dag, given: Given<'_>, roots: &[Id], named: &[(Id, String)]) -> HashSet<Id> {
    let named: HashSet<Id> = named.iter().map(|(id, _)| *id).collect();
    let (mut found, mut seen, mut open) = (HashSet::new(), HashSet::new(), roots.to_vec());
    while let Some(id) = open.pop() {
        if !seen.insert(id) || given.find(id).is_some() {
            continue;
        }
        if named.contains(&id) {
            found.insert(id);
        } else if !matches!(dag.node(id), Node::Number(_) | Node::Leaf(..)) {
            open.extend(dag.operands(id));
        }
    }
    found
}
