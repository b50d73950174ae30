//! What stands in a file of functions.

use std::collections::BTreeSet;

use super::dense::{PatternText, Zeros};
use super::print::{expression, statement, value_of};
use super::wording::{arguments, tuple, values_name};
use crate::graph::Kind;
use crate::ir::capitalised;
use crate::schedule::program::{Function, Program};
use crate::schedule::stages;
use crate::schedule::tree::{Expr, Source, Statement};
use crate::shape::Shape;
use crate::wording::summary;

/// A pattern or a function.
pub(super) enum Item {
    Pattern(PatternText),
    Function(FunctionText),
}

/// A function as the template takes it.
pub(super) struct FunctionText {
    pub(super) name: String,
    pub(super) docs: Vec<String>,
    pub(super) arguments: Vec<String>,
    pub(super) result: String,
    pub(super) statements: Vec<String>,
    /// Whether a blank line sets the result off from what it is made of.
    pub(super) sets_result_off: bool,
    pub(super) zeros: Zeros,
    pub(super) outputs: Vec<(String, String)>,
}

/// The function from the compressed to the dense form, where a literal says it.
pub(super) fn scatter(shape: &Shape<'_>) -> Option<FunctionText> {
    let (name, alias) = (shape.scatter()?, shape.alias()?);
    let count = shape.output.entries.len();
    let values: Vec<Expr> = (0..count)
        .map(|k| Expr::Name(format!("values[{k}]")))
        .collect();
    let mut zeros = Zeros::new();
    let dense = shape.dense(&values, &mut zeros);
    Some(FunctionText {
        name,
        docs: vec![format!(
            "The [`{alias}`] whose structurally non-zero entries are `values`, in the order of the pattern."
        )],
        arguments: vec![format!("values: &[R; {count}]")],
        result: shape.result(),
        statements: Vec::new(),
        sets_result_off: false,
        zeros,
        outputs: vec![(String::new(), dense)],
    })
}

/// A function, or its compressed form: one item, or two where another function takes what it is made from.
pub(super) fn functions(program: &Program<'_>, function: &Function<'_>) -> Vec<FunctionText> {
    if !function.parts.is_empty() {
        return vec![composed(program, function)];
    }
    let mut text = own(function);
    let Some(from) = from(function) else {
        let stages = stage_lines(program, &function.stages);
        text.statements.splice(0..0, stages);
        return vec![text];
    };
    let whole = FunctionText {
        docs: text.docs.clone(),
        arguments: public_arguments(program, function),
        result: text.result.clone(),
        statements: stage_lines(program, &function.stages),
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), call(program, function))],
        name: std::mem::replace(&mut text.name, from),
    };
    text.docs = vec![format!("[`{}`] from what is computed once.", whole.name)];
    for &position in &function.stages {
        let kind = program.stages[position].kind;
        text.arguments.push(stage_argument(
            kind,
            function.body.uses(Source::Stage(kind)),
        ));
    }
    vec![whole, text]
}

/// The argument that holds a stage.
pub(super) fn stage_argument(kind: &stages::Kind, is_used: bool) -> String {
    let unused = if is_used { "" } else { "_" };
    format!("{unused}{}: &{}<R>", kind.argument, kind.type_name)
}

/// The statements that compute stages.
pub(super) fn stage_lines(program: &Program<'_>, positions: &[usize]) -> Vec<String> {
    let line = |&position: &usize| {
        let stage = &program.stages[position];
        let mut call = format!("{}(x, u, p", stage.kind.function);
        for earlier in &program.stages[..position] {
            if stage.body.uses(Source::Stage(earlier.kind)) {
                call += &format!(", &{}", earlier.kind.argument);
            }
        }
        format!("let {} = {call});", stage.kind.argument)
    };
    positions.iter().map(line).collect()
}

