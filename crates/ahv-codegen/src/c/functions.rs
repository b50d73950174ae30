//! The functions of a model as C.

use super::print::{Printer, broken, comments};
use super::types::Types;
use crate::graph::Kind;
use crate::schedule::pieces::Group;
use crate::schedule::program::{Function, Program, taken};
use crate::schedule::tree::{Body, Source, StageKind};
use crate::shape::Shape;
use crate::wording::{summary, wrapped};

/// A function.
pub(super) struct Text {
    pub(super) is_static: bool,
    /// What it does, as a comment.
    pub(super) docs: String,
    /// Its head, without storage class and semicolon.
    pub(super) head: String,
    pub(super) lines: Vec<String>,
}

/// Prints the functions of one program.
pub(super) struct Functions<'a> {
    pub(super) program: &'a Program<'a>,
    pub(super) types: Types,
    /// The beginning of every function's name.
    pub(super) prefix: String,
}

/// An argument: its type with a pointer's star, and its name.
pub(super) type Argument = (String, String);

impl Functions<'_> {
    /// All functions, each after those that it calls.
    pub(super) fn texts(&self) -> Vec<Text> {
        let stages = [&self.program.prepared];
        let stages = stages.into_iter().chain(&self.program.stages);
        let mut texts: Vec<Text> = stages.flat_map(|stage| self.stage(stage)).collect();
        for function in &self.program.functions {
            if !function.parts.is_empty() {
                texts.push(self.composed(function));
                continue;
            }
            let pieces = function.pieces.iter();
            texts.extend(pieces.map(|(group, body)| self.piece(function, group, body)));
            texts.extend(self.own(function));
        }
        texts
    }

    pub(super) fn text(
        &self,
        name: &str,
        result: &str,
        arguments: &[Argument],
        docs: &[String],
    ) -> Text {
        let list: Vec<String> = arguments
            .iter()
            .map(|(of, name)| {
                let gap = if of.ends_with('*') { "" } else { " " };
                format!("{of}{gap}{name}")
            })
            .collect();
        let one = format!("{result} {}{name}({})", self.prefix, list.join(", "));
        let head = if one.chars().count() <= 110 {
            one
        } else {
            format!(
                "{result} {}{name}(\n    {})",
                self.prefix,
                list.join(",\n    ")
            )
        };
        Text {
            is_static: false,
            docs: comments(docs, ""),
            head,
            lines: Vec::new(),
        }
    }

    pub(super) fn model_argument(&self, kind: Kind) -> Argument {
        let (name, of) = match kind {
            Kind::State => ("x", "State"),
            Kind::Input => ("u", "Input"),
            Kind::Noise => ("dw", "Noise"),
            Kind::Parameter | Kind::Argument => ("p", "Prepared"),
        };
        (format!("const {}{of} *", self.types.own), name.to_owned())
    }

    pub(super) fn stage_argument(&self, kind: &StageKind) -> Argument {
        let of = format!("const {}{} *", self.types.own, kind.type_name);
        (of, kind.argument.to_owned())
    }

    /// What a body refers to, as arguments.
    pub(super) fn taken(
        &self,
        uses: impl Fn(Source) -> bool,
        but: Option<&StageKind>,
    ) -> Vec<Argument> {
        let argument = |source: Source| match source {
            Source::Argument(kind) => Some(self.model_argument(kind)),
            Source::Stage(kind) if but != Some(kind) => Some(self.stage_argument(kind)),
            Source::Stage(_) | Source::Result => None,
        };
        let taken = taken(uses, &self.program.stages).into_iter();
        taken.filter_map(argument).collect()
    }

    /// The outputs of a function as arguments, and the type that it returns.
    fn outputs(&self, function: &Function<'_>) -> (Vec<Argument>, &'static str) {
        if let [shape] = function.shapes.as_slice()
            && shape.axes.is_empty()
        {
            return (Vec::new(), "double");
        }
        let outputs = function.shapes.iter().zip(0..);
        let outputs = outputs.map(|(shape, position)| {
            let of = if shape.is_list() {
                "double".to_owned()
            } else {
                self.types.nested(&shape.axes)
            };
            (format!("{of} *"), result_name(function, position))
        });
        (outputs.collect(), "void")
    }

    /// The arguments that a function takes of the model.
    fn arguments(&self, function: &Function<'_>) -> Vec<Argument> {
        let bodies = self.program.bodies(function);
        let model = [Kind::State, Kind::Input, Kind::Parameter];
        let mut arguments: Vec<Argument> = model.map(|it| self.model_argument(it)).into();
        if bodies
            .iter()
            .any(|it| it.uses(Source::Argument(Kind::Noise)))
        {
            arguments.push(self.model_argument(Kind::Noise));
        }
        let scalars = bodies.iter().flat_map(|it| it.body.scalars());
        arguments.extend(scalars.map(|name| ("double".to_owned(), name)));
        arguments
    }

    fn unused(&self, function: &Function<'_>) -> Vec<String> {
        let bodies = self.program.bodies(function);
        let model = [Kind::State, Kind::Input, Kind::Parameter];
        // Stages, and parts, take all arguments.
        let unused = model.into_iter().filter(|kind| {
            let used = bodies.iter().any(|it| it.uses(Source::Argument(*kind)));
            function.stages.is_empty() && function.parts.is_empty() && !used
        });
        let unused = unused.map(|kind| format!("    (void){};", self.model_argument(kind).1));
        unused.collect()
    }

    /// A function with a body or pieces; and the one that takes stages, where another needs it.
    fn own(&self, function: &Function<'_>) -> Vec<Text> {
        let from = function.takes_stages();
        let printer = Printer {
            holds_stages: !from,
        };
        let (outputs, result) = self.outputs(function);
        let arguments = self.arguments(function);
        let mut lines = Vec::new();
        let mut taken = Vec::new();
        if from {
            taken = self.taken(|source| function.uses(source), None);
            let scalars = function.body.scalars().into_iter();
            taken.extend(scalars.map(|name| ("double".to_owned(), name)));
        } else {
            lines.extend(self.unused(function));
            lines.extend(self.stages(&function.stages));
        }
        lines.extend(self.cleared(function));
        for (group, body) in &function.pieces {
            lines.extend(self.call_of_piece(function, group, body, !from));
        }
        let statements = function.body.statements.iter();
        lines.extend(statements.flat_map(|it| printer.statement(it)));
        if function.pieces.is_empty() {
            lines.extend(self.results(function, printer));
        }
        let all = [arguments.clone(), outputs.clone()].concat();
        let docs = documentation(function);
        if !from {
            return vec![Text {
                lines: trimmed(lines),
                ..self.text(&function.ir.name, result, &all, &docs)
            }];
        }
        let name = format!("{}_from", function.ir.name);
        let mut call = self.stages(&function.stages);
        call.push(self.call(function, &name, &outputs, true));
        let about = [format!(
            "{}{}, given the quantities that it shares with other functions.",
            self.prefix, function.ir.name
        )];
        let taken = [taken, outputs.clone()].concat();
        vec![
            Text {
                is_static: true,
                lines: trimmed(lines),
                ..self.text(&name, result, &taken, &about)
            },
            Text {
                lines: trimmed(call),
                ..self.text(&function.ir.name, result, &all, &docs)
            },
        ]
    }

    /// The call of a function that takes stages.
    fn call(
        &self,
        function: &Function<'_>,
        name: &str,
        outputs: &[Argument],
        holds_stages: bool,
    ) -> String {
        let taken = self.taken(|source| function.uses(source), None);
        let mut names = self.referred(&taken, holds_stages);
        names.extend(function.body.scalars());
        names.extend(outputs.iter().map(|(_, name)| name.clone()));
        format!("    {}{name}({});", self.prefix, names.join(", "))
    }

    /// Arguments as they are handed on: stages that the function holds itself by their address.
    fn referred(&self, arguments: &[Argument], holds_stages: bool) -> Vec<String> {
        let is_stage = |name: &str| {
            let mut stages = self.program.stages.iter();
            stages.any(|stage| stage.kind.argument == name)
        };
        let name = |(_, name): &Argument| {
            if holds_stages && is_stage(name) {
                format!("&{name}")
            } else {
                name.clone()
            }
        };
        arguments.iter().map(name).collect()
    }

    /// The lines that set to zero what has entries that are zero.
    fn cleared(&self, function: &Function<'_>) -> Vec<String> {
        let matrices = function.shapes.iter().zip(0..);
        let matrices = matrices.filter(|(shape, _)| shape.axes.len() > 1);
        let line = |(_, position): (&Shape<'_>, usize)| {
            let name = result_name(function, position);
            format!("    (void)memset({name}, 0, sizeof *{name});")
        };
        matrices.map(line).collect()
    }

    /// The lines that put results into their places.
    fn results(&self, function: &Function<'_>, printer: Printer) -> Vec<String> {
        let (outputs, result) = self.outputs(function);
        if result == "double" {
            let value = function.body.results.first();
            let value = value.map_or_else(String::new, |it| printer.expression(it));
            return broken(&format!("return {value};"));
        }
        let mut lines = vec![String::new()];
        let mut values = function.body.results.iter();
        for (shape, (_, name)) in function.shapes.iter().zip(&outputs) {
            if shape.axes.is_empty() {
                let value = values
                    .next()
                    .map_or_else(String::new, |it| printer.expression(it));
                lines.extend(broken(&format!("*{name} = {value};")));
                continue;
            }
            let own: Vec<_> = values.by_ref().take(shape.output.entries.len()).collect();
            if shape.axes.len() > 1 {
                let entries = shape.output.entries.iter().zip(own);
                for (entry, value) in entries {
                    for target in places(name, shape, &entry.at) {
                        lines.extend(printer.assignment(&target, value, ""));
                    }
                }
                continue;
            }
            for (component, index) in shape.axes[0].names.iter().zip(0..) {
                let target = if shape.is_list() {
                    format!("{name}[{index}]")
                } else {
                    format!("{name}->{component}")
                };
                match shape.entry(&[*component]) {
                    Some(entry) => lines.extend(printer.assignment(&target, own[entry], "")),
                    None => lines.push(format!("    {target} = 0.0;")),
                }
            }
        }
        lines
    }

    /// The outputs that a piece fills, as arguments.
    fn targets(&self, function: &Function<'_>, group: &Group) -> Vec<Argument> {
        let (outputs, _) = self.outputs(function);
        let targets = function.targets(group).into_iter();
        targets.map(|output| outputs[output].clone()).collect()
    }

    fn piece(&self, function: &Function<'_>, group: &Group, body: &Body) -> Text {
        let printer = Printer {
            holds_stages: false,
        };
        let statements = body.statements.iter();
        let mut lines: Vec<String> = statements.flat_map(|it| printer.statement(it)).collect();
        lines.push(String::new());
        for (&entry, value) in group.entries.iter().zip(&body.results) {
            let (output, position) = function.locate(entry);
            let shape = &function.shapes[output];
            let name = result_name(function, output);
            for target in places(&name, shape, &shape.output.entries[position].at) {
                lines.extend(printer.assignment(&target, value, ""));
            }
        }
        let mut arguments = self.taken(|source| body.uses(source), None);
        arguments.extend(self.targets(function, group));
        let docs = wrapped(&format!(
            "Entries of {}: derivatives by {}.",
            function.ir.name, group.about
        ));
        Text {
            is_static: true,
            lines: trimmed(lines),
            ..self.text(&function.piece_name(group), "void", &arguments, &docs)
        }
    }

    fn call_of_piece(
        &self,
        function: &Function<'_>,
        group: &Group,
        body: &Body,
        holds_stages: bool,
    ) -> Vec<String> {
        let taken = self.taken(|source| body.uses(source), None);
        let mut names = self.referred(&taken, holds_stages);
        names.extend(
            self.targets(function, group)
                .into_iter()
                .map(|(_, name)| name),
        );
        let name = function.piece_name(group);
        broken(&format!("{}{name}({});", self.prefix, names.join(", ")))
    }

    /// A function whose results are those of others.
    fn composed(&self, function: &Function<'_>) -> Text {
        let (outputs, result) = self.outputs(function);
        let mut lines = self.stages(&function.stages);
        let mut rest = outputs.as_slice();
        for &part in &function.parts {
            let part = &self.program.functions[part];
            let (own, others) = rest.split_at(part.shapes.len());
            rest = others;
            let (_, of_part) = self.outputs(part);
            let target = if of_part == "double" {
                format!("*{} = ", own[0].1)
            } else {
                String::new()
            };
            let handed: &[Argument] = if of_part == "double" { &[] } else { own };
            let call = if part.takes_stages() {
                self.call(part, &format!("{}_from", part.ir.name), handed, true)
            } else {
                let names = self
                    .arguments(part)
                    .into_iter()
                    .chain(handed.iter().cloned());
                let names: Vec<String> = names.map(|(_, name)| name).collect();
                format!("    {}{}({});", self.prefix, part.ir.name, names.join(", "))
            };
            lines.push(format!("    {target}{}", call.trim_start()));
        }
        let all = [self.arguments(function), outputs].concat();
        Text {
            lines,
            ..self.text(&function.ir.name, result, &all, &documentation(function))
        }
    }
}

