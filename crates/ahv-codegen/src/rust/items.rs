//! What stands in a file of functions.

use std::collections::BTreeSet;

use super::dense::{EntriesText, Zeros};
use super::places::placed;
use super::print::{statement, value_of};
use super::wording::{arguments, tuple, values_name};
use crate::graph::Kind;
use crate::schedule::pieces::Group;
use crate::schedule::program::{Function, Program, taken};
use crate::schedule::tree::{Body, Expr, Source, StageKind, Statement};
use crate::shape::Shape;
use crate::wording::{summary, wrapped};

/// A struct of entries or a function.
pub(super) enum Item {
    Entries(String),
    Function(FunctionText),
}

/// A function as the template takes it.
pub(super) struct FunctionText {
    pub(super) name: String,
    pub(super) docs: Vec<String>,
    pub(super) arguments: Vec<String>,
    pub(super) result: String,
    pub(super) statements: Vec<String>,
    /// Whether others are to call it.
    pub(super) is_public: bool,
    /// Whether a blank line sets the result off from what it is made of.
    pub(super) sets_result_off: bool,
    pub(super) zeros: Zeros,
    pub(super) outputs: Vec<(String, String)>,
}

/// The items of a function, or of its compressed form.
pub(super) fn functions(program: &Program<'_>, function: &Function<'_>) -> Vec<FunctionText> {
    if !function.parts.is_empty() {
        return vec![composed(program, function)];
    }
    let mut text = own(program, function);
    let pieces = function.pieces.iter();
    let mut items: Vec<FunctionText> = pieces
        .map(|(group, body)| piece(program, function, group, body))
        .collect();
    let Some(from) = from(function) else {
        if let Some(value) = field_of_stage(program, function) {
            text.outputs = vec![(String::new(), value)];
        } else {
            let stages = stage_lines(program, &function.stages);
            text.statements.splice(0..0, stages);
        }
        items.push(text);
        return items;
    };
    let whole = FunctionText {
        docs: text.docs.clone(),
        arguments: public_arguments(program, function),
        result: text.result.clone(),
        statements: stage_lines(program, &function.stages),
        is_public: true,
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), call(program, function))],
        name: std::mem::replace(&mut text.name, from),
    };
    text.docs = vec![format!(
        "[`{}`] where its stages are computed already.",
        whole.name
    )];
    for &position in &function.stages {
        let kind = program.stages[position].kind;
        let is_used = function.uses(Source::Stage(kind));
        text.arguments.push(stage_argument(kind, is_used));
    }
    items.extend([text, whole]);
    items
}

/// What a body takes, by name and type.
pub(super) fn named(taken: &[Source]) -> Vec<(&'static str, &'static str)> {
    let argument = |source: &Source| match source {
        Source::Argument(Kind::State) => Some(("x", "State")),
        Source::Argument(Kind::Input) => Some(("u", "Input")),
        Source::Argument(Kind::Parameter) => Some(("p", "Prepared")),
        Source::Argument(Kind::Noise) => Some(("dw", "Noise")),
        Source::Argument(Kind::Argument) | Source::Result => None,
        Source::Stage(kind) => Some((kind.argument, kind.type_name)),
    };
    taken.iter().filter_map(argument).collect()
}

/// A function that computes some entries of another.
fn piece(
    program: &Program<'_>,
    function: &Function<'_>,
    group: &Group,
    body: &Body,
) -> FunctionText {
    let places = group.entries.iter();
    let places: Vec<_> = places.map(|it| Some(place(function, *it))).collect();
    let statements = placed(body, &places).statements;
    let targets = function.targets(group).into_iter().map(|output| {
        let of = function.shapes[output].entries();
        let of = of.map_or_else(String::new, |it| it.name);
        format!("{}: &mut {of}<R>", result_name(function, output))
    });
    let taken = named(&taken(|source| body.uses(source), &program.stages));
    let taken = taken
        .into_iter()
        .map(|(name, of)| format!("{name}: &{of}<R>"));
    FunctionText {
        name: function.piece_name(group),
        docs: wrapped(&format!(
            "Entries of [`{}`]: derivatives by {}.",
            own_name(function),
            group.about
        )),
        arguments: targets.chain(taken).collect(),
        result: String::new(),
        statements: statements.iter().map(statement).collect(),
        is_public: false,
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: Vec::new(),
    }
}

fn result_name(function: &Function<'_>, output: usize) -> String {
    let name = &function.ir.outputs[output].name;
    if name.is_empty() {
        "entries".to_owned()
    } else {
        name.clone()
    }
}

/// An entry of a function in the struct that it returns.
fn place(function: &Function<'_>, entry: usize) -> String {
    let (output, position) = function.locate(entry);
    let entry = &function.shapes[output].output.entries[position];
    format!("{}.{}", result_name(function, output), entry.at.join("."))
}

/// The argument that holds a stage.
pub(super) fn stage_argument(kind: &StageKind, is_used: bool) -> String {
    let unused = if is_used { "" } else { "_" };
    format!("{unused}{}: &{}<R>", kind.argument, kind.type_name)
}

