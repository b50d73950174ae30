//! A model as it is emitted, in no language yet: what printers of each language start from.

use std::collections::BTreeMap;

use super::stages::{self, Given, Stage};
use super::tree::{Body, Expr, Source};
use super::{Cost, Prepared, body};
use crate::EmitError;
use crate::graph::passes::Passes;
use crate::graph::{Dag, Id, Node, decay};
use crate::ir::{self, capitalised, described};
use crate::shape::Shape;
use crate::wording::parameter_doc;

/// A model with the bodies of its functions.
pub(crate) struct Program<'a> {
    pub(crate) model: &'a ir::Model,
    pub(crate) document: &'a ir::Document,
    /// The module in which the parameters of the table stand.
    pub(crate) home: &'a str,
    /// What computes [`Program::fields`].
    pub(crate) prepare: Body,
    /// What depends on parameters alone.
    pub(crate) fields: Vec<Field>,
    /// What several functions need, computed once.
    pub(crate) stages: Vec<Stage<'a>>,
    pub(crate) functions: Vec<Function<'a>>,
    /// States that decay by themselves, each with the field that holds its rate.
    pub(crate) coloured: Vec<(String, String)>,
}

/// A prepared value.
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) value: Expr,
    /// What it is, as a sentence; `None` where its formula says it.
    pub(crate) about: Option<String>,
}

/// A function with what it does.
pub(crate) struct Function<'a> {
    pub(crate) ir: &'a ir::Function,
    /// The shapes of its outputs.
    pub(crate) shapes: Vec<Shape<'a>>,
    /// Its results are the entries of the outputs in turn. Empty for what consists of parts.
    pub(crate) body: Body,
    /// The functions whose results are its own, in turn, by position; empty for what has a body.
    pub(crate) parts: Vec<usize>,
    /// Whether another function consists of it.
    pub(crate) is_part: bool,
    /// The stages that it needs, by position.
    pub(crate) stages: Vec<usize>,
    /// The operations that its results need, those of the stages among them.
    pub(crate) cost: Cost,
}

impl<'a> Program<'a> {
    /// Reads a model's expressions and decides what is computed in which order under which name.
    ///
    /// # Errors
    /// [`EmitError::Mismatch`] where the IR holds what it cannot.
    pub(crate) fn new(
        model: &'a ir::Model,
        home: &'a str,
        document: &'a ir::Document,
        passes: &Passes,
    ) -> Result<Self, EmitError> {
        let mut dag = Dag::new(model, passes)?;
        let mut roots = Vec::new();
        for function in &model.functions {
            roots.push(dag.roots(function)?);
        }
        let functions = model.functions.iter().zip(&roots);
        let named: Vec<(&str, &[Id])> = functions
            .map(|(function, ids)| (&*function.name, ids.as_slice()))
            .collect();
        let decays = decay::rates(model, &mut dag, &roots);
        let prepared = Prepared::gather(&mut dag, model, &named, &decays);
        let (prepare, fields) = prepare(&mut dag, model, document, &prepared);
        let parts = parts(model, &roots);
        let own = named.iter().zip(&parts);
        let own: Vec<_> = own.filter(|(_, parts)| parts.is_empty()).collect();
        let own: Vec<(&str, &[Id])> = own.into_iter().map(|(function, _)| *function).collect();
        let stages = stages::of(&mut dag, model, &prepared, &own);
        let mut functions = Vec::new();
        for (position, function) in model.functions.iter().enumerate() {
            let shapes = function.outputs.iter();
            let shapes = shapes.map(|output| Shape::of(model, document, output));
            let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
            let mut write = |stages: &[Stage<'a>]| {
                let prepared = Some(&prepared);
                let given = Given { prepared, stages };
                body(&mut dag, model, given, &function.name, &roots[position])
            };
            let cost = write(&[]).cost();
            let mut body = Body::default();
            if parts[position].is_empty() {
                body = write(&stages);
            }
            if matches!(shapes.as_slice(), [shape] if shape.axes.is_empty()) {
                body.return_last();
            }
            functions.push(Function {
                ir: function,
                shapes,
                stages: needed(&body, &stages),
                body,
                is_part: parts.iter().any(|it| it.contains(&position)),
                parts: parts[position].clone(),
                cost,
            });
        }
        for position in 0..functions.len() {
            let of_parts = functions[position].parts.iter();
            let mut of_parts: Vec<usize> = of_parts
                .flat_map(|&part| functions[part].stages.clone())
                .collect();
            of_parts.sort_unstable();
            of_parts.dedup();
            if !of_parts.is_empty() {
                functions[position].stages = of_parts;
            }
        }
        let coloured = decays
            .iter()
            .filter_map(|(state, rate)| Some((state.clone(), prepared.field(*rate)?.to_owned())));
        Ok(Self {
            model,
            document,
            home,
            prepare,
            fields,
            stages,
            functions,
            coloured: coloured.collect(),
        })
    }

