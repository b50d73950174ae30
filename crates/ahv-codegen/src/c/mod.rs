//! The C99 files of a model and of a table, printed from the same tree as the Rust and with the same bits.

mod functions;
mod print;
mod stages;
mod types;
mod words;

use askama::Template;

use crate::graph::passes::Passes;
use crate::ir::{Basis, Choice, ChoiceOption, Parameter, Variable};
use crate::rust::filters;
use crate::schedule::program::Program;
use crate::subject::Subject;
use crate::template::render;
use crate::wording::wrapped;
use crate::{EmitError, Tree, parallel};
use functions::{Functions, Text};
use print::{comment, comments};
use types::{Struct, Types, camel};

/// The command that makes the files.
const COMMAND: &str = "ahv generate";

/// Files that every C package has: elementary functions with the bits of `ahv-core`.
pub(crate) const LIBRARY: [(&str, &str); 2] = [
    (
        "ahv_elementary.h",
        include_str!("../../templates/c/ahv_elementary.h"),
    ),
    (
        "ahv_elementary.c",
        include_str!("../../templates/c/ahv_elementary.c"),
    ),
];

/// The templates, for the manifest.
pub(crate) const TEMPLATES: [&str; 5] = [
    include_str!("../../templates/c/model.h"),
    include_str!("../../templates/c/model.c"),
    include_str!("../../templates/c/parameters.h"),
    include_str!("../../templates/c/parameters.c"),
    include_str!("../../templates/c/README.md"),
];

#[derive(Template)]
#[template(path = "c/model.h", escape = "none")]
struct Header<'a> {
    origin: &'a str,
    heading: String,
    units: &'static str,
    guard: String,
    table: String,
    structs: Vec<Struct>,
    functions: &'a [Text],
    own: &'a str,
    prefix: &'a str,
    is_stochastic: bool,
}

#[derive(Template)]
#[template(path = "c/model.c", escape = "none")]
struct Code<'a> {
    origin: &'a str,
    heading: String,
    model: &'a str,
    functions: &'a [Text],
    own: &'a str,
    prefix: &'a str,
    states: Vec<&'a str>,
    is_stochastic: bool,
    /// Whether matrices are set to zero.
    needs_string: bool,
}

#[derive(Template)]
#[template(path = "c/parameters.h", escape = "none")]
struct ParametersHeader<'a> {
    origin: &'a str,
    subject: &'a Subject<'a>,
    units: &'static str,
    guard: String,
    own: String,
    prefix: String,
}

#[derive(Template)]
#[template(path = "c/parameters.c", escape = "none")]
struct ParametersCode<'a> {
    origin: &'a str,
    subject: &'a Subject<'a>,
    table: String,
    own: String,
    prefix: String,
}

#[derive(Template)]
#[template(path = "c/README.md", escape = "none")]
struct Readme<'a> {
    units: &'static str,
    /// The name of each model, its heading and its table.
    models: &'a [(String, String, String)],
}

impl ParametersHeader<'_> {
    fn parameter_line(&self, parameter: &Parameter) -> String {
        field_line("double", &parameter.name, &parameter.described())
    }

    fn validity_line(&self, variable: &Variable) -> String {
        let of = format!("{}Bounds", self.own);
        field_line(&of, &variable.name, &variable.described())
    }

    /// Names and values of the parameters.
    fn nominal(&self) -> impl Iterator<Item = (&str, String)> {
        let names = self.subject.document.parameters.iter().map(|it| &*it.name);
        names.zip(
            self.subject
                .values
                .nominal
                .iter()
                .map(|it| format!("{it:?}")),
        )
    }

    fn bounds(&self) -> impl Iterator<Item = (&str, String, String)> {
        let names = self.subject.document.validity.iter().map(|it| &*it.name);
        let bounds = names.zip(&self.subject.values.bounds);
        bounds.map(|(name, (min, max))| (name, format!("{min:?}"), format!("{max:?}")))
    }

    fn variant(&self, choice: &Choice, option: &ChoiceOption) -> String {
        variant(&self.prefix, choice, option)
    }
}

impl ParametersCode<'_> {
    /// Sets besides the table's own: the values that each replaces.
    fn sets(&self) -> impl Iterator<Item = (&str, Vec<(&str, String)>)> {
        let document = self.subject.document;
        let sets = document.sets.iter().zip(&self.subject.values.sets).skip(1);
        sets.map(|(set, values)| {
            let values = values.iter().map(|(name, it)| (&**name, format!("{it:?}")));
            (&*set.name, values.collect())
        })
    }

    fn variant(&self, choice: &Choice, option: &ChoiceOption) -> String {
        variant(&self.prefix, choice, option)
    }
}

fn variant(prefix: &str, choice: &Choice, option: &ChoiceOption) -> String {
    let name = format!("{prefix}{}_{}", choice.name, identifier(&option.name));
    name.to_uppercase()
}

impl Header<'_> {
    fn declared(&self) -> impl Iterator<Item = &Text> {
        self.functions.iter().filter(|it| !it.is_static)
    }
}