/// The statements that compute stages.
fn stage_lines(program: &Program<'_>, positions: &[usize]) -> Vec<String> {
    let line = |&position: &usize| {
        let argument = program.stages[position].kind.argument;
        format!("let {argument} = {};", call_of_stage(program, position))
    };
    positions.iter().map(line).collect()
}

fn call_of_stage(program: &Program<'_>, position: usize) -> String {
    let earlier = program.earlier(position).into_iter();
    let earlier: String = earlier
        .map(|kind| format!(", &{}", kind.argument))
        .collect();
    format!(
        "{}(x, u, p{earlier})",
        program.stages[position].kind.function
    )
}

/// The value of a function that is a field of its only stage.
fn field_of_stage(program: &Program<'_>, function: &Function<'_>) -> Option<String> {
    let ([position], [], [Expr::Component(Source::Stage(_), field)]) = (
        &*function.stages,
        &*function.body.statements,
        &*function.body.results,
    ) else {
        return None;
    };
    let is_scalar = function.shapes.iter().all(|shape| shape.axes.is_empty());
    is_scalar.then(|| format!("{}.{field}", call_of_stage(program, *position)))
}

fn public_arguments(program: &Program<'_>, function: &Function<'_>) -> Vec<String> {
    let bodies = program.bodies(function);
    let used = |kind: Kind| {
        let by_stages = !function.stages.is_empty() && kind != Kind::Noise;
        by_stages || bodies.iter().any(|it| it.uses(Source::Argument(kind)))
    };
    let scalars: BTreeSet<String> = bodies.iter().flat_map(|it| it.body.scalars()).collect();
    let scalars = scalars.into_iter().map(|name| format!("{name}: R"));
    arguments(used).into_iter().chain(scalars).collect()
}

/// The name of the function that takes what is computed once, where there is one.
pub(super) fn from(function: &Function<'_>) -> Option<String> {
    function
        .takes_stages()
        .then(|| format!("{}_from", own_name(function)))
}

fn own_name(function: &Function<'_>) -> String {
    if function.ir.compressed {
        values_name(function.ir)
    } else {
        function.ir.name.clone()
    }
}

/// The call of a function, or of what takes what is computed once, where that is at hand.
fn call(program: &Program<'_>, function: &Function<'_>) -> String {
    let mut call = format!(
        "{}(x, u, p",
        from(function).unwrap_or_else(|| own_name(function))
    );
    if function.uses(Source::Argument(Kind::Noise)) {
        call += ", dw";
    }
    for scalar in function.body.scalars() {
        call += &format!(", {scalar}");
    }
    for &position in &function.stages {
        call += &format!(", &{}", program.stages[position].kind.argument);
    }
    call + ")"
}

/// A function whose results are those of others.
fn composed(program: &Program<'_>, function: &Function<'_>) -> FunctionText {
    let ir = function.ir;
    let mut statements = stage_lines(program, &function.stages);
    let (mut values, mut results) = (Vec::new(), Vec::new());
    let mut outputs = ir.outputs.iter();
    for &part in &function.parts {
        let part = &program.functions[part];
        let names = outputs.by_ref().take(part.shapes.len());
        let names: Vec<String> = names.map(|output| output.name.clone()).collect();
        statements.push(format!("let {} = {};", tuple(&names), call(program, part)));
        for (shape, name) in part.shapes.iter().zip(names) {
            let entries = shape.entries().filter(|_| part.ir.compressed);
            let (value, result) = match entries {
                Some(_) if !ir.compressed => (format!("{name}.dense()"), shape.result()),
                Some(entries) => (name, format!("{}<R>", entries.name)),
                None => (name, shape.result()),
            };
            values.push(value);
            results.push(result);
        }
    }
    FunctionText {
        name: own_name(function),
        docs: documentation(function),
        arguments: public_arguments(program, function),
        result: tuple(&results),
        statements,
        is_public: true,
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), tuple(&values))],
    }
}

/// A function with a body or pieces, without what it takes from stages.
fn own(program: &Program<'_>, function: &Function<'_>) -> FunctionText {
    let Function { ir, shapes, .. } = function;
    let mut statements = Vec::new();
    let (mut results, mut places) = (Vec::new(), Vec::new());
    for (position, shape) in shapes.iter().enumerate() {
        let entries = shape.entries().filter(|_| ir.compressed);
        let here = places.len()..places.len() + shape.output.entries.len();
        let Some(EntriesText { name: of, .. }) = entries else {
            places.extend(here.map(|_| None));
            results.push(shape.result());
            continue;
        };
        let name = result_name(function, position);
        if !here.is_empty() {
            statements.push(format!("let mut {name} = {of}::splat(R::ZERO);"));
        }
        places.extend(here.map(|entry| Some(place(function, entry))));
        results.push(format!("{of}<R>"));
    }
    let body = placed(&function.body, &places);
    statements.extend(body.statements.iter().map(statement));
    let pieces = function.pieces.iter();
    statements.extend(pieces.map(|(group, body)| call_of_piece(program, function, group, body)));
    let mut zeros = Zeros::new();
    let mut outputs = values(function, &body.results, &mut zeros);
    if ir.compressed {
        let names: Vec<String> = outputs.into_iter().map(|(_, value)| value).collect();
        outputs = vec![(String::new(), tuple(&names))];
    }
    let is_whole = from(function).is_none();
    let by_stages = is_whole && !function.stages.is_empty();
    let used =
        |kind: Kind| (by_stages && kind != Kind::Noise) || function.uses(Source::Argument(kind));
    let scalars = function.body.scalars().into_iter();
    let scalars = scalars.map(|name| format!("{name}: R"));
    let is_set_off = !matches!(body.statements.last(), None | Some(Statement::Section(_)));
    FunctionText {
        name: own_name(function),
        docs: documentation(function),
        arguments: arguments(used).into_iter().chain(scalars).collect(),
        result: tuple(&results),
        statements,
        is_public: true,
        sets_result_off: is_set_off && !ir.compressed,
        zeros,
        outputs,
    }
}

