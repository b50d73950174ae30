//! The files of one table: its parameters, their values, where they come from, and what is chosen by name.

use askama::Template;

use super::filters;
use super::records;
use crate::EmitError;
use crate::ir::{Basis, Choice, Document, Status, Variable, capitalised};
use crate::template::render;
use crate::values::Values;

#[derive(Template)]
#[template(path = "parameters.rs")]
struct ParametersTemplate<'a> {
    parameters: String,
    validity: &'a [Variable],
}

#[derive(Template)]
#[template(path = "nominal.rs")]
struct NominalTemplate<'a> {
    system: &'a str,
    own_set: &'a str,
    /// Whether a number is computed from one in degrees.
    has_degrees: bool,
    values: Vec<(String, String)>,
    sets: Vec<SetText>,
    bounds: Vec<(String, String, String)>,
}

#[derive(Template)]
#[template(path = "table.rs")]
struct TableTemplate<'a> {
    name: &'a str,
    models: Vec<String>,
    document: &'a Document,
}

impl TableTemplate<'_> {
    /// What limits an entry to some models.
    fn only_for(&self, models: &[String]) -> String {
        match models {
            [] => String::new(),
            models => format!(".only_for(&{models:?})"),
        }
    }

    /// States and inputs of the table's models that an entry of the validity box bounds, as a list.
    fn bounded(&self, entry: &str) -> Vec<String> {
        let mut found = Vec::new();
        let vectors = self.document.models.iter().flat_map(|model| {
            [Basis::State, Basis::Input]
                .into_iter()
                .filter_map(|basis| model.bases.get(&basis))
        });
        for variable in vectors.flatten() {
            if variable.validity.as_deref() == Some(entry) && !found.contains(&variable.name) {
                found.push(variable.name.clone());
            }
        }
        found
    }
}

struct SetText {
    name: String,
    constant: String,
    values: Vec<(String, String)>,
}

#[derive(Template)]
#[template(path = "provenance.rs")]
struct ProvenanceTemplate {
    lists: Vec<ProvenanceList>,
}

struct ProvenanceList {
    /// The set that it belongs to, empty for the table's own.
    set: String,
    constant: String,
    /// Name, source, status and uncertainty.
    entries: Vec<(String, String, Status, String)>,
    /// Whether the other entries are those of the table.
    rest: bool,
}

#[derive(Template)]
#[template(path = "choices.rs")]
struct ChoicesTemplate {
    choices: Vec<ChoiceText>,
}

struct ChoiceText {
    name: String,
    doc: String,
    type_name: String,
    options: Vec<OptionText>,
}

struct OptionText {
    name: String,
    variant: String,
    doc: String,
    values: Vec<(String, String)>,
}

/// The texts of a table's files, by name without ending.
pub(crate) fn files(
    document: &Document,
    values: &Values,
) -> Result<Vec<(&'static str, String)>, EmitError> {
    let fields = document.parameters.iter();
    let fields = fields.map(|it| (&*it.name, it.described(), &*it.unit));
    let about = "One value for each parameter and coefficient of the table.";
    let parameters = ParametersTemplate {
        parameters: records::vector(about, "Parameters", fields, &document.units)?,
        validity: &document.validity,
    };
    let table = TableTemplate {
        name: &document.provenance.table,
        models: document.models.iter().map(|m| m.name.clone()).collect(),
        document,
    };
    let mut files = vec![
        ("parameters", render(&parameters)?),
        ("nominal", render(&nominal(document, values))?),
        ("provenance", render(&provenance(document))?),
        ("table", render(&table)?),
    ];
    if !document.choices.is_empty() {
        let choices = document.choices.iter().map(choice).collect();
        files.push(("choices", render(&ChoicesTemplate { choices })?));
    }
    Ok(files)
}