impl Struct {
    fn line(&self, (of, name, doc): &(String, String, String)) -> String {
        field_line(of, name, doc)
    }
}

/// A field of a struct, its description beside or above it.
fn field_line(of: &str, name: &str, doc: &str) -> String {
    let line = format!("    {of} {name};");
    if doc.is_empty() {
        return line;
    }
    let note = comment(doc);
    if line.len() + 1 + note.chars().count() <= 118 {
        return format!("{line} {note}");
    }
    format!("{}\n{line}", comments(&wrapped(doc), "    "))
}

/// The files of the C library, by their path in it.
///
/// # Errors
/// [`EmitError`] where a name is a word of the language, or the IR holds what it cannot.
pub(crate) fn files(
    subjects: &[Subject<'_>],
    units: &'static str,
    passes: &Passes,
) -> Result<Tree, EmitError> {
    let mut tree = Tree::new();
    let mut put = |name: &str, text: String| match tree.insert(format!("src/{name}"), text) {
        Some(_) => Err(EmitError::Mismatch(format!(
            "two files of the C library would be called {name}; choose another name for a table or model"
        ))),
        None => Ok(()),
    };
    for (name, text) in LIBRARY {
        put(
            name,
            format!("/* Generated by `{COMMAND}`. Do not edit. */\n\n{text}"),
        )?;
    }
    words::check_types(subjects)?;
    for subject in subjects {
        let document = subject.document;
        let home = document.models.first().map_or("", |model| &model.name);
        let models = parallel::map(&document.models, |it| {
            it.check_names()?;
            let program = Program::new(it, home, document, passes)?.called();
            model(&program, &subject.table.file_name)
        });
        for files in [table(subject)].into_iter().chain(models) {
            for (name, text) in files? {
                put(&name, text)?;
            }
        }
    }
    tree.insert("README.md".to_owned(), readme(subjects, units)?);
    Ok(tree)
}

/// The C files of a model, by their names.
fn model(program: &Program<'_>, origin: &str) -> Result<Vec<(String, String)>, EmitError> {
    let name = &program.model.name;
    let types = Types::of(program);
    let own = types.own.clone();
    let prefix = format!("{name}_");
    let structs = types.structs(program);
    let functions = Functions {
        program,
        types,
        prefix: prefix.clone(),
    };
    let texts = functions.texts();
    words::check(program, &structs)?;
    let joint = program.functions.iter();
    let mut joint = joint.filter(|it| it.ir.name == "drift_and_noise_increment");
    let is_stochastic = joint.next().is_some();
    let states = program.model.bases.get(&Basis::State);
    let states = states.into_iter().flatten().map(|it| &*it.name).collect();
    let needs_string = texts
        .iter()
        .any(|text| text.lines.iter().any(|line| line.contains("memset(")));
    let header = Header {
        origin,
        heading: program.model.heading(),
        units: program.document.units.in_words(),
        guard: format!("AHV_{}_H", name.to_uppercase()),
        table: identifier(&program.document.provenance.table),
        structs,
        functions: &texts,
        own: &own,
        prefix: &prefix,
        is_stochastic,
    };
    let code = Code {
        origin,
        heading: program.model.heading(),
        model: name,
        functions: &texts,
        own: &own,
        prefix: &prefix,
        states,
        is_stochastic,
        needs_string,
    };
    Ok(vec![
        (format!("{name}.h"), render(&header)? + "\n"),
        (format!("{name}.c"), render(&code)? + "\n"),
    ])
}

/// The C files of a table, by their names.
fn table(subject: &Subject<'_>) -> Result<Vec<(String, String)>, EmitError> {
    let document = subject.document;
    let table = identifier(&document.provenance.table);
    let (own, prefix) = (camel(&table), format!("{table}_"));
    let origin = &*subject.table.file_name;
    let header = ParametersHeader {
        origin,
        subject,
        units: document.units.in_words(),
        guard: format!("AHV_{}_PARAMETERS_H", table.to_uppercase()),
        own: own.clone(),
        prefix: prefix.clone(),
    };
    let code = ParametersCode {
        origin,
        subject,
        table: table.clone(),
        own,
        prefix,
    };
    Ok(vec![
        (format!("{table}_parameters.h"), render(&header)? + "\n"),
        (format!("{table}_parameters.c"), render(&code)? + "\n"),
    ])
}

/// What stands beside the sources.
fn readme(subjects: &[Subject<'_>], units: &'static str) -> Result<String, EmitError> {
    let models = subjects.iter().flat_map(|subject| {
        let table = identifier(&subject.document.provenance.table);
        let models = subject.document.models.iter();
        models.map(move |model| (model.name.clone(), model.heading(), table.clone()))
    });
    let models: Vec<_> = models.collect();
    Ok(render(&Readme {
        units,
        models: &models,
    })? + "\n")
}

/// A text of a user in a comment.
pub(crate) fn plain(text: &str) -> String {
    print::harmless(text)
}

/// The name of a set or table as a part of a C name: in lower case, with `_` for what a C name cannot hold.
#[must_use]
pub fn identifier(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.to_lowercase().chars().map(letter).collect()
}
