//! The page of a model.

use askama::Template;

use super::equations::{self, Section, SymbolRow};
use super::functions::{self, Costs, FunctionRow};
use super::latex::Printer;
use super::noise::{self, Noise};
use super::structure::{self, Pattern};
use super::subject::{Subject, cell, inline_math, plain_number, readable, unit_text, verbatim};
use crate::EmitError;
use crate::ir::{self, Function, Model};
use crate::template::render;

/// Groups of functions that are printed as formulas.
const AS_FORMULAS: [&str; 3] = ["strict_feedback", "moments", "responses"];
/// The group whose functions have names in the paper.
const STRICT_FEEDBACK: &str = "strict_feedback";

#[derive(Template)]
#[template(path = "docs/model.md")]
struct ModelPage<'a> {
    file_name: String,
    table: &'a str,
    units: &'a str,
    model: &'a Model,
    bases: Vec<Basis>,
    drift: Vec<Vec<String>>,
    patterns: Vec<Pattern>,
    sections: Vec<Section>,
    feedback: Vec<Captioned>,
    others: Vec<Captioned>,
    noise: Option<Noise>,
    functions: Vec<FunctionRow>,
}

/// A vector of the model and its entries.
struct Basis {
    title: &'static str,
    rows: Vec<SymbolRow>,
    /// Range in the validity box, row by row.
    ranges: Vec<String>,
}

impl Basis {
    fn is_bounded(&self) -> bool {
        self.ranges.iter().any(|range| !range.is_empty())
    }
}

/// The page of a model of a table.
pub(super) fn page(
    subject: &Subject<'_>,
    model: &Model,
    costs: &Costs,
) -> Result<String, EmitError> {
    let document = subject.document;
    let printer = Printer::new(model, document);
    let (feedback, others) = formulas(&printer);
    render(&ModelPage {
        file_name: verbatim(&subject.table.file_name),
        table: &subject.table.name,
        units: document.units.system.name(),
        model,
        bases: bases(subject, model),
        drift: equations::drift(&printer),
        patterns: structure::patterns(&printer, document),
        sections: equations::sections(subject, &printer, &AS_FORMULAS),
        feedback,
        others,
        noise: noise::of(&printer),
        functions: functions::list(model, document, costs),
    })
}

fn bases(subject: &Subject<'_>, model: &Model) -> Vec<Basis> {
    let mut found = Vec::new();
    for (basis, title) in [
        (ir::Basis::State, "States"),
        (ir::Basis::Input, "Inputs"),
        (ir::Basis::Noise, "Wiener processes"),
        (ir::Basis::Argument, "Other arguments"),
    ] {
        let variables = model.bases.get(&basis);
        let Some(variables) = variables.filter(|variables| !variables.is_empty()) else {
            continue;
        };
        let rows = variables.iter().map(|variable| SymbolRow {
            symbol: inline_math(&variable.symbol),
            name: variable.name.clone(),
            unit: unit_text(&variable.unit).to_owned(),
            doc: cell(&variable.doc),
        });
        let ranges = variables.iter().map(|variable| {
            let bounds = variable
                .validity
                .as_deref()
                .and_then(|name| subject.bounds(name));
            bounds.map_or_else(String::new, |bounds| range(bounds, &variable.unit))
        });
        found.push(Basis {
            title,
            rows: rows.collect(),
            ranges: ranges.collect(),
        });
    }
    found
}

fn range((min, max): (f64, f64), unit: &str) -> String {
    let ((min, unit), (max, _)) = (readable(min, unit), readable(max, unit));
    let unit = if unit == "1" { "" } else { &unit };
    format!("{} to {} {unit}", plain_number(min), plain_number(max))
        .trim_end()
        .to_owned()
}

/// A function as formulas, with its name and what it computes.
struct Captioned {
    name: String,
    doc: String,
    /// None where they are too long.
    displays: Vec<Vec<String>>,
}

/// Formulas of the functions: those of the strict-feedback form, and others.
fn formulas(printer: &Printer<'_>) -> (Vec<Captioned>, Vec<Captioned>) {
    let chosen =
        |f: &&Function| AS_FORMULAS.contains(&f.group.as_str()) && !f.name.starts_with("delta_");
    let functions = printer.model().functions.iter().filter(chosen);
    let (feedback, others): (Vec<&Function>, Vec<&Function>) =
        functions.partition(|function| function.group == STRICT_FEEDBACK);
    let captioned = |function: &Function| Captioned {
        name: function.name.clone(),
        doc: function.doc.clone(),
        displays: functions::formulas(printer, function).unwrap_or_default(),
    };
    let all = |functions: Vec<&Function>| functions.into_iter().map(captioned).collect();
    (all(feedback), all(others))
}
