//! The functions of a model: their list, and formulas of those that the paper names.

use std::collections::BTreeMap;

use super::latex::{Printer, Style, has_name, is_derivative};
use super::lines::equation;
use super::subject::{cell, unit_text};
use super::tree::Tex;
use super::typeset::signed;
use crate::ir::{Basis, Document, Expr, Function, Model, Output};

/// Operation counts of a model by function, such as `71 operations: 30 additions, …`.
pub(crate) type Costs = BTreeMap<String, String>;

/// Formulas longer than this are named and counted instead.
const LONGEST_FORMULA: usize = 900;

/// A line of the list of functions.
pub(super) struct FunctionRow {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) equation: String,
    pub(super) shape: String,
    pub(super) entries: String,
    pub(super) unit: String,
    pub(super) cost: String,
}

/// The functions of a model, one a line.
pub(super) fn list(model: &Model, document: &Document, costs: &Costs) -> Vec<FunctionRow> {
    let row = |function: &Function| {
        let joined = |text: fn(&Model, &Document, &Output) -> String| {
            let parts: Vec<String> = function
                .outputs
                .iter()
                .map(|output| text(model, document, output))
                .collect();
            parts.join("; ")
        };
        let unit = function
            .outputs
            .iter()
            .find_map(|output| output.unit.as_deref());
        let cost = costs.get(&function.name);
        FunctionRow {
            name: function.name.clone(),
            doc: cell(&function.doc),
            equation: cell(&function.equation),
            shape: joined(shape),
            entries: joined(entries),
            unit: unit.map_or(String::new(), |unit| unit_text(unit).to_owned()),
            cost: cost.cloned().unwrap_or_default(),
        }
    };
    model.functions.iter().map(row).collect()
}

/// How many members a basis has.
pub(super) fn size(model: &Model, document: &Document, basis: Basis) -> usize {
    model
        .bases
        .get(&basis)
        .map_or(document.parameters.len(), Vec::len)
}

fn shape(model: &Model, document: &Document, output: &Output) -> String {
    if output.basis.is_empty() {
        return "scalar".to_owned();
    }
    let sizes: Vec<String> = output
        .basis
        .iter()
        .map(|basis| format!("{} {basis}", size(model, document, *basis)))
        .collect();
    sizes.join(" × ")
}

fn entries(model: &Model, document: &Document, output: &Output) -> String {
    if output.basis.is_empty() {
        return String::new();
    }
    let all: usize = output
        .basis
        .iter()
        .map(|basis| size(model, document, *basis))
        .product();
    if output.symmetric {
        let mirrored = output.entries.iter().filter(|entry| {
            let last = entry.at.len().saturating_sub(2);
            entry.at.get(last) != entry.at.get(last + 1)
        });
        let count = output.entries.len() + mirrored.count();
        return format!(
            "{} ({count} of {all} with mirror images)",
            output.entries.len()
        );
    }
    format!("{} of {all}", output.entries.len())
}

/// The paper's symbol of a strict-feedback function, of a difference, or of a Lie derivative.
pub(super) fn paper_symbol(name: &str) -> String {
    let subscript = |row: &str| match row {
        "V" | "Q" | "h" => row.to_owned(),
        other => format!("\\{other}"),
    };
    if let Some(rest) = name.strip_prefix("delta_") {
        return format!("\\Delta {}", paper_symbol(rest));
    }
    if let Some(rest) = name.strip_prefix("L_f2_") {
        return format!("L_f^2 {}", subscript(rest));
    }
    for direction in ["f", "g"] {
        if let Some(rest) = name.strip_prefix(&format!("L_{direction}_")) {
            let rest = if rest.starts_with("L_") {
                paper_symbol(rest)
            } else {
                subscript(rest)
            };
            return format!("L_{direction} {rest}");
        }
    }
    match name.split('_').collect::<Vec<_>>().as_slice() {
        [letter @ ("f" | "g" | "h" | "H"), row] => format!("{letter}_{{{}}}", subscript(row)),
        [letter @ ("f" | "g" | "h" | "H"), row, "eta"] => {
            format!("{letter}_{{{}}}^{{\\eta}}", subscript(row))
        }
        [letter @ ("f" | "g" | "h" | "H"), row, rest] => {
            format!("{letter}_{{{}}}^{{\\mathrm{{{rest}}}}}", subscript(row))
        }
        _ => format!("\\mathrm{{{}}}", name.replace('_', "\\_")),
    }
}

/// A function as formulas, one display for each entry; `None` where they are too long.
pub(super) fn formulas(printer: &Printer<'_>, function: &Function) -> Option<Vec<Vec<String>>> {
    let tag = super::subject::tag(&function.equation);
    let mut displays = Vec::new();
    for output in &function.outputs {
        for entry in &output.entries {
            let mut left = paper_symbol(&function.name);
            if !output.name.is_empty() && output.basis.is_empty() {
                left = format!("{left}.{}", paper_symbol(&output.name));
            }
            let at: Vec<String> = entry.at.iter().map(|name| printer.variable(name)).collect();
            match output.basis.as_slice() {
                [] => {}
                [Basis::Mode] => left = format!("{left}^{{{}}}", at.join(" ")),
                _ => left = format!("{left}_{{{}}}", at.join(",")),
            }
            let right = right_side(printer, &entry.expr, LONGEST_FORMULA)?;
            displays.push(equation(&left, &right, &tag));
        }
    }
    Some(displays)
}

/// The formula of an expression: a quantity's definition where it is one, derivatives written out as far as that is
/// not too long.
pub(super) fn right_side(printer: &Printer<'_>, expr: &Expr, longest: usize) -> Option<Tex> {
    let expr = definition(printer, expr);
    // Every node but those that cancel leaves something on the page.
    let nodes = longest.saturating_mul(2);
    [usize::MAX, 4, 3, 2, 1, 0]
        .into_iter()
        .filter_map(|depth| printer.expression_within(nodes, expr, Style::expanded(depth)))
        .find(|tex| signed(tex).len() <= longest)
}

/// The definition of a quantity that an expression is the mere name of.
pub(super) fn definition<'a>(printer: &Printer<'a>, expr: &'a Expr) -> &'a Expr {
    let Expr::Name(name) = expr else {
        return expr;
    };
    printer
        .quantity(name)
        .filter(|quantity| has_name(quantity) && !is_derivative(quantity))
        .map_or(expr, |quantity| &quantity.expr)
}
