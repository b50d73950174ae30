//! How emitted functions are worded: their names, arguments, results and documentation.

use std::collections::BTreeSet;

use crate::EmitError;
use crate::body::Statement;
use crate::dag::Kind;
use crate::format;
use crate::ir::{self, described};

/// The name of the compressed form.
pub(crate) fn values_name(function: &ir::Function) -> String {
    format!("{}_values", function.name)
}

/// One item as it is, several as a tuple.
pub(crate) fn tuple(items: &[String]) -> String {
    match items {
        [item] => item.clone(),
        _ => format!("({})", items.join(", ")),
    }
}

/// The arguments of a function; those that a model hands to every function may stay unused.
pub(crate) fn arguments(used: impl Fn(Kind) -> bool, scalars: &BTreeSet<String>) -> Vec<String> {
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
    arguments.extend(scalars.iter().map(|name| format!("{name}: R")));
    arguments
}

/// What a function computes, from which equation, in which unit.
pub(crate) fn summary(function: &ir::Function) -> Vec<String> {
    let unit = function.outputs.iter().find_map(|o| o.unit.as_deref());
    let unit = match unit {
        Some(unit) if function.outputs.len() == 1 => format!(" Unit: {unit}."),
        _ => String::new(),
    };
    let equation = match function.equation.as_str() {
        "" => String::new(),
        equation => format!(", eq. {equation}"),
    };
    wrapped(&format!("{}{equation}.{unit}", function.doc))
}

/// The implementation of a vector, from the names and units of its fields.
pub(crate) fn vector_impl<'a>(
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

/// A text of a user in one line: what cannot be seen, or turns the direction of what follows, as its code.
pub(crate) fn visible(text: &str) -> String {
    let hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(c, '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
    };
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => line.push(' '),
            c if hidden(c) => line.extend(c.escape_unicode()),
            c => line.push(c),
        }
    }
    line
}

/// A text in lines of a comment's width.
pub(crate) fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 110;
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].chars().count() + 1 + word.chars().count() > WIDTH
        {
            lines.push(word.to_owned());
        } else {
            if !lines[last].is_empty() {
                lines[last].push(' ');
            }
            lines[last] += word;
        }
    }
    lines
}

/// A function that ends in `let y = …; y` ends in the expression itself.
pub(crate) fn return_last(statements: &mut Vec<Statement>, result: &mut String) {
    if let Some(Statement::Let { name, value, .. }) = statements.last()
        && name == result
    {
        *result = value.source();
        statements.pop();
    }
}

pub(crate) fn parameter_doc(document: &ir::Document, name: &str) -> String {
    let parameter = document.parameters.iter().find(|p| p.name == name);
    parameter.map_or_else(String::new, |p| described(&p.doc, &p.unit))
}

/// The formula of a prepared value for a reader: that of its `let` where it has one.
pub(crate) fn formula(value: &str, statements: &[Statement]) -> String {
    let bound = statements.iter().find_map(|statement| match statement {
        Statement::Let {
            name, value: bound, ..
        } if name == value => Some(bound.text()),
        _ => None,
    });
    let text = bound.unwrap_or_else(|| value.to_owned()).replace("p.", "");
    match text.strip_suffix(".recip()") {
        Some(below) => format!("1 / {below}"),
        None => text.replace("R::TWO", "2").replace("R::from_f64(3.0)", "3"),
    }
}
