//! From tables and IR to the files of the generated package.

use std::collections::{BTreeMap, BTreeSet};

use crate::c;
use crate::docs::{self, AUDIT};
use crate::ir::{Document, SCHEMA_VERSION};
use crate::manifest::{Earlier, Manifest, sha256};
use crate::options::{Options, Target};
use crate::rust;
use crate::subject::Subject;
use crate::table_schema;
use crate::values::Values;
use crate::{EmitError, Table, Tree};

/// What is known of tables and tree when a package is emitted again.
#[derive(Debug, Default)]
pub struct Known {
    /// Hash of what derived the IRs, for the manifest.
    pub generator: String,
    /// Hash of the structure of each table, for the manifest.
    pub structure: BTreeMap<String, String>,
    /// The tree of an earlier emission.
    pub earlier: Option<Earlier>,
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
    emit_again(tables, irs, options, &Known::default())
}

/// The same tree as that of [`emit()`], with the manifest of what is `known`. Files of an earlier tree whose inputs have not
/// changed are taken from there: a changed value leaves the models' functions as they are.
///
/// # Errors
/// As for [`emit()`].
pub fn emit_again(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
    known: &Known,
) -> Result<Tree, EmitError> {
    let mut tree = Tree::new();
    let mut read = Vec::new();
    for table in tables {
        let text = irs.get(&table.name).ok_or_else(|| {
            EmitError::Mismatch(format!("there is no IR for table `{}`", table.name))
        })?;
        let mut document = Document::parse(&table.name, text)?;
        if options.target == Target::Rust {
            // In the units that the table has, whatever those of the package.
            let schema = table_schema::schema(&document);
            tree.insert(format!("schema/{}.json", table.name), schema);
        }
        let values = Values::read(table, &mut document, options.units)?;
        tree.insert(format!("ir/{}.json", table.name), text.clone());
        read.push((table, document, values));
    }
    check_models(read.iter().map(|(table, document, _)| (*table, document)))?;
    for (table, document, _) in &read {
        rust::checks::choices(table, document)?;
    }
    let units: BTreeSet<_> = read.iter().map(|(_, d, _)| d.units.in_words()).collect();
    if units.len() > 1 {
        return Err(EmitError::Mismatch(
            "the tables are in different unit systems; choose one with --units".to_owned(),
        ));
    }
    let mut manifest = manifest(tables, irs, options, known);
    let system = read.first().map(|(_, document, _)| document.units.system);
    manifest.units = system.map_or_else(String::new, |it| it.name().to_owned());
    let earlier = known
        .earlier
        .as_ref()
        .filter(|it| it.has_emitter_of(&manifest));
    let subjects: Vec<Subject<'_>> = read
        .iter()
        .map(|(table, document, values)| Subject {
            table,
            document,
            values,
        })
        .collect();
    let units = units.first().copied().unwrap_or_default();
    match options.target {
        Target::Rust => {
            let package = rust::Package {
                subjects: &subjects,
                irs,
                units,
                options,
                earlier,
                manifest: &manifest,
            };
            package.emit(&mut tree)?;
        }
        Target::C => tree.extend(c::files(&subjects, units, &options.passes)?),
    }
    // The IRs are listed already.
    let files = tree
        .iter()
        .filter(|(path, _)| manifest.written(path).is_none());
    manifest.files = files
        .map(|(path, text)| (path.clone(), sha256(text)))
        .collect();
    tree.insert("manifest.json".to_owned(), manifest.sealed().render());
    Ok(tree)
}

/// A model is of one table alone: its name is that of a module.
fn check_models<'a>(
    documents: impl Iterator<Item = (&'a Table, &'a Document)>,
) -> Result<(), EmitError> {
    let mut taken = BTreeMap::new();
    for (table, document) in documents {
        for model in &document.models {
            if let Some(other) = taken.insert(&model.name, &table.file_name) {
                return Err(EmitError::Mismatch(format!(
                    "both {other} and {} make the model `{}`; generate them into packages of their own",
                    table.file_name, model.name
                )));
            }
        }
    }
    Ok(())
}

/// The manifest without the hashes of files.
fn manifest(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
    options: &Options,
    known: &Known,
) -> Manifest {
    let templates = match options.target {
        Target::Rust => rust::TEMPLATES.concat() + &docs::TEMPLATES.concat(),
        Target::C => c::TEMPLATES.concat() + &c::LIBRARY.map(|(_, text)| text).concat(),
    };
    // The audit of printed equations is no part of a C library.
    let has = |name: &str| name != AUDIT || options.target == Target::Rust;
    let left_out = options.passes.left_out();
    Manifest {
        schema_version: SCHEMA_VERSION,
        emitter: env!("CARGO_PKG_VERSION").to_owned(),
        emitter_sources: include_str!(concat!(env!("OUT_DIR"), "/emitter.txt")).to_owned(),
        generator: known.generator.clone(),
        units: String::new(),
        structure: known.structure.clone(),
        tables: tables
            .iter()
            .map(|t| (t.name.clone(), t.sha256()))
            .collect(),
        ir: irs
            .iter()
            .filter(|(name, _)| has(name))
            .map(|(name, text)| (name.clone(), sha256(text)))
            .collect(),
        templates: sha256(&templates),
        language: options.target.language().map(str::to_owned),
        without_passes: left_out.map(|p| p.name().to_owned()).collect(),
        files: BTreeMap::new(),
        seal: String::new(),
    }
}
