//! The files of the Rust package: those of tables and models, the documentation, and what holds them together.

use askama::Template;
use std::collections::BTreeMap;

use super::{checks, format::format_rust, home};
use crate::docs::{self, AUDIT, Page};
use crate::graph::passes::Passes;
use crate::ir::Model;
use crate::manifest::{Earlier, Manifest};
use crate::options::Options;
use crate::parallel;
use crate::schedule::effect;
use crate::schedule::program::Program;
use crate::subject::Subject;
use crate::template::render;
use crate::wording::visible;
use crate::{EmitError, Tree};

/// The command that makes and mends the generated files.
const COMMAND: &str = "ahv generate";
const AUDIT_PAGE: &str = "docs/audit.md";

#[derive(Template)]
#[template(path = "manifest.toml", escape = "none")]
struct CargoTemplate<'a> {
    options: &'a Options,
    /// As TOML has it, with its quotes.
    about: String,
    version: &'a str,
}

#[derive(Template)]
#[template(path = "lib.rs")]
struct LibTemplate<'a> {
    about: &'a str,
    modules: &'a [Module],
    units: &'static str,
}

struct Module {
    name: String,
    doc: String,
}

/// The Rust package.
pub(crate) struct Package<'a> {
    pub(crate) subjects: &'a [Subject<'a>],
    pub(crate) irs: &'a BTreeMap<String, String>,
    pub(crate) units: &'static str,
    pub(crate) options: &'a Options,
    /// The tree of an earlier emission by the same emitter.
    pub(crate) earlier: Option<&'a Earlier>,
    pub(crate) manifest: &'a Manifest,
}

impl Package<'_> {
    /// Puts its files into the tree.
    ///
    /// # Errors
    /// [`EmitError`] when a name is not valid in Rust, or the IR names what it does not have.
    pub(crate) fn emit(&self, tree: &mut Tree) -> Result<(), EmitError> {
        let Self {
            subjects,
            irs,
            units,
            options,
            earlier,
            manifest,
        } = *self;
        let modules = modules(subjects);
        let mut sources = Vec::new();
        let mut jobs = Vec::new();
        for subject in subjects {
            if let Some(files) = earlier.and_then(|it| all_of(subject, it, manifest)) {
                tree.extend(files);
                continue;
            }
            let home = emit_home(subject, &mut sources)?;
            tree.extend(docs::emit_table(subject)?);
            jobs.extend(subject.document.models.iter().map(|model| Job {
                subject: *subject,
                model,
                home,
                earlier: earlier.filter(|it| it.has_ir_of(manifest, &subject.table.name)),
            }));
        }
        tree.extend(emit_passes(subjects, earlier, manifest)?);
        for emitted in parallel::map(&jobs, |job| job.emit(&options.passes)) {
            let emitted = emitted?;
            sources.extend(emitted.sources);
            tree.extend(emitted.pages);
        }
        tree.extend(emit_audit(irs)?);
        let audit = tree.contains_key(AUDIT_PAGE).then(audit_page);
        let further: Vec<Page> = audit.into_iter().chain([docs::passes_page()]).collect();
        tree.extend(docs::emit_index(subjects, &further)?);
        let about = about(subjects);
        let lib = render(&LibTemplate {
            about: &about,
            modules: &modules,
            units,
        })?;
        sources.push(Source {
            path: "src/lib.rs".to_owned(),
            origin: "the tables",
            text: lib,
            known: None,
        });
        for formatted in parallel::map(&sources, Source::formatted) {
            let (path, text) = formatted?;
            tree.insert(path, text);
        }
        let cargo = CargoTemplate {
            options,
            about: toml_edit::Value::from(about).to_string(),
            version: env!("CARGO_PKG_VERSION"),
        };
        let cargo = render(&cargo)? + "\n";
        checks::package(&options.package, &cargo)?;
        for subject in subjects {
            checks::sets(subject, tree)?;
        }
        tree.insert("Cargo.toml".to_owned(), cargo);
        Ok(())
    }
}

