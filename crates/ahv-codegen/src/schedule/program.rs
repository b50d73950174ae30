//! A model as it is emitted, in no language yet: what printers of each language start from.

use std::collections::BTreeMap;

use super::given::{Given, Stage};
use super::pieces::{Group, groups, length};
use super::stages;
use super::tree::{Body, Source, StageKind};
use super::{Cost, Prepared, body};
use crate::EmitError;
use crate::graph::passes::Passes;
use crate::graph::{Dag, Id, Kind, Node, decay};
use crate::ir::{self, capitalised};
use crate::shape::Shape;
use crate::wording::parameter_doc;

/// A function of so many lines may repeat what a stage computes.
const SHORT: usize = 60;

/// A model with the bodies of its functions.
pub(crate) struct Program<'a> {
    pub(crate) model: &'a ir::Model,
    pub(crate) document: &'a ir::Document,
    /// The module in which the parameters of the table stand.
    pub(crate) home: &'a str,
    /// What depends on parameters alone.
    pub(crate) prepared: Stage,
    /// What several functions need, computed once.
    pub(crate) stages: Vec<Stage>,
    pub(crate) functions: Vec<Function<'a>>,
    /// States that decay by themselves, each with the field that holds its rate.
    pub(crate) coloured: Vec<(String, String)>,
}

/// A function with what it does.
pub(crate) struct Function<'a> {
    pub(crate) ir: &'a ir::Function,
    /// The shapes of its outputs.
    pub(crate) shapes: Vec<Shape<'a>>,
    /// Its results are the entries of the outputs in turn. Empty for what consists of parts or pieces.
    pub(crate) body: Body,
    /// What computes some of the entries each, where one function would be too long.
    pub(crate) pieces: Vec<(Group, Body)>,
    /// The functions whose results are its own, in turn, by position; empty for what has a body.
    pub(crate) parts: Vec<usize>,
    /// Whether another function consists of it.
    pub(crate) is_part: bool,
    /// The stages that it needs, by position.
    pub(crate) stages: Vec<usize>,
    /// The operations that its results need, those of the stages among them.
    pub(crate) cost: Cost,
    /// What it does where it takes no stage.
    alone: Body,
}

