//! How much generated code a change of a table changes: both tables are derived and emitted in memory.

use std::collections::BTreeMap;
use std::path::Path;

use ahv_codegen::{Options, Tree};

use crate::compare::{Difference, Status};
use crate::derive;
use crate::failure::Failure;
use crate::python;
use crate::surroundings::Surroundings;
use crate::tables::Tables;

/// The folder of the code in a generated package.
const CODE: &str = "src/";

/// A file of code that a change of a table changes.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ChangedFile {
    /// Relative to the generated package, with `/`.
    pub path: String,
    /// Lines that are new.
    pub added: usize,
    /// Lines that are gone.
    pub removed: usize,
}

/// The files of Rust that differ between packages that were generated from one table each, with the usual options. Nothing is
/// written.
///
/// # Errors
/// A table that cannot be generated from, no usable Python, a signal.
pub fn changed_code(
    old: &Path,
    new: &Path,
    surroundings: &Surroundings,
) -> Result<Vec<ChangedFile>, Failure> {
    let python = python::for_generation(surroundings)?;
    let emitted = |path: &Path| -> Result<Tree, Failure> {
        let tables = Tables::of_file(path)?;
        let irs = derive::derive(&python, &tables, &BTreeMap::new())?;
        let tree = ahv_codegen::emit(&tables.parsed, &irs, &Options::default());
        tree.map_err(|error| Failure::new(error.to_string()))
    };
    let [before, after] = [emitted(old)?, emitted(new)?];
    let mut paths: Vec<&String> = before.keys().chain(after.keys()).collect();
    paths.sort();
    paths.dedup();
    let changed = paths
        .into_iter()
        .filter(|path| path.starts_with(CODE) && before.get(*path) != after.get(*path));
    let counted = changed.map(|path| {
        let text = |tree: &Tree| tree.get(path).cloned().unwrap_or_default();
        let (added, removed) =
            Difference::of_texts(path.clone(), Status::Differs, text(&before), text(&after))
                .counts();
        ChangedFile {
            path: path.clone(),
            added,
            removed,
        }
    });
    Ok(counted.collect())
}