/// What the other models of a table take from its home.
pub(crate) fn shared(document: &Document) -> Vec<String> {
    let mut names: Vec<String> = [
        "NOMINAL",
        "PROVENANCE",
        "Parameters",
        "SETS",
        "TABLE",
        "UNIT_SYSTEM",
        "VALIDITY",
        "Validity",
    ]
    .map(str::to_owned)
    .into();
    for set in document.sets.iter().skip(1) {
        names.extend(constants(&set.name));
    }
    names.extend(
        document
            .choices
            .iter()
            .map(|choice| choice.type_name.clone()),
    );
    names.sort_unstable();
    names
}

fn nominal<'a>(document: &'a Document, values: &Values) -> NominalTemplate<'a> {
    let names = document.parameters.iter().map(|p| p.name.clone());
    let sets = document.sets.iter().zip(&values.sets).skip(1);
    let bounds = document.validity.iter().zip(&values.bounds);
    NominalTemplate {
        system: document.units.system.name(),
        own_set: document.sets.first().map_or("", |set| &set.name),
        has_degrees: values.written.iter().any(|written| !written.is_empty()),
        values: names
            .zip(&values.nominal)
            .map(|(name, &value)| (name.clone(), values.text(0, &name, value)))
            .collect(),
        sets: sets
            .zip(1..)
            .map(|((set, replaced), index)| SetText {
                name: set.name.clone(),
                constant: constant(&set.name),
                values: replaced
                    .iter()
                    .map(|(name, v)| (name.clone(), values.text(index, name, *v)))
                    .collect(),
            })
            .collect(),
        bounds: bounds
            .map(|(v, &(min, max))| (v.name.clone(), format!("{min:?}"), format!("{max:?}")))
            .collect(),
    }
}

fn provenance(document: &Document) -> ProvenanceTemplate {
    let mut lists = vec![ProvenanceList {
        set: String::new(),
        constant: "PROVENANCE".to_owned(),
        entries: document
            .parameters
            .iter()
            .map(|p| entry(&p.name, &p.source, p.status, p.uncertainty))
            .collect(),
        rest: false,
    }];
    for set in document.sets.iter().skip(1) {
        let replaced = set.parameters.iter();
        lists.push(ProvenanceList {
            set: set.name.clone(),
            constant: format!("{}_PROVENANCE", constant(&set.name)),
            entries: replaced
                .map(|p| entry(&p.name, &p.source, p.status, p.uncertainty))
                .collect(),
            rest: true,
        });
    }
    ProvenanceTemplate { lists }
}

fn entry(
    name: &str,
    source: &str,
    status: Status,
    uncertainty: f64,
) -> (String, String, Status, String) {
    let quoted = format!("{source:?}");
    (name.to_owned(), quoted, status, format!("{uncertainty:?}"))
}

fn choice(choice: &Choice) -> ChoiceText {
    let scalar = |value: &f64| match *value {
        0.0 => "R::ZERO".to_owned(),
        1.0 => "R::ONE".to_owned(),
        other => format!("R::from_f64({other:?})"),
    };
    let options = choice.options.iter().map(|option| OptionText {
        name: option.name.clone(),
        variant: capitalised(&option.name),
        doc: format!("{}.", capitalised(&option.doc)),
        values: option
            .values
            .iter()
            .map(|(name, v)| (name.clone(), scalar(v)))
            .collect(),
    });
    ChoiceText {
        name: choice.name.clone(),
        doc: format!("{}.", capitalised(&choice.doc)),
        type_name: choice.type_name.clone(),
        options: options.collect(),
    }
}

/// The constants that a set becomes: its values, and where they come from.
pub(crate) fn constants(set: &str) -> [String; 2] {
    let values = constant(set);
    let provenance = format!("{values}_PROVENANCE");
    [values, provenance]
}

/// The name of a set as a constant: `section5.3` becomes `SECTION5_3`.
fn constant(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_uppercase()
            } else {
                '_'
            }
        })
        .collect()
}