/// Where an entry stands, and its mirror image.
fn places(name: &str, shape: &Shape<'_>, at: &[String]) -> Vec<String> {
    let mut places = vec![format!("{name}->{}", at.join("."))];
    if let ([head @ .., a, b], true) = (at, shape.output.symmetric)
        && a != b
    {
        let mirrored = [head, &[b.clone(), a.clone()]].concat();
        places.push(format!("{name}->{}", mirrored.join(".")));
    }
    places
}

fn result_name(function: &Function<'_>, output: usize) -> String {
    let name = &function.ir.outputs[output].name;
    if name.is_empty() {
        "result".to_owned()
    } else {
        name.clone()
    }
}

fn documentation(function: &Function<'_>) -> Vec<String> {
    let mut docs = summary(function.ir);
    let lists = function
        .shapes
        .iter()
        .zip(0..)
        .filter(|(it, _)| it.is_list());
    docs.extend(lists.map(|(shape, position)| {
        let (name, count) = (result_name(function, position), shape.axes[0].names.len());
        format!("`{name}` holds {count} numbers, one for each mode.")
    }));
    docs
}

/// Lines without a blank one at the beginning.
pub(super) fn trimmed(mut lines: Vec<String>) -> Vec<String> {
    while lines.first().is_some_and(String::is_empty) {
        lines.remove(0);
    }
    lines
}
