//! From tables and IR to the files of the generated package.

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::format::format_rust;
use crate::ir::{Document, Model, SCHEMA_VERSION, Variable};
use crate::manifest::{Manifest, sha256};
use crate::model::ModelEmitter;
use crate::{EmitError, Table, Tree};

/// The command that makes and mends the generated files.
const COMMAND: &str = "ahv generate";

/// What the generated package is called and where it finds `ahv-core`.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the package.
    pub package: String,
    /// Where `ahv-core` comes from.
    pub core: Core,
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
}

struct Module {
    name: String,
    doc: String,
}

#[derive(Template)]
#[template(path = "parameters.rs")]
struct ParametersTemplate<'a> {
    parameters: &'a [crate::ir::Parameter],
    validity: &'a [Variable],
}

#[derive(Template)]
#[template(path = "nominal.rs")]
struct NominalTemplate {
    values: Vec<(String, String)>,
    bounds: Vec<(String, String, String)>,
}

#[derive(Template)]
#[template(path = "provenance.rs")]
struct ProvenanceTemplate<'a> {
    parameters: &'a [crate::ir::Parameter],
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
    let mut modules = Vec::new();
    let mut taken = BTreeMap::new();
    for table in tables {
        let text = irs.get(&table.name).ok_or_else(|| {
            EmitError::Mismatch(format!("there is no IR for table `{}`", table.name))
        })?;
        let document = Document::parse(&table.name, text)?;
        for model in &document.models {
            if let Some(other) = taken.insert(model.name.clone(), table.file_name.clone()) {
                return Err(EmitError::Mismatch(format!(
                    "both {other} and {} make the model `{}`; generate them into packages of their own",
                    table.file_name, model.name
                )));
            }
            modules.push(Module {
                name: model.name.clone(),
                doc: format!(
                    "{}: {}, eq. {}.",
                    model.name.to_uppercase(),
                    model.title,
                    model.equations
                ),
            });
        }
        emit_table(&mut tree, table, &document)?;
        tree.insert(format!("ir/{}.json", table.name), text.clone());
    }
    let lib = render(&LibTemplate { modules: &modules });
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

fn emit_table(tree: &mut Tree, table: &Table, document: &Document) -> Result<(), EmitError> {
    let Some(home) = document.models.first().map(|m| m.name.clone()) else {
        return Err(EmitError::Mismatch(format!(
            "the IR of table `{}` holds no model",
            table.name
        )));
    };
    let source = table.file_name.clone();
    let parameters = ParametersTemplate {
        parameters: &document.parameters,
        validity: &document.validity,
    };
    insert_rust(
        tree,
        &format!("src/{home}/parameters.rs"),
        &source,
        &render(&parameters),
    )?;
    let nominal = nominal(table, document)?;
    insert_rust(
        tree,
        &format!("src/{home}/nominal.rs"),
        &source,
        &render(&nominal),
    )?;
    let provenance = ProvenanceTemplate {
        parameters: &document.parameters,
    };
    insert_rust(
        tree,
        &format!("src/{home}/provenance.rs"),
        &source,
        &render(&provenance),
    )?;
    for model in &document.models {
        check_names(model)?;
        for (file, text) in ModelEmitter::new(model, &home, document)?.files()? {
            insert_rust(
                tree,
                &format!("src/{}/{file}.rs", model.name),
                &source,
                &text,
            )?;
        }
    }
    Ok(())
}

fn nominal(table: &Table, document: &Document) -> Result<NominalTemplate, EmitError> {
    let missing = |path: &[&str]| {
        EmitError::Mismatch(format!(
            "{} has no number at `{}`, which its IR names; derive it again",
            table.file_name,
            path.join(".")
        ))
    };
    let mut values = Vec::new();
    for parameter in &document.parameters {
        let path = [
            parameter.path.0.as_str(),
            parameter.path.1.as_str(),
            "value",
        ];
        let value = table.number(&path).ok_or_else(|| missing(&path))?;
        values.push((parameter.name.clone(), format!("{value:?}")));
    }
    let mut bounds = Vec::new();
    for variable in &document.validity {
        let bound = |key: &str| {
            let path = ["validity", variable.name.as_str(), key];
            let value = table.number(&path).ok_or_else(|| missing(&path))?;
            let unit = table
                .text(&["validity", &variable.name, "unit"])
                .unwrap_or_default();
            // Other units of an angle than rad are refused by the derivation.
            let in_degrees = unit.contains("deg");
            Ok::<_, EmitError>(format!(
                "{:?}",
                if in_degrees {
                    value.to_radians()
                } else {
                    value
                }
            ))
        };
        bounds.push((variable.name.clone(), bound("min")?, bound("max")?));
    }
    Ok(NominalTemplate { values, bounds })
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
    let templates: Vec<&str> = vec![
        include_str!("../templates/manifest.toml"),
        include_str!("../templates/functions.rs"),
        include_str!("../templates/lib.rs"),
        include_str!("../templates/model.rs"),
        include_str!("../templates/nominal.rs"),
        include_str!("../templates/parameters.rs"),
        include_str!("../templates/prepared.rs"),
        include_str!("../templates/provenance.rs"),
    ];
    Manifest {
        schema_version: SCHEMA_VERSION,
        emitter: env!("CARGO_PKG_VERSION").to_owned(),
        tables: tables
            .iter()
            .map(|t| (t.name.clone(), t.sha256()))
            .collect(),
        ir: tables
            .iter()
            .filter_map(|t| Some((t.name.clone(), sha256(irs.get(&t.name)?))))
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
