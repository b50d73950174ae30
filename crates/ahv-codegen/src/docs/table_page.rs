//! The page of a table: its numbers, where they come from and how sure they are.

use askama::Template;
use std::collections::BTreeSet;

use super::subject::{
    CHOICES, Subject, cell, inline_math, is_fit, plain_number, readable, unit_text, verbatim,
};
use crate::EmitError;
use crate::ir::{Parameter, ParameterSet};
use crate::template::render;

#[derive(Template)]
#[template(path = "docs/table.md")]
struct TablePage<'a> {
    file_name: String,
    name: &'a str,
    units: &'a str,
    other_units: &'a str,
    factors: Vec<[String; 3]>,
    models: Vec<String>,
    sections: Vec<Section<'a>>,
    choices: Vec<ChoiceText<'a>>,
    sets: Vec<SetText>,
    sources: Vec<(String, String)>,
    validity: Vec<BoundsRow>,
}

struct Section<'a> {
    title: String,
    set_names: Vec<&'a str>,
    rows: Vec<Row>,
}

struct Row {
    symbol: String,
    name: String,
    doc: String,
    value: String,
    sets: Vec<String>,
    unit: String,
    status: String,
    uncertainty: String,
    source: String,
}

struct ChoiceText<'a> {
    name: &'a str,
    doc: &'a str,
    chosen: String,
    heads: Vec<String>,
    options: Vec<OptionRow>,
}

struct OptionRow {
    name: String,
    doc: String,
    values: Vec<String>,
}

struct SetText {
    name: String,
    replaced: usize,
    own: bool,
}

struct BoundsRow {
    name: String,
    doc: String,
    min: String,
    max: String,
    unit: String,
}

/// The page of a table.
pub(super) fn page(subject: &Subject<'_>) -> Result<String, EmitError> {
    let document = subject.document;
    let bases = document
        .models
        .iter()
        .flat_map(|model| model.bases.values())
        .flatten();
    let used: BTreeSet<&str> = document
        .parameters
        .iter()
        .map(|parameter| parameter.unit.as_str())
        .chain(bases.map(|variable| variable.unit.as_str()))
        .collect();
    let factors = document.units.factors.iter();
    render(&TablePage {
        file_name: verbatim(&subject.table.file_name),
        name: &subject.table.name,
        units: document.units.system.name(),
        other_units: document.units.other.name(),
        factors: factors
            .filter(|(unit, (other, _))| *unit != other && used.contains(unit.as_str()))
            .map(|(unit, (other, factor))| [unit.clone(), other.clone(), plain_number(*factor)])
            .collect(),
        models: document
            .models
            .iter()
            .map(|model| format!("[{0}]({0}.md)", model.name))
            .collect(),
        sections: sections(subject),
        choices: choices(subject),
        sets: sets(subject),
        sources: sources(subject),
        validity: validity(subject),
    })
}

fn sections<'a>(subject: &Subject<'a>) -> Vec<Section<'a>> {
    let mut sections: Vec<Section<'a>> = Vec::new();
    let mut last = "";
    // Switches stand between parameters, but are a matter of choices.
    for parameter in subject
        .document
        .parameters
        .iter()
        .filter(|p| p.path.0 != CHOICES)
    {
        let section = parameter.path.0.as_str();
        if section != last {
            let known: Vec<&ParameterSet> = subject
                .document
                .sets
                .iter()
                .filter(|set| {
                    set.parameters
                        .iter()
                        .any(|r| section_of(subject, &r.name) == Some(section))
                })
                .collect();
            sections.push(Section {
                title: section_title(section),
                set_names: known.iter().map(|set| set.name.as_str()).collect(),
                rows: Vec::new(),
            });
            last = section;
        }
        if let Some(section) = sections.last_mut() {
            let row = row(subject, parameter, &section.set_names);
            section.rows.push(row);
        }
    }
    sections
}

fn section_of<'a>(subject: &Subject<'a>, parameter: &str) -> Option<&'a str> {
    let parameters = &subject.document.parameters;
    parameters
        .iter()
        .find(|p| p.name == parameter)
        .map(|p| p.path.0.as_str())
}

