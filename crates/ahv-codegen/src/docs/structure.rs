//! The structural pattern of a model as tables: which rows of the drift depend on what.

use std::collections::{BTreeMap, BTreeSet};

use super::latex::Printer;
use super::subject::{inline_math, verbatim};
use crate::ir::{Basis, Document, Expr, Model, Output};

/// A matrix whose rows are the states.
pub(super) struct Pattern {
    /// What its entries are.
    pub(super) title: String,
    pub(super) columns: Vec<String>,
    /// Each begins with its state.
    pub(super) rows: Vec<Vec<String>>,
}

/// The patterns of the derivatives of the drift, and of the diffusion.
pub(super) fn patterns(printer: &Printer<'_>, document: &Document) -> Vec<Pattern> {
    let model = printer.model();
    let varying = varying_quantities(model);
    let mut patterns = Vec::new();
    for (function, columns, title) in [
        ("jacobians", Basis::State, "\\partial f/\\partial x"),
        ("jacobians", Basis::Input, "\\partial f/\\partial u"),
        ("diffusion", Basis::Noise, "G"),
    ] {
        if let Some(output) = find(model, function, columns) {
            let names = names(model, columns);
            let label = |name: &&str| inline_math(&printer.variable(name));
            patterns.push(Pattern {
                title: inline_math(title),
                columns: names.iter().map(label).collect(),
                rows: rows(printer, &names, |row, column| {
                    let (sign, _) = mark(output, &varying, row, |at| at == column)?;
                    Some(sign.to_owned())
                }),
            });
        }
    }
    if let Some(output) = find(model, "parameter_jacobian", Basis::Parameter) {
        patterns.push(by_section(printer, document, output, &varying));
    }
    patterns
}

/// The parameter Jacobian, its columns counted by section of the table.
fn by_section(
    printer: &Printer<'_>,
    document: &Document,
    output: &Output,
    varying: &BTreeSet<&str>,
) -> Pattern {
    let mut sections: Vec<&str> = Vec::new();
    let mut section_of = BTreeMap::new();
    for parameter in &document.parameters {
        let section = parameter.path.0.as_str();
        if !sections.contains(&section) {
            sections.push(section);
        }
        section_of.insert(parameter.name.as_str(), section);
    }
    Pattern {
        title: inline_math("\\partial f/\\partial p"),
        columns: sections.iter().map(|section| verbatim(section)).collect(),
        rows: rows(printer, &sections, |row, section| {
            let belongs = |parameter: &str| section_of.get(parameter) == Some(&section);
            let (sign, count) = mark(output, varying, row, belongs)?;
            Some(format!("{sign} {count}"))
        }),
    }
}

/// An output over states and another basis.
fn find<'a>(model: &'a Model, function: &str, columns: Basis) -> Option<&'a Output> {
    let function = model.functions.iter().find(|f| f.name == function)?;
    function
        .outputs
        .iter()
        .find(|output| output.basis == [Basis::State, columns])
}

fn names(model: &Model, basis: Basis) -> Vec<&str> {
    let members = model.bases.get(&basis).map_or(&[] as &[_], Vec::as_slice);
    members.iter().map(|it| it.name.as_str()).collect()
}

fn rows(
    printer: &Printer<'_>,
    columns: &[&str],
    cell: impl Fn(&str, &str) -> Option<String>,
) -> Vec<Vec<String>> {
    let row = |state: &str| {
        let cells = columns.iter().map(|column| cell(state, column));
        let label = inline_math(&printer.variable(state));
        [label]
            .into_iter()
            .chain(cells.map(Option::unwrap_or_default))
            .collect()
    };
    names(printer.model(), Basis::State)
        .into_iter()
        .map(row)
        .collect()
}

/// How the entries of a row in the columns that are asked for are marked, and how many there are; none where all are 0.
fn mark(
    output: &Output,
    varying: &BTreeSet<&str>,
    row: &str,
    wanted: impl Fn(&str) -> bool,
) -> Option<(&'static str, usize)> {
    let entries = output.entries.iter();
    let entries = entries.filter(|it| matches!(&it.at[..], [at, of] if at == row && wanted(of)));
    let changing: Vec<bool> = entries.map(|it| depends(&it.expr, varying)).collect();
    let sign = if changing.contains(&true) {
        "●"
    } else {
        "○"
    };
    (!changing.is_empty()).then_some((sign, changing.len()))
}

/// Quantities that depend on state or input.
fn varying_quantities(model: &Model) -> BTreeSet<&str> {
    let mut varying = BTreeSet::new();
    for quantity in &model.quantities {
        if depends(&quantity.expr, &varying) {
            varying.insert(quantity.name.as_str());
        }
    }
    varying
}

fn depends(expr: &Expr, varying: &BTreeSet<&str>) -> bool {
    match expr {
        Expr::Number(_) => false,
        Expr::Name(name) => {
            name.starts_with("x.") || name.starts_with("u.") || varying.contains(name.as_str())
        }
        Expr::Apply(parts) => parts.iter().skip(1).any(|part| depends(part, varying)),
    }
}
