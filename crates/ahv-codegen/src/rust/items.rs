//! What stands in a file of functions.

use std::collections::BTreeSet;

use super::dense::{PatternText, Zeros};
use super::print::{expression, statement, value_of};
use super::wording::{arguments, tuple, values_name};
use crate::graph::Kind;
use crate::ir::capitalised;
use crate::schedule::program::Function;
use crate::schedule::tree::{Expr, Statement};
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
    /// What the dense form takes from the compressed one.
    pub(super) source: Option<String>,
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
        source: None,
        statements: Vec::new(),
        sets_result_off: false,
        zeros,
        outputs: vec![(String::new(), dense)],
    })
}

/// The function itself, or its compressed form.
pub(super) fn function(function: &Function<'_>) -> FunctionText {
    let Function { ir, shapes, body } = function;
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
    let mut docs = summary(ir);
    if ir.compressed {
        docs.push(String::new());
        docs.push(
            "The structurally non-zero entries alone, in the order of the pattern.".to_owned(),
        );
    }
    docs.push(String::new());
    docs.push(format!("{}.", capitalised(&body.cost().describe())));
    FunctionText {
        name: if ir.compressed {
            values_name(ir)
        } else {
            ir.name.clone()
        },
        docs,
        arguments: arguments(|kind| body.uses(kind), &body.scalars()),
        result: tuple(&results),
        source: None,
        statements: body.statements.iter().map(statement).collect(),
        sets_result_off: !matches!(body.statements.last(), None | Some(Statement::Section(_))),
        zeros,
        outputs,
    }
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
        arguments: arguments(|kind| kind != Kind::Noise, &BTreeSet::new()),
        result: tuple(&results),
        source,
        statements: Vec::new(),
        sets_result_off: false,
        zeros: Zeros::new(),
        outputs: vec![(String::new(), tuple(&dense.collect::<Vec<_>>()))],
    }
}
