//! The first page: which models there are, and how the pages are to be read.

use askama::Template;

use super::subject::{Subject, verbatim};
use crate::EmitError;
use crate::ir::Basis;
use crate::template::render;

#[derive(Template)]
#[template(path = "docs/index.md")]
struct IndexPage<'a> {
    tables: Vec<TableRow<'a>>,
    models: Vec<ModelRow<'a>>,
    further: &'a [Page],
}

/// A page that another part of the emitter makes.
pub(crate) struct Page {
    /// Its path relative to the index.
    pub(crate) path: String,
    /// Its title.
    pub(crate) title: String,
    /// What stands on it, in a sentence.
    pub(crate) about: String,
}

struct TableRow<'a> {
    name: &'a str,
    file_name: String,
    units: &'a str,
    models: String,
    choices: String,
    sets: String,
}

struct ModelRow<'a> {
    name: &'a str,
    title: &'a str,
    equations: &'a str,
    states: usize,
    inputs: usize,
    noises: usize,
    functions: usize,
    table: &'a str,
}

/// The index of the documentation of all tables.
pub(super) fn page(subjects: &[Subject<'_>], further: &[Page]) -> Result<String, EmitError> {
    let tables = subjects.iter().map(|subject| {
        let document = subject.document;
        let names: Vec<String> = document
            .models
            .iter()
            .map(|model| format!("[{0}]({0}.md)", model.name))
            .collect();
        let choices = document.choices.iter().map(|choice| {
            let chosen = subject
                .chosen(choice)
                .map_or("", |option| option.name.as_str());
            format!("{} = {chosen}", choice.name)
        });
        let sets: Vec<&str> = document.sets.iter().map(|set| set.name.as_str()).collect();
        TableRow {
            name: &subject.table.name,
            file_name: verbatim(&subject.table.file_name),
            units: document.units.system.name(),
            models: names.join(", "),
            choices: choices.collect::<Vec<_>>().join(", "),
            sets: sets.join(", "),
        }
    });
    let models = subjects.iter().flat_map(|subject| {
        subject.document.models.iter().map(|model| {
            let size = |basis| model.bases.get(&basis).map_or(0, Vec::len);
            ModelRow {
                name: &model.name,
                title: &model.title,
                equations: &model.equations,
                states: size(Basis::State),
                inputs: size(Basis::Input),
                noises: size(Basis::Noise),
                functions: model.functions.len(),
                table: &subject.table.name,
            }
        })
    });
    render(&IndexPage {
        tables: tables.collect(),
        models: models.collect(),
        further,
    })
}