fn section_title(section: &str) -> String {
    if is_fit(section) {
        format!("Curve fit `{section}`")
    } else {
        crate::ir::capitalised(section)
    }
}

fn row(subject: &Subject<'_>, parameter: &Parameter, sets: &[&str]) -> Row {
    let value = |name: &&str| {
        let set = subject
            .document
            .sets
            .iter()
            .find(|set| set.name == **name)?;
        let replaced = set.parameters.iter().find(|r| r.name == parameter.name)?;
        let value = plain_number(subject.replacement(set, &parameter.name));
        Some(format!(
            "{value} ({}, {})",
            replaced.status,
            verbatim(&replaced.source)
        ))
    };
    Row {
        symbol: inline_math(&parameter.symbol),
        name: parameter.name.clone(),
        doc: cell(&parameter.doc),
        value: plain_number(subject.value(parameter)),
        sets: sets
            .iter()
            .map(|name| value(name).unwrap_or_default())
            .collect(),
        unit: unit_text(&parameter.unit).to_owned(),
        status: parameter.status.to_string(),
        uncertainty: percent(parameter.uncertainty),
        source: verbatim(&parameter.source),
    }
}

fn percent(share: f64) -> String {
    if share == 0.0 {
        return "–".to_owned();
    }
    // A share such as 0.07 is not exactly seven hundredths.
    let percent = (share * 1e8).round() / 1e6;
    format!("±{} %", plain_number(percent))
}

fn choices<'a>(subject: &Subject<'a>) -> Vec<ChoiceText<'a>> {
    let text = |choice: &'a crate::ir::Choice| {
        let switches: BTreeSet<&str> = choice
            .options
            .iter()
            .flat_map(|option| option.values.keys().map(String::as_str))
            .collect();
        let symbol = |name: &str| {
            let parameter = subject.document.parameters.iter().find(|p| p.name == name);
            let symbol = parameter
                .map(|p| inline_math(&p.symbol) + " ")
                .unwrap_or_default();
            format!("{symbol}`{name}`")
        };
        ChoiceText {
            name: &choice.name,
            doc: &choice.doc,
            chosen: subject
                .chosen(choice)
                .map_or(String::new(), |option| option.name.clone()),
            heads: switches.iter().map(|name| symbol(name)).collect(),
            options: choice
                .options
                .iter()
                .map(|option| OptionRow {
                    name: option.name.clone(),
                    doc: cell(&option.doc),
                    values: switches
                        .iter()
                        .map(|name| {
                            option
                                .values
                                .get(*name)
                                .map_or(String::new(), |v| plain_number(*v))
                        })
                        .collect(),
                })
                .collect(),
        }
    };
    subject.document.choices.iter().map(text).collect()
}

fn sets(subject: &Subject<'_>) -> Vec<SetText> {
    let sets = subject.document.sets.iter().enumerate();
    sets.map(|(position, set)| SetText {
        name: set.name.clone(),
        replaced: set.parameters.len(),
        own: position == 0,
    })
    .collect()
}

/// The sources that entries name, in the order of their first mention.
fn sources(subject: &Subject<'_>) -> Vec<(String, String)> {
    let document = subject.document;
    let of_sets = document
        .sets
        .iter()
        .flat_map(|set| &set.parameters)
        .map(|r| &r.source);
    let mut found: Vec<(String, String)> = Vec::new();
    for key in document.parameters.iter().map(|p| &p.source).chain(of_sets) {
        if !found.iter().any(|(known, _)| *known == verbatim(key))
            && let Some(text) = subject.table.text(&["sources", key])
        {
            found.push((verbatim(key), verbatim(text)));
        }
    }
    found
}

fn validity(subject: &Subject<'_>) -> Vec<BoundsRow> {
    let row = |variable: &crate::ir::Variable| {
        let (min, max) = subject.bounds(&variable.name)?;
        let ((min, unit), (max, _)) =
            (readable(min, &variable.unit), readable(max, &variable.unit));
        Some(BoundsRow {
            name: variable.name.clone(),
            doc: cell(&variable.doc),
            min: plain_number(min),
            max: plain_number(max),
            unit: unit_text(&unit).to_owned(),
        })
    };
    subject.document.validity.iter().filter_map(row).collect()
}