    /// The model's name as people write it.
    pub(crate) fn label(&self) -> String {
        self.model.name.to_uppercase()
    }

    /// The operations of each function, in words.
    pub(crate) fn costs(&self) -> BTreeMap<String, String> {
        let functions = self.functions.iter();
        let cost = |it: &Function<'_>| capitalised(&it.cost.describe());
        functions.map(|it| (it.ir.name.clone(), cost(it))).collect()
    }

    /// The groups of the functions, in the order of the IR: each becomes a file, or a section of one.
    pub(crate) fn groups(&self) -> Vec<&'a str> {
        let mut groups: Vec<&str> = Vec::new();
        for function in &self.model.functions {
            if !groups.contains(&&*function.group) {
                groups.push(&function.group);
            }
        }
        groups
    }
}

/// The body of `prepare`, and the fields that it computes.
fn prepare(
    dag: &mut Dag,
    model: &ir::Model,
    document: &ir::Document,
    prepared: &Prepared,
) -> (Body, Vec<Field>) {
    let computed = prepared.fields.iter().map(|field| field.id);
    let computed = computed.filter(|&id| !matches!(dag.node(id), Node::Leaf(..)));
    let computed: Vec<Id> = computed.collect();
    let nothing = Given {
        prepared: None,
        stages: &[],
    };
    let body = body(dag, model, nothing, "prepared", &computed);
    let mut fields = Vec::new();
    let mut results = body.results.iter();
    for field in &prepared.fields {
        let (value, leaf) = match dag.node(field.id) {
            Node::Leaf(kind, name) => (
                Some(Expr::Component(Source::Argument(*kind), name.clone())),
                Some(name),
            ),
            _ => (results.next().cloned(), None),
        };
        let quantity = dag.quantities(field.id).first();
        let about = quantity.map(|&position| {
            let quantity = &model.quantities[position];
            described(&quantity.doc, &quantity.unit)
        });
        let about = about.or_else(|| leaf.map(|name| parameter_doc(document, name)));
        fields.extend(value.map(|value| Field {
            name: field.name.clone(),
            value,
            about,
        }));
    }
    (body, fields)
}

/// For each function the others whose outputs, one after the other, are its own; none where it has outputs of its own.
fn parts(model: &ir::Model, roots: &[Vec<Id>]) -> Vec<Vec<usize>> {
    let outputs: Vec<Vec<(&[ir::Basis], &[Id])>> = model
        .functions
        .iter()
        .zip(roots)
        .map(|(function, ids)| {
            let mut rest = ids.as_slice();
            let outputs = function.outputs.iter().map(|output| {
                let (own, others) = rest.split_at(output.entries.len());
                rest = others;
                (output.basis.as_slice(), own)
            });
            outputs.collect()
        })
        .collect();
    let of = |whole: usize| {
        let mut found = Vec::new();
        let mut rest = outputs[whole].as_slice();
        while !rest.is_empty() {
            let is_next = |&part: &usize| part != whole && rest.starts_with(&outputs[part]);
            let Some(part) = (0..outputs.len()).find(is_next) else {
                return Vec::new();
            };
            rest = &rest[outputs[part].len()..];
            found.push(part);
        }
        // Two functions may be equal: neither consists of the other.
        if found.len() > 1 { found } else { Vec::new() }
    };
    (0..outputs.len()).map(of).collect()
}

/// The stages that a body needs, and those that these need, by position.
fn needed(body: &Body, stages: &[Stage<'_>]) -> Vec<usize> {
    let mut needed = Vec::new();
    for (position, stage) in stages.iter().enumerate().rev() {
        let source = Source::Stage(stage.kind);
        let by_stage = |&later: &usize| stages[later].body.uses(source);
        if body.uses(source) || needed.iter().any(by_stage) {
            needed.insert(0, position);
        }
    }
    needed
}
