//! The equations of a model, under the headings of its quantities.

use std::collections::{BTreeMap, BTreeSet};

use super::functions::{definition, right_side};
use super::latex::{Printer, Style, has_name, is_derivative};
use super::lines::{equation, listed};
use super::subject::{Subject, cell, inline_math, is_fit, tag, unit_text};
use super::typeset::signed;
use crate::ir::{Expr, Quantity};

/// Equations that stand under one heading.
pub(super) struct Section {
    pub(super) title: String,
    /// Displays in LaTeX, each of several lines.
    pub(super) displays: Vec<Vec<String>>,
    /// What the symbols are.
    pub(super) symbols: Vec<SymbolRow>,
}

/// A symbol, its name in the code, its unit and its meaning.
pub(super) struct SymbolRow {
    pub(super) symbol: String,
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) doc: String,
}

/// The right-hand side of the model: `ẋ = …` for each state.
pub(super) fn drift(printer: &Printer<'_>) -> Vec<Vec<String>> {
    let model = printer.model();
    let Some(function) = model.functions.iter().find(|f| f.name == "drift") else {
        return Vec::new();
    };
    let mut displays = Vec::new();
    for output in &function.outputs {
        for entry in &output.entries {
            let Some(row) = entry.at.first() else {
                continue;
            };
            let left = rate(&printer.variable(row));
            let tag = quantity_of(printer, &entry.expr)
                .map_or(function.equation.as_str(), |quantity| {
                    quantity.equation.as_str()
                });
            if let Some(right) = right_side(printer, &entry.expr, usize::MAX) {
                let bare = |latex: &str| latex.replace(['{', '}', ' '], "");
                let left = if bare(&left) == bare(&signed(&right)) {
                    // The rate is a state itself.
                    let state = printer.variable(row);
                    format!("\\frac{{\\mathrm{{d}} {state}}}{{\\mathrm{{d}} t}}")
                } else {
                    left
                };
                displays.push(equation(&left, &right, &super::subject::tag(tag)));
            }
        }
    }
    displays
}

/// The symbol of a time derivative.
fn rate(symbol: &str) -> String {
    symbol.strip_prefix("\\dot").map_or_else(
        || {
            let split = symbol.find(['_', '^']).unwrap_or(symbol.len());
            let (letter, scripts) = symbol.split_at(split);
            format!("\\dot{{{letter}}}{scripts}")
        },
        |rest| format!("\\ddot{rest}"),
    )
}

fn quantity_of<'a>(printer: &Printer<'a>, expr: &Expr) -> Option<&'a Quantity> {
    match expr {
        Expr::Name(name) => printer.quantity(name),
        _ => None,
    }
}

/// Quantities that stand elsewhere on the page: rows of the drift, and functions that are printed as formulas.
fn printed_elsewhere<'a>(printer: &Printer<'a>, as_formulas: &[&str]) -> BTreeSet<&'a str> {
    let functions = printer
        .model()
        .functions
        .iter()
        .filter(|f| f.name == "drift" || as_formulas.contains(&f.group.as_str()));
    functions
        .flat_map(|function| &function.outputs)
        .flat_map(|output| &output.entries)
        .filter(|entry| !std::ptr::eq(definition(printer, &entry.expr), &entry.expr))
        .filter_map(|entry| quantity_of(printer, &entry.expr))
        .map(|quantity| quantity.name.as_str())
        .collect()
}

/// The named quantities of a model by section; functions of the groups `as_formulas` stand elsewhere.
pub(super) fn sections(
    subject: &Subject<'_>,
    printer: &Printer<'_>,
    as_formulas: &[&str],
) -> Vec<Section> {
    let elsewhere = printed_elsewhere(printer, as_formulas);
    let mut coefficients = coefficients(subject);
    let mut sections: Vec<Section> = Vec::new();
    for quantity in &printer.model().quantities {
        if is_derivative(quantity) || !has_name(quantity) {
            continue;
        }
        let position = match sections.iter().position(|s| s.title == quantity.section) {
            Some(position) => position,
            None => {
                sections.push(Section {
                    title: quantity.section.clone(),
                    displays: Vec::new(),
                    symbols: Vec::new(),
                });
                sections.len() - 1
            }
        };
        let section = &mut sections[position];
        section.symbols.push(SymbolRow {
            symbol: inline_math(&printer.symbol(quantity)),
            name: quantity.name.clone(),
            unit: unit_text(&quantity.unit).to_owned(),
            doc: cell(&quantity.doc),
        });
        if !elsewhere.contains(quantity.name.as_str()) {
            section
                .displays
                .extend(definitions(printer, quantity, &mut coefficients));
        }
    }
    sections
}

/// Values of the coefficients of the curve fits, by leaf.
fn coefficients(subject: &Subject<'_>) -> BTreeMap<String, f64> {
    subject
        .document
        .parameters
        .iter()
        .filter(|p| is_fit(&p.path.0))
        .map(|p| (format!("p.{}", p.name), subject.value(p)))
        .collect()
}

/// A quantity in symbols, and a curve fit with the numbers of the table as well; a number is printed but once.
fn definitions(
    printer: &Printer<'_>,
    quantity: &Quantity,
    coefficients: &mut BTreeMap<String, f64>,
) -> Vec<Vec<String>> {
    let symbol = printer.symbol(quantity);
    let mut displays = Vec::new();
    if let Some(right) = right_side(printer, &quantity.expr, usize::MAX) {
        displays.push(equation(&symbol, &right, &tag(&quantity.equation)));
    }
    let numbers = Style {
        numbers: Some(&*coefficients),
        ..Style::NAMED
    };
    if is_polynomial(&quantity.expr)
        && mentions(&quantity.expr, coefficients)
        && let Some(right) = printer.expression(&quantity.expr, numbers)
    {
        displays.push(listed(&symbol, &right, ""));
        forget(&quantity.expr, coefficients);
    }
    displays
}

/// Whether an expression has sums, products and powers only.
fn is_polynomial(expr: &Expr) -> bool {
    match expr {
        Expr::Apply(parts) => match parts.split_first() {
            Some((Expr::Name(operator), arguments)) => {
                ["+", "-", "*", "neg", "pow"].contains(&operator.as_str())
                    && arguments.iter().all(is_polynomial)
            }
            _ => false,
        },
        _ => true,
    }
}

fn mentions(expr: &Expr, coefficients: &BTreeMap<String, f64>) -> bool {
    match expr {
        Expr::Name(name) => coefficients.contains_key(name),
        Expr::Number(_) => false,
        Expr::Apply(parts) => parts.iter().any(|part| mentions(part, coefficients)),
    }
}

/// Removes the coefficients that an expression mentions.
fn forget(expr: &Expr, coefficients: &mut BTreeMap<String, f64>) {
    match expr {
        Expr::Name(name) => {
            coefficients.remove(name);
        }
        Expr::Number(_) => {}
        Expr::Apply(parts) => {
            for part in parts {
                forget(part, coefficients);
            }
        }
    }
}
