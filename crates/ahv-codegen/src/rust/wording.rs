//! How emitted functions are worded: their names, arguments, results and documentation.

use super::format;
use super::print::expression;
use crate::EmitError;
use crate::graph::Kind;
use crate::ir;
use crate::schedule::tree::Expr;

/// The name of the compressed form.
pub(super) fn values_name(function: &ir::Function) -> String {
    format!("{}_values", function.name)
}

/// One item as it is, several as a tuple.
pub(super) fn tuple(items: &[String]) -> String {
    match items {
        [item] => item.clone(),
        _ => format!("({})", items.join(", ")),
    }
}

/// The arguments of a function; those that a model hands to every function may stay unused.
pub(super) fn arguments(used: impl Fn(Kind) -> bool) -> Vec<String> {
    let by_reference = |name: &str, kind: Kind, ty: &str| {
        let unused = if used(kind) { "" } else { "_" };
        format!("{unused}{name}: &{ty}<R>")
    };
    let mut arguments = vec![
        by_reference("x", Kind::State, "State"),
        by_reference("u", Kind::Input, "Input"),
        by_reference("p", Kind::Parameter, "Prepared"),
    ];
    if used(Kind::Noise) {
        arguments.push(by_reference("dw", Kind::Noise, "Noise"));
    }
    arguments
}

/// The implementation of a vector, from the names and units of its fields.
pub(super) fn vector_impl<'a>(
    vector: &str,
    fields: impl Iterator<Item = (&'a String, &'a String)>,
    units: &ir::Units,
) -> Result<String, EmitError> {
    let mut lines = Vec::new();
    for (name, unit) in fields {
        let (si, factor) = units.si(unit)?;
        lines.push(format!("{name}: [{unit:?}, {si:?}, {factor:?}],"));
    }
    Ok(format::vector(vector, &lines))
}

/// The formula of a field for a reader.
pub(super) fn formula(value: &Expr) -> String {
    let text = expression(value).replace("c.", "").replace("p.", "");
    match text.strip_suffix(".recip()") {
        Some(below) => format!("1 / {below}"),
        None => text.replace("R::TWO", "2").replace("R::from_f64(3.0)", "3"),
    }
}
