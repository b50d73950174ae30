//! From tables and IR to the files of the generated package.

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::docs::{self, Costs, Page, Subject};
use crate::format::format_rust;
use crate::home;
use crate::ir::{Document, Model, SCHEMA_VERSION};
use crate::manifest::{Manifest, sha256};
use crate::model::ModelEmitter;
use crate::values::Values;
use crate::{EmitError, Table, Tree};

/// The command that makes and mends the generated files.
const COMMAND: &str = "ahv generate";
/// The model that has the paper's equations as they are printed.
const PRINTED: &str = "sdcom_printed";
/// Under this name stands, beside the IRs of the tables, the audit of the printed equations.
pub const AUDIT: &str = "audit";
const AUDIT_PAGE: &str = "docs/audit.md";

/// What the generated package is called and where it finds `ahv-core`.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the package.
    pub package: String,
    /// Where `ahv-core` comes from.
    pub core: Core,
    /// Unit system, `ft-slug-s-rad` or `si`; without one that of the table.
    pub units: Option<String>,
}

/// Where the generated package finds `ahv-core`.
#[derive(Clone, Debug)]
pub enum Core {
    /// At a path relative to the package.
    Path(String),
    /// Where the workspace around the package says.
    Workspace,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            package: "ahv-models".to_owned(),
            core: Core::Path("../crates/ahv-core".to_owned()),
            units: None,
        }
    }
}

impl Options {
    /// The line of the package's manifest that names `ahv-core`.
    fn core_dependency(&self) -> String {
        match &self.core {
            Core::Path(path) => {
                let version = env!("CARGO_PKG_VERSION");
                // A TOML string of its own: a path may hold quotes and backslashes.
                let path = toml_edit::Value::from(path.as_str());
                format!(
                    "ahv-core = {{ version = \"{version}\", path = {} }}",
                    path.to_string().trim()
                )
            }
            Core::Workspace => "ahv-core.workspace = true".to_owned(),
        }
    }
}

#[derive(Template)]
#[template(path = "manifest.toml", escape = "none")]
struct CargoTemplate<'a> {
    options: &'a Options,
    version: &'a str,
}

#[derive(Template)]
#[template(path = "lib.rs")]
struct LibTemplate<'a> {
    modules: &'a [Module],
    units: &'static str,
}

struct Module {
    name: String,
    doc: String,
}

/// The files of the generated package, by their path in it.
///
/// `irs` holds the IR text of each table, by the table's name.
///
/// # Errors
/// [`EmitError`] when an IR cannot be read or does not belong to its table, or two tables make the same model.
pub fn emit(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
) -> Result<Tree, EmitError> {
    let mut tree = Tree::new();
    let mut read = Vec::new();
    for table in tables {
        let text = irs.get(&table.name).ok_or_else(|| {
            EmitError::Mismatch(format!("there is no IR for table `{}`", table.name))
        })?;
        let mut document = Document::parse(&table.name, text)?;
        let values = Values::read(table, &mut document, options.units.as_deref())?;
        tree.insert(format!("ir/{}.json", table.name), text.clone());
        read.push((table, document, values));
    }
    let modules = modules(read.iter().map(|(table, document, _)| (*table, document)))?;
    let units: BTreeSet<_> = read.iter().map(|(_, d, _)| d.units.in_words()).collect();
    if units.len() > 1 {
        return Err(EmitError::Mismatch(
            "the tables are in different unit systems; choose one with --units".to_owned(),
        ));
    }
    let mut subjects = Vec::new();
    for (table, document, values) in &read {
        let subject = Subject {
            table,
            document,
            values,
        };
        let costs = emit_table(&mut tree, &subject)?;
        tree.extend(docs::emit_table(&subject, &costs)?);
        subjects.push(subject);
    }
    tree.extend(emit_audit(&subjects, irs)?);
    let further: Vec<Page> = tree
        .contains_key(AUDIT_PAGE)
        .then(audit_page)
        .into_iter()
        .collect();
    tree.extend(docs::emit_index(&subjects, &further));
    let lib = render(&LibTemplate {
        modules: &modules,
        units: units.first().copied().unwrap_or_default(),
    });
    insert_rust(&mut tree, "src/lib.rs", "the tables", &lib)?;
    let cargo = CargoTemplate {
        options,
        version: env!("CARGO_PKG_VERSION"),
    };
    tree.insert("Cargo.toml".to_owned(), render(&cargo) + "\n");
    let manifest = manifest(tables, irs);
    tree.insert("manifest.json".to_owned(), manifest.render());
    Ok(tree)
}