fn public_arguments(program: &Program<'_>, function: &Function<'_>) -> Vec<String> {
    let parts = function.parts.iter().map(|&part| &program.functions[part]);
    let bodies: Vec<&Function<'_>> = parts.chain([function]).collect();
    let used = |kind: Kind| {
        let by_stages = !function.stages.is_empty() && kind != Kind::Noise;
        by_stages || bodies.iter().any(|it| it.body.uses(Source::Argument(kind)))
    };
    let scalars: BTreeSet<String> = bodies.iter().flat_map(|it| it.body.scalars()).collect();
    let scalars = scalars.into_iter().map(|name| format!("{name}: R"));
    arguments(used).into_iter().chain(scalars).collect()
}

/// The name of the function that takes what is computed once, where there is one.
pub(super) fn from(function: &Function<'_>) -> Option<String> {
    let takes = function.is_part && !function.stages.is_empty();
    takes.then(|| format!("{}_from", own_name(function)))
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
    if function.body.uses(Source::Argument(Kind::Noise)) {
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
            let is_array = part.ir.compressed && shape.pattern().is_some();
            let entries = shape.output.entries.len();
            let (value, result) = match shape.scattered(&name) {
                Some(dense) if is_array && !ir.compressed => (dense, shape.result()),
                _ if is_array => (name, format!("[R; {entries}]")),
                _ => (name, shape.result()),
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
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), tuple(&values))],
    }
}

/// A function with a body, without what it takes from stages.
fn own(function: &Function<'_>) -> FunctionText {
    let Function {
        ir, shapes, body, ..
    } = function;
    let mut zeros = Zeros::new();
    let (mut outputs, mut results) = (Vec::new(), Vec::new());
    let mut remaining = body.results.as_slice();
    for (output, shape) in ir.outputs.iter().zip(shapes) {
        let (values, rest) = remaining.split_at(output.entries.len());
        remaining = rest;
        let (result, value) = if ir.compressed && shape.pattern().is_some() {
            let values: Vec<String> = values.iter().map(expression).collect();
            let result = format!("[R; {}]", values.len());
            (result, format!("[{}]", values.join(", ")))
        } else {
            let value = match values {
                [value] if shape.axes.is_empty() => value_of(value),
                _ => shape.dense(values, &mut zeros),
            };
            (shape.result(), value)
        };
        results.push(result);
        outputs.push((output.name.clone(), value));
    }
    let is_whole = from(function).is_none();
    let by_stages = is_whole && !function.stages.is_empty();
    let used = |kind: Kind| (by_stages && kind != Kind::Noise) || body.uses(Source::Argument(kind));
    let scalars = body.scalars().into_iter().map(|name| format!("{name}: R"));
    FunctionText {
        name: own_name(function),
        docs: documentation(function),
        arguments: arguments(used).into_iter().chain(scalars).collect(),
        result: tuple(&results),
        statements: body.statements.iter().map(statement).collect(),
        sets_result_off: !matches!(body.statements.last(), None | Some(Statement::Section(_))),
        zeros,
        outputs,
    }
}

fn documentation(function: &Function<'_>) -> Vec<String> {
    let mut docs = summary(function.ir);
    if function.ir.compressed {
        let entries = "The structurally non-zero entries alone, in the order of the pattern.";
        docs.extend([String::new(), entries.to_owned()]);
    }
    let cost = capitalised(&function.cost.describe());
    docs.extend([String::new(), format!("{cost}.")]);
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
    let dense =
        dense.map(|(shape, values)| shape.scattered(values).unwrap_or_else(|| values.clone()));
    FunctionText {
        name: ir.name.clone(),
        docs: summary(ir),
        arguments: arguments(|kind| kind != Kind::Noise),
        result: tuple(&results),
        statements: source.into_iter().collect(),
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
            if part.ir.compressed && !function.ir.compressed {
                found.extend(part.shapes.iter().filter_map(Shape::scatter));
            }
        }
    }
    let mut bodies = parts.chain([function]);
    if bodies.any(|it| it.body.uses(Source::Argument(Kind::Noise))) {
        found.push("Noise".to_owned());
    }
    for &position in &function.stages {
        let kind = program.stages[position].kind;
        found.push(kind.function.to_owned());
        if from(function).is_some() {
            found.push(kind.type_name.to_owned());
        }
    }
    found
}
