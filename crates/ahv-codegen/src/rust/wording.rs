//! How emitted functions are worded: their names, arguments, results and documentation.

use crate::graph::Kind;
use crate::ir;

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