/// The modules of the package, one a model.
fn modules<'a>(
    documents: impl Iterator<Item = (&'a Table, &'a Document)>,
) -> Result<Vec<Module>, EmitError> {
    let (mut modules, mut taken) = (Vec::new(), BTreeMap::new());
    for (table, document) in documents {
        for model in &document.models {
            if let Some(other) = taken.insert(model.name.clone(), table.file_name.clone()) {
                return Err(EmitError::Mismatch(format!(
                    "both {other} and {} make the model `{}`; generate them into packages of their own",
                    table.file_name, model.name
                )));
            }
            let label = model.name.to_uppercase();
            modules.push(Module {
                name: model.name.clone(),
                doc: format!("{label}: {}, eq. {}.", model.title, model.equations),
            });
        }
    }
    Ok(modules)
}

/// The audit of the paper's printed equations, for a package that holds the printed form.
fn emit_audit(subjects: &[Subject<'_>], irs: &BTreeMap<String, String>) -> Result<Tree, EmitError> {
    let mut models = subjects.iter().flat_map(|subject| &subject.document.models);
    if !models.any(|model| model.name == PRINTED) {
        return Ok(Tree::new());
    }
    let text = irs.get(AUDIT).ok_or_else(|| {
        EmitError::Mismatch(format!(
            "`{PRINTED}` needs the audit of the printed equations"
        ))
    })?;
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

/// The sources of one table and its models; the operations of each function.
fn emit_table(tree: &mut Tree, subject: &Subject<'_>) -> Result<Costs, EmitError> {
    let Subject {
        table,
        document,
        values,
    } = *subject;
    let Some(home) = document.models.first().map(|m| m.name.clone()) else {
        return Err(EmitError::Mismatch(format!(
            "the IR of table `{}` holds no model",
            table.name
        )));
    };
    let source = &table.file_name;
    for (file, text) in home::files(document, values)? {
        insert_rust(tree, &format!("src/{home}/{file}.rs"), source, &text)?;
    }
    let mut costs = Costs::new();
    for model in &document.models {
        check_names(model)?;
        let mut emitter = ModelEmitter::new(model, &home, document)?;
        for (file, text) in emitter.files()? {
            insert_rust(
                tree,
                &format!("src/{}/{file}.rs", model.name),
                source,
                &text,
            )?;
        }
        let named = emitter.costs.into_iter();
        costs.extend(named.map(|(function, cost)| ((model.name.clone(), function), cost)));
    }
    Ok(costs)
}

/// Two leaves of one struct must not share a name, whatever the IR says.
fn check_names(model: &Model) -> Result<(), EmitError> {
    for (basis, variables) in &model.bases {
        let names: BTreeSet<_> = variables.iter().map(|v| &v.name).collect();
        if names.len() != variables.len() {
            return Err(EmitError::Mismatch(format!(
                "the basis `{basis}` of model `{}` holds a name twice",
                model.name
            )));
        }
    }
    Ok(())
}

fn manifest(tables: &[Table], irs: &BTreeMap<String, String>) -> Manifest {
    let templates: Vec<&str> = [
        include_str!("../templates/manifest.toml"),
        include_str!("../templates/choices.rs"),
        include_str!("../templates/functions.rs"),
        include_str!("../templates/lib.rs"),
        include_str!("../templates/model.rs"),
        include_str!("../templates/nominal.rs"),
        include_str!("../templates/parameters.rs"),
        include_str!("../templates/prepared.rs"),
        include_str!("../templates/provenance.rs"),
    ]
    .into_iter()
    .chain(docs::TEMPLATES)
    .collect();
    Manifest {
        schema_version: SCHEMA_VERSION,
        emitter: env!("CARGO_PKG_VERSION").to_owned(),
        tables: tables
            .iter()
            .map(|t| (t.name.clone(), t.sha256()))
            .collect(),
        ir: irs
            .iter()
            .map(|(name, text)| (name.clone(), sha256(text)))
            .collect(),
        templates: sha256(&templates.concat()),
    }
}

pub(crate) fn render(template: &impl Template) -> String {
    // A template fails only where a value's Display fails; none of ours does.
    template.render().unwrap_or_default()
}

fn insert_rust(tree: &mut Tree, path: &str, source: &str, text: &str) -> Result<(), EmitError> {
    let header = format!("Generated by `{COMMAND}` from {source}. Do not edit.");
    tree.insert(path.to_owned(), format_rust(path, &header, text)?);
    Ok(())
}
