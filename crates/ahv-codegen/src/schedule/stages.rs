//! What several functions of a model need, computed once into a struct: what is prepared from the parameters, the intermediates
//! of the drift, the slopes of the Jacobians.
//!
//! A value of such a function that another function needs as well becomes a field. Functions take the struct, so that each
//! formula stands once in a model.

use std::collections::{HashMap, HashSet};

use super::given::{Field, Given, Stage};
use super::pieces::{Group, crossing, groups, length, sliced};
use super::scope::{Scope, Target};
use super::tree::{Source, StageKind, Statement};
use crate::graph::{Dag, Id, Node};
use crate::ir::{self, described};

/// Fewer fields are no struct.
const FEWEST: usize = 4;

/// What depends on parameters alone. Functions take it as `p`; while it is computed, `p` are the parameters.
pub(crate) const PREPARED: StageKind = StageKind {
    of: "",
    function: "prepare",
    type_name: "Prepared",
    argument: "c",
    doc: "Parameters as the functions of this model use them",
};

/// The other stages, each may take those before it.
const KINDS: [StageKind; 6] = [
    StageKind {
        of: "drift",
        function: "intermediates",
        type_name: "Intermediates",
        argument: "i",
        doc: "Quantities of the drift that other functions need",
    },
    StageKind {
        of: "jacobians",
        function: "slopes",
        type_name: "Slopes",
        argument: "s",
        doc: "Quantities of the Jacobians that other functions need",
    },
    StageKind {
        of: "hessian",
        function: "curvatures",
        type_name: "Curvatures",
        argument: "h",
        doc: "Quantities of the second derivatives that other functions, or several parts of these, need",
    },
    StageKind {
        of: "diffusion",
        function: "noise_terms",
        type_name: "NoiseTerms",
        argument: "n",
        doc: "Quantities of the diffusion that other functions need",
    },
    StageKind {
        of: "noise_derivatives",
        function: "noise_slopes",
        type_name: "NoiseSlopes",
        argument: "m",
        doc: "Quantities of the noise's derivatives that other functions, or several parts of these, need",
    },
    StageKind {
        of: "parameter_jacobian",
        function: "sensitivities",
        type_name: "Sensitivities",
        argument: "q",
        doc: "Quantities of the derivatives with respect to parameters that several parts of these need",
    },
];

impl Stage {
    /// The stage of this kind with these fields, in the order in which they are computed.
    pub(super) fn new(
        dag: &mut Dag,
        model: &ir::Model,
        given: Given<'_>,
        kind: &'static StageKind,
        mut fields: Vec<(Id, String)>,
    ) -> Self {
        let (statements, numbered) = loop {
            let (statements, numbered, described) = filling(dag, model, given, kind, &fields);
            // What parts need of each other is a field too.
            let crossing = crossing(&statements);
            let crossing = described
                .into_iter()
                .filter(|(_, name)| crossing.contains(name));
            let before = fields.len();
            fields.extend(crossing);
            if fields.len() == before {
                break (statements, numbered);
            }
        };
        // A value that is a quantity of another function is named from what it is, and so described.
        let about = |id: Id, name: &str| {
            let mut quantities = dag.quantities(id).iter().map(|&it| &model.quantities[it]);
            let own = quantities.find(|it| it.name == name)?;
            Some(described(&own.doc, &own.unit))
        };
        let field = |(id, name): (Id, String)| Field {
            about: about(id, &name),
            name,
        };
        Self {
            kind,
            parts: sliced(statements),
            numbered,
            names: fields.iter().cloned().collect(),
            fields: fields.into_iter().map(field).collect(),
        }
    }
}

/// Names, each of something or with a reason.
type Named<T> = Vec<(T, String)>;

/// What fills these fields; names there that are numbered, with reasons; what is bound there by a name that describes it.
fn filling(
    dag: &mut Dag,
    model: &ir::Model,
    given: Given<'_>,
    kind: &'static StageKind,
    fields: &[(Id, String)],
) -> (Vec<Statement>, Named<String>, Named<Id>) {
    // What is handed on unchanged comes first.
    let is_leaf = |id: &Id| matches!(dag.node(*id), Node::Leaf(..));
    let ids = fields.iter().map(|(id, _)| *id);
    let (leaves, computed): (Vec<Id>, Vec<Id>) = ids.partition(is_leaf);
    let names: HashMap<Id, String> = fields.iter().cloned().collect();
    let target = Target {
        source: Source::Stage(kind),
        names: &names,
    };
    let mut scope = Scope::filling(dag, model, given, Some(target));
    let owner = if kind.of.is_empty() {
        "prepared"
    } else {
        kind.of
    };
    let mut statements = scope.handed_on(&leaves);
    statements.extend(scope.write(owner, &computed));
    let others = scope.described();
    (statements, scope.numbered, others)
}

/// The stages of a model whose functions have these roots.
pub(super) fn of(
    dag: &mut Dag,
    model: &ir::Model,
    document: &ir::Document,
    prepared: &HashMap<Id, String>,
    functions: &[(&ir::Function, &[Id])],
) -> Vec<Stage> {
    let mut stages: Vec<Stage> = Vec::new();
    let mut done: Vec<&str> = Vec::new();
    for kind in &KINDS {
        let Some(&(function, own)) = functions.iter().find(|(it, _)| it.name == kind.of) else {
            continue;
        };
        done.push(&function.name);
        let given = Given {
            prepared: Some(prepared),
            stages: &stages,
        };
        let mut scope = Scope::new(dag, model, given);
        let statements = scope.write(&function.name, own);
        let named = scope.described();
        let lines = statements.iter().map(super::pieces::lines).sum::<usize>() + own.len();
        let others = functions
            .iter()
            .filter(|(it, _)| !done.contains(&&*it.name));
        let mut needed: HashSet<Id> = others
            .flat_map(|(_, ids)| reached(dag, given, ids, &named))
            .collect();
        // What is too long for one function is computed in several pieces; what two of these go through is computed once.
        let of_group =
            |group: &Group| -> Vec<Id> { group.entries.iter().map(|&it| own[it]).collect() };
        let length = |group: &Group| {
            length(&super::body(
                dag,
                model,
                given,
                &function.name,
                &of_group(group),
            ))
        };
        let groups = groups(function, document, lines, length);
        let mut times: HashMap<Id, usize> = HashMap::new();
        for group in &groups {
            for id in cone(dag, given, &of_group(group)) {
                *times.entry(id).or_default() += 1;
            }
        }
        let shared =
            |id: Id| times.get(&id).is_some_and(|&count| count > 1) || needed.contains(&id);
        let shared: Vec<(Id, String)> = named
            .iter()
            .filter(|(id, _)| shared(*id))
            .cloned()
            .collect();
        for group in &groups {
            let found = reached(dag, given, &of_group(group), &shared);
            needed.extend(found);
        }
        let needed = |(id, _): &&(Id, String)| needed.contains(id);
        let fields: Vec<(Id, String)> = named.iter().filter(needed).cloned().collect();
        if fields.len() < FEWEST {
            continue;
        }
        stages.push(Stage::new(dag, model, given, kind, fields));
    }
    stages
}

/// All values that the roots need and that are not given.
fn cone(dag: &mut Dag, given: Given<'_>, roots: &[Id]) -> HashSet<Id> {
    let (mut seen, mut open) = (HashSet::new(), roots.to_vec());
    while let Some(id) = open.pop() {
        if given.find(id).is_none() && seen.insert(id) {
            open.extend(dag.operands(id));
        }
    }
    seen
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