/// The outputs of a function, each by name: a struct of entries, or the dense form of what has none.
fn values(
    function: &Function<'_>,
    mut results: &[Expr],
    zeros: &mut Zeros,
) -> Vec<(String, String)> {
    let mut outputs = Vec::new();
    for (position, shape) in function.shapes.iter().enumerate() {
        let output = &function.ir.outputs[position];
        if let Some(entries) = shape.entries().filter(|_| function.ir.compressed) {
            let value = if output.entries.is_empty() {
                format!("{}::splat(R::ZERO)", entries.name)
            } else {
                result_name(function, position)
            };
            outputs.push((output.name.clone(), value));
            continue;
        }
        let (values, rest) = results.split_at(output.entries.len());
        results = rest;
        let value = match values {
            [value] if shape.axes.is_empty() => value_of(value),
            _ => shape.dense(values, zeros),
        };
        outputs.push((output.name.clone(), value));
    }
    outputs
}

/// The call of a piece. Stages are at hand by value, or as arguments by reference.
fn call_of_piece(
    program: &Program<'_>,
    function: &Function<'_>,
    group: &Group,
    body: &Body,
) -> String {
    let targets = function.targets(group).into_iter();
    let targets = targets.map(|output| format!("&mut {}", result_name(function, output)));
    let by_value = from(function).is_none();
    let name = |source: &Source| {
        let (name, _) = *named(&[*source]).first()?;
        let is_own = by_value && matches!(source, Source::Stage(_));
        Some(if is_own {
            format!("&{name}")
        } else {
            name.to_owned()
        })
    };
    let taken = taken(|source| body.uses(source), &program.stages);
    let arguments: Vec<String> = targets.chain(taken.iter().filter_map(name)).collect();
    format!("{}({});", function.piece_name(group), arguments.join(", "))
}

fn documentation(function: &Function<'_>) -> Vec<String> {
    let mut docs = summary(function.ir);
    if function.ir.compressed {
        let entries = "The structurally non-zero entries alone, in the order of the pattern.";
        docs.extend([String::new(), entries.to_owned()]);
    }
    docs
}

/// The dense form of a compressed function.
pub(super) fn dense(function: &Function<'_>) -> FunctionText {
    let Function { ir, shapes, .. } = function;
    let results: Vec<String> = shapes.iter().map(Shape::result).collect();
    let call = format!("{}(x, u, p)", values_name(ir));
    let named = ir.outputs.iter().map(|output| output.name.clone());
    let values: Vec<String> = match shapes.as_slice() {
        [_] => vec![call.clone()],
        _ => named.collect(),
    };
    let source = (shapes.len() > 1).then(|| format!("let {} = {call};", tuple(&values)));
    let dense = shapes.iter().zip(&values);
    let dense = dense.map(|(shape, values)| match shape.entries() {
        Some(_) => format!("{values}.dense()"),
        None => values.clone(),
    });
    FunctionText {
        name: ir.name.clone(),
        docs: summary(ir),
        arguments: arguments(|kind| kind != Kind::Noise),
        result: tuple(&results),
        statements: source.into_iter().collect(),
        is_public: true,
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), tuple(&dense.collect::<Vec<_>>()))],
    }
}

/// What a function's items take from the rest of the model, besides the types of their results.
pub(super) fn imports(program: &Program<'_>, function: &Function<'_>) -> Vec<String> {
    let mut found = Vec::new();
    let parts = function.parts.iter().map(|&part| &program.functions[part]);
    for part in parts.clone() {
        if part.ir.group != function.ir.group {
            found.push(from(part).unwrap_or_else(|| own_name(part)));
        }
    }
    let mut bodies = parts.chain([function]);
    if bodies.any(|it| it.uses(Source::Argument(Kind::Noise))) {
        found.push("Noise".to_owned());
    }
    for &position in &function.stages {
        let kind = program.stages[position].kind;
        found.push(kind.function.to_owned());
        let named = from(function).is_some() || !function.pieces.is_empty();
        if named && (from(function).is_some() || function.uses(Source::Stage(kind))) {
            found.push(kind.type_name.to_owned());
        }
    }
    found
}