/// What the package is, in a sentence.
fn about(subjects: &[Subject<'_>]) -> String {
    let names: Vec<_> = subjects.iter().map(|it| visible(&it.table.name)).collect();
    match names.as_slice() {
        [first @ .., second, last] => {
            let first: String = first.iter().map(|name| format!("{name}, ")).collect();
            format!("Models generated from the tables {first}{second} and {last}")
        }
        _ => format!("Models generated from the table {}", names.concat()),
    }
}

/// The modules of the package, one a model.
fn modules(subjects: &[Subject<'_>]) -> Vec<Module> {
    let models = subjects.iter().flat_map(|it| &it.document.models);
    let module = |model: &Model| Module {
        name: model.name.clone(),
        doc: format!("{}.", model.heading()),
    };
    models.map(module).collect()
}

/// The audit of printed equations, where the derivation made one.
fn emit_audit(irs: &BTreeMap<String, String>) -> Result<Tree, EmitError> {
    let Some(text) = irs.get(AUDIT) else {
        return Ok(Tree::new());
    };
    Ok(Tree::from([
        (format!("ir/{AUDIT}.json"), text.clone()),
        (AUDIT_PAGE.to_owned(), docs::audit(text)?),
    ]))
}

fn audit_page() -> Page {
    Page {
        path: "audit.md".to_owned(),
        title: "Audit".to_owned(),
        about: "the paper's printed equations beside the derived ones, with their differences"
            .to_owned(),
    }
}

/// A Rust file before it is formatted.
struct Source<'a> {
    path: String,
    /// What it is made from.
    origin: &'a str,
    text: String,
    /// What became of the same text before.
    known: Option<&'a str>,
}

impl Source<'_> {
    fn formatted(&self) -> Result<(String, String), EmitError> {
        if let Some(text) = self.known {
            return Ok((self.path.clone(), text.to_owned()));
        }
        let header = format!(
            "Generated by `{COMMAND}` from {}. Do not edit.",
            visible(self.origin)
        );
        let text = format_rust(&self.path, &header, &self.text)?;
        Ok((self.path.clone(), text))
    }
}

/// The sources of a table's parameters; the module in which they stand.
fn emit_home<'a>(
    subject: &Subject<'a>,
    sources: &mut Vec<Source<'a>>,
) -> Result<&'a str, EmitError> {
    let Subject {
        table,
        document,
        values,
    } = *subject;
    let Some(home) = document.models.first() else {
        return Err(EmitError::Mismatch(format!(
            "the IR of table `{}` holds no model",
            table.name
        )));
    };
    for (file, text) in home::files(document, values)? {
        sources.push(Source {
            path: format!("src/{}/{file}.rs", home.name),
            origin: &table.file_name,
            text,
            known: None,
        });
    }
    Ok(&home.name)
}

/// A model to emit.
struct Job<'a> {
    subject: Subject<'a>,
    model: &'a Model,
    home: &'a str,
    /// The tree of an earlier emission with the same IR.
    earlier: Option<&'a Earlier>,
}

/// What a model gives.
struct Emitted<'a> {
    sources: Vec<Source<'a>>,
    pages: Tree,
}

impl<'a> Job<'a> {
    fn emit(&self, passes: &Passes) -> Result<Emitted<'a>, EmitError> {
        self.model.check_names()?;
        let program = Program::new(self.model, self.home, self.subject.document, passes)?;
        let files = super::files(&program)?.into_iter();
        let source = |(file, text): (String, String)| {
            let path = format!("src/{}/{file}.rs", self.model.name);
            Source {
                known: self.earlier.and_then(|it| it.text(&path)),
                path,
                origin: &self.subject.table.file_name,
                text,
            }
        };
        Ok(Emitted {
            sources: files.map(source).collect(),
            pages: docs::emit_model(&self.subject, self.model, &program.costs())?,
        })
    }
}

/// All files of a table and its models, where neither IR nor values have changed.
fn all_of(subject: &Subject<'_>, earlier: &Earlier, now: &Manifest) -> Option<Tree> {
    let (table, models) = (&subject.table.name, &subject.document.models);
    if !earlier.has_table_of(now, table) {
        return None;
    }
    let page = format!("docs/{table}-table.md");
    let of_model = |name: &str, path: &str| {
        let path = path.strip_prefix("src/");
        path.and_then(|it| it.strip_prefix(name))
            .is_some_and(|it| it.starts_with('/'))
    };
    earlier.all(|path| {
        let mut names = models.iter().map(|model| model.name.as_str());
        path == page || names.any(|name| path == format!("docs/{name}.md") || of_model(name, path))
    })
}

/// The page of the passes, which depends on the models alone.
fn emit_passes(
    subjects: &[Subject<'_>],
    earlier: Option<&Earlier>,
    now: &Manifest,
) -> Result<Tree, EmitError> {
    let page = format!("docs/{}", docs::passes_page().path);
    if let Some(earlier) = earlier
        && earlier.manifest.tables.keys().eq(now.tables.keys())
        && now.tables.keys().all(|table| earlier.has_ir_of(now, table))
        && let Some(text) = earlier.text(&page)
    {
        return Ok(Tree::from([(page, text.to_owned())]));
    }
    let models: Vec<&Model> = subjects.iter().flat_map(|it| &it.document.models).collect();
    let effects = parallel::map(&models, |model| effect::of(model));
    let effects = effects.into_iter().collect::<Result<Vec<_>, EmitError>>()?;
    docs::emit_passes(models.into_iter().zip(&effects))
}
