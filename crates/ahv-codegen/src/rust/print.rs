//! Prints expressions and statements as Rust.

use super::format::{SECTION, TRAILING};
use super::layout::ADDENDS;
use crate::graph::Kind;
use crate::schedule::tree::{Binding, Expr, Operation, Sign, Source, Statement};

/// A sum of this many addends that is too long for a line is written one a line, so that a new one is one line of a diff.
const LISTED: usize = 3;
/// Longer addends are left to the formatter: one must stay on its line, indented.
const WIDEST: usize = 108;

/// A number as a constant of the scalar.
pub(super) fn literal(value: f64) -> String {
    match value {
        0.0 => "R::ZERO".to_owned(),
        1.0 => "R::ONE".to_owned(),
        2.0 => "R::TWO".to_owned(),
        0.5 => "R::HALF".to_owned(),
        _ => format!("R::from_f64({value:?})"),
    }
}

/// An expression.
pub(super) fn expression(expr: &Expr) -> String {
    match expr {
        Expr::Number(value) => literal(*value),
        Expr::Component(source, name) => component(*source, name),
        Expr::Name(name) => name.clone(),
        Expr::Negative(part) => format!("-{}", enclosed(part, Binding::Product)),
        Expr::Sum(addends) => addends_of(addends).join(" "),
        Expr::Product(factors) => {
            let mut text = String::new();
            for (position, (operation, factor)) in factors.iter().enumerate() {
                text += match (position, operation) {
                    (0, _) => "",
                    (_, Operation::Times) => " * ",
                    (_, Operation::Over) => " / ",
                };
                text += &match factor {
                    Expr::Negative(_) => enclosed(factor, Binding::Product),
                    _ => enclosed(factor, Binding::Atom),
                };
            }
            text
        }
        Expr::Reciprocal(part) => format!("{}.recip()", enclosed(part, Binding::Atom)),
        Expr::Call(call, arguments) => {
            let [first, others @ ..] = arguments.as_slice() else {
                return String::new();
            };
            let others: Vec<String> = others.iter().map(expression).collect();
            let (first, others) = (enclosed(first, Binding::Atom), others.join(", "));
            format!("{first}.{}({others})", call.name())
        }
    }
}

/// A component of an argument.
pub(super) fn component(source: Source, name: &str) -> String {
    let argument = match source {
        Source::Argument(Kind::State) => "x",
        Source::Argument(Kind::Input) => "u",
        Source::Argument(Kind::Noise) => "dw",
        Source::Argument(Kind::Parameter) => "p",
        Source::Argument(Kind::Argument) | Source::Result => return name.to_owned(),
        Source::Stage(stage) => stage.argument,
    };
    format!("{argument}.{name}")
}

/// The unit after a statement; a pure number has none to tell.
fn trailing(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {TRAILING}({unit:?});"),
    }
}

fn enclosed(expr: &Expr, least: Binding) -> String {
    let text = expression(expr);
    if expr.binding() < least {
        format!("({text})")
    } else {
        text
    }
}

/// The addends of a sum, signs included.
fn addends_of(addends: &[(Sign, Expr)]) -> Vec<String> {
    let addend = |(position, (sign, expr)): (usize, &(Sign, Expr))| {
        let sign = match (position, sign) {
            (0, Sign::Plus) => "",
            (0, Sign::Minus) => "-",
            (_, Sign::Plus) => "+ ",
            (_, Sign::Minus) => "- ",
        };
        format!("{sign}{}", enclosed(expr, Binding::Product))
    };
    addends.iter().enumerate().map(addend).collect()
}

/// A heading; without text it is a blank line.
pub(super) fn section(heading: &str) -> String {
    format!("{SECTION}({heading:?});")
}

/// A statement as source text; comments and listed sums travel as the formatter's markers.
pub(super) fn statement(statement: &Statement) -> String {
    match statement {
        Statement::Section(heading) => section(heading),
        Statement::Let { name, value, unit } => {
            format!("let {name} = {};{}", value_of(value), trailing(unit))
        }
        Statement::Set {
            source,
            field,
            value,
            unit,
        } => {
            let field = component(*source, field);
            format!("{field} = {};{}", value_of(value), trailing(unit))
        }
        Statement::SinCos { sin, cos, angle } => {
            let angle = enclosed(angle, Binding::Atom);
            let start = match sin {
                Expr::Name(_) => "let ",
                _ => "",
            };
            let (sin, cos) = (expression(sin), expression(cos));
            format!("{start}({sin}, {cos}) = {angle}.sin_cos();")
        }
    }
}

/// The right-hand side of a `let`, with the formatter's marker where it is a sum to be listed.
pub(super) fn value_of(value: &Expr) -> String {
    if let Expr::Sum(addends) = value {
        let addends = addends_of(addends);
        if addends.len() >= LISTED && addends.iter().all(|a| a.chars().count() <= WIDEST) {
            return format!("{ADDENDS}({:?})", addends.join("|"));
        }
    }
    expression(value)
}