impl Function<'_> {
    /// The output in which an entry stands, and its position there.
    pub(crate) fn locate(&self, mut entry: usize) -> (usize, usize) {
        for (output, shape) in self.shapes.iter().enumerate() {
            let length = shape.output.entries.len();
            if entry < length {
                return (output, entry);
            }
            entry -= length;
        }
        (0, 0)
    }

    /// Whether it has a form that takes stages: what consists of it has them at hand.
    pub(crate) fn takes_stages(&self) -> bool {
        self.is_part && !self.stages.is_empty()
    }

    /// The name of what computes some of its entries.
    pub(crate) fn piece_name(&self, group: &Group) -> String {
        format!("{}_by_{}", self.ir.name, group.label)
    }

    /// The outputs whose entries a piece computes, by position.
    pub(crate) fn targets(&self, group: &Group) -> Vec<usize> {
        let outputs = group.entries.iter().map(|&entry| self.locate(entry).0);
        let mut targets = Vec::new();
        for output in outputs {
            if !targets.contains(&output) {
                targets.push(output);
            }
        }
        targets
    }

    /// Whether it refers to a component that stands there.
    pub(crate) fn uses(&self, source: Source) -> bool {
        self.body.uses(source) || self.pieces.iter().any(|(_, body)| body.uses(source))
    }
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
        let parts = parts(model, &roots);
        let own = model.functions.iter().zip(&roots).zip(&parts);
        let own = own.filter(|(_, parts)| parts.is_empty());
        let own: Vec<(&ir::Function, &[Id])> = own.map(|((it, ids), _)| (it, &**ids)).collect();
        let stages = stages::of(&mut dag, model, document, prepared.names(), &own);
        let mut functions = Vec::new();
        for (position, function) in model.functions.iter().enumerate() {
            let shapes = function.outputs.iter();
            let shapes = shapes.map(|output| Shape::of(model, document, output));
            let roots = &roots[position];
            let mut write = |stages: &[Stage], roots: &[Id]| {
                let prepared = Some(prepared.names());
                let given = Given { prepared, stages };
                body(&mut dag, model, given, &function.name, roots)
            };
            let alone = write(&[], roots);
            let mut written = Function {
                ir: function,
                shapes: shapes.collect::<Result<Vec<_>, _>>()?,
                cost: alone.cost(),
                alone,
                stages: Vec::new(),
                body: Body::default(),
                pieces: Vec::new(),
                parts: parts[position].clone(),
                is_part: parts.iter().any(|it| it.contains(&position)),
            };
            if written.parts.is_empty() {
                written.body = write(&stages, roots);
                let lines = length(&written.body);
                let mut of_group = |group: &Group| {
                    let roots: Vec<Id> = group.entries.iter().map(|&it| roots[it]).collect();
                    write(&stages, &roots)
                };
                let groups = groups(function, document, lines, |it| length(&of_group(it)));
                if groups.len() > 1 {
                    let pieces = groups.into_iter().map(|group| {
                        let body = of_group(&group).untitled();
                        (group, body)
                    });
                    written.pieces = pieces.collect();
                    written.body = Body::default();
                }
            }
            if matches!(written.shapes.as_slice(), [shape] if shape.axes.is_empty()) {
                written.body.return_last();
                written.alone.return_last();
            }
            written.stages = needed(&written, &stages);
            functions.push(written);
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
            .filter_map(|(state, rate)| Some((state.clone(), prepared.field(*rate)?.to_owned())))
            .collect();
        Ok(Self {
            prepared: prepare(&mut dag, model, document, &prepared),
            model,
            document,
            home,
            stages,
            functions,
            coloured,
        })
    }

    /// The same for a language whose compiler leaves nothing out of what is called: a short function that needs less than half of what
    /// its stages compute takes none, and costs are those of all that is called.
    pub(crate) fn called(mut self) -> Self {
        for position in 0..self.functions.len() {
            let mut cost = self.cost_of_call(&self.functions[position]);
            let function = &mut self.functions[position];
            let is_whole = function.parts.is_empty() && function.pieces.is_empty();
            let is_short = length(&function.alone) <= SHORT && !function.is_part;
            if is_whole && is_short && 2 * function.cost.total() < cost.total() {
                function.body = std::mem::take(&mut function.alone);
                function.stages.clear();
                cost = function.body.cost();
            }
            function.cost = cost;
        }
        self
    }

    /// The operations of a function and of all that it calls.
    fn cost_of_call(&self, function: &Function<'_>) -> Cost {
        let mut cost = Cost::default();
        for it in self.bodies(function) {
            cost += it.body.cost();
            it.pieces.iter().for_each(|(_, body)| cost += body.cost());
        }
        let stages = function.stages.iter().map(|&it| &self.stages[it]);
        let bodies = stages.flat_map(|stage| &stage.parts);
        bodies.for_each(|body| cost += body.cost());
        cost
    }

    /// The functions whose bodies compute the results of one: its parts, and itself.
    pub(crate) fn bodies<'f>(&'f self, function: &'f Function<'a>) -> Vec<&'f Function<'a>> {
        let parts = function.parts.iter().map(|&part| &self.functions[part]);
        parts.chain([function]).collect()
    }

    /// The stages that a stage takes.
    pub(crate) fn earlier(&self, position: usize) -> Vec<&'static StageKind> {
        let stage = &self.stages[position];
        let earlier = self.stages[..position].iter().map(|it| it.kind);
        let taken = earlier.filter(|kind| stage.uses(Source::Stage(kind)));
        taken.collect()
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

    /// Names that only say whose part a value is: the function, the name, the reason.
    pub(crate) fn numbered(&self) -> Vec<(String, String, String)> {
        let of = |function: &str, names: &[(String, String)]| {
            let names = names
                .iter()
                .map(|(name, reason)| (function.to_owned(), name.clone(), reason.clone()));
            names.collect::<Vec<_>>()
        };
        let mut found = Vec::new();
        for stage in [&self.prepared].into_iter().chain(&self.stages) {
            found.extend(of(stage.kind.function, &stage.numbered));
        }
        for function in &self.functions {
            let pieces = function.pieces.iter().map(|(_, body)| body);
            for body in pieces.chain([&function.body]) {
                found.extend(of(&function.ir.name, &body.numbered));
            }
        }
        found
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

/// The stage of what depends on parameters alone.
fn prepare(
    dag: &mut Dag,
    model: &ir::Model,
    document: &ir::Document,
    prepared: &Prepared,
) -> Stage {
    let fields = prepared.fields.iter();
    let fields: Vec<(Id, String)> = fields.map(|it| (it.id, it.name.clone())).collect();
    let kind = &stages::PREPARED;
    let mut stage = Stage::new(dag, model, Given::NOTHING, kind, fields);
    stage.numbered.extend(prepared.numbered.iter().cloned());
    for (field, prepared) in stage.fields.iter_mut().zip(&prepared.fields) {
        if let Node::Leaf(_, name) = dag.node(prepared.id) {
            field.about = Some(parameter_doc(document, name));
        }
    }
    stage
}

/// What a body refers to, in the order of arguments: those of the model, then stages.
pub(crate) fn taken(uses: impl Fn(Source) -> bool, stages: &[Stage]) -> Vec<Source> {
    let kinds = [Kind::State, Kind::Input, Kind::Parameter, Kind::Noise];
    let kinds = kinds.into_iter().map(Source::Argument);
    let stages = stages.iter().map(|stage| Source::Stage(stage.kind));
    kinds.chain(stages).filter(|source| uses(*source)).collect()
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

/// The stages that a function needs, and those that these need, by position.
fn needed(function: &Function<'_>, stages: &[Stage]) -> Vec<usize> {
    let mut needed = Vec::new();
    for (position, stage) in stages.iter().enumerate().rev() {
        let source = Source::Stage(stage.kind);
        let by_stage = |&later: &usize| stages[later].uses(source);
        if function.uses(source) || needed.iter().any(by_stage) {
            needed.insert(0, position);
        }
    }
    needed
}
