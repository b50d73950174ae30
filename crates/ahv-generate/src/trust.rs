//! What of the tree on disk a generation would make again, by the hashes in its manifest.

use std::collections::BTreeMap;
use std::path::Path;

use ahv_codegen::{AUDIT, Earlier, Known, Manifest, sha256};

use crate::compare::{ir_path, text_of};
use crate::manifest;
use crate::tables::Tables;
use crate::{python, structure};

/// What need not be derived or emitted again.
#[derive(Default)]
pub(crate) struct Trusted {
    /// The IRs by their tables' names, and the audit.
    pub(crate) irs: BTreeMap<String, String>,
    /// Whether those are all: nothing is to be derived.
    pub(crate) is_whole: bool,
    earlier: Option<Earlier>,
}

impl Trusted {
    /// An IR is trusted if its bytes are those that were derived, from a table of the same structure, by the same generator.
    pub(crate) fn of(out: &Path, tables: &Tables) -> Self {
        // A merge may put together hashes that were never written by one run.
        let Some(manifest) = manifest::whole(out).filter(Manifest::is_sealed) else {
            return Self::default();
        };
        let irs = irs(out, tables, &manifest);
        let is_whole = tables.parsed.iter().all(|table| irs.contains_key(&table.name))
            // Of a table that has gone, the audit may go, too.
            && irs.keys().eq(manifest.ir.keys());
        let inside = |path: &&String| path.split('/').all(|part| !["", ".", ".."].contains(&part));
        let files = manifest.files.keys().filter(inside);
        let files = files.filter_map(|path| Some((path.clone(), text_of(&out.join(path))?)));
        Self {
            irs,
            is_whole,
            earlier: Some(Earlier::new(manifest.clone(), files.collect())),
        }
    }

    /// For the emission.
    pub(crate) fn known(self, tables: &Tables) -> Known {
        Known {
            generator: structure::of_generator(),
            structure: tables.structure.clone(),
            earlier: self.earlier,
        }
    }
}

fn irs(out: &Path, tables: &Tables, manifest: &Manifest) -> BTreeMap<String, String> {
    if manifest.generator != structure::of_generator() {
        return BTreeMap::new();
    }
    let unchanged =
        |(name, structure): &(&String, &String)| manifest.structure.get(*name) == Some(*structure);
    let names = tables
        .structure
        .iter()
        .filter(unchanged)
        .map(|(name, _)| name.as_str());
    // The interpreter that `AHV_PYTHON` names may have another CasADi than the one that is locked.
    let casadi = python::casadi_version().map(|it| format!("\"casadi\": {it:?}"));
    let by_casadi = |name: &str, text: &str| {
        name == AUDIT || casadi.as_ref().is_some_and(|it| text.contains(it))
    };
    let text = |name: &str| {
        let text = text_of(&out.join(ir_path(name)))?;
        let derived = manifest.ir.get(name) == Some(&sha256(&text)) && by_casadi(name, &text);
        derived.then(|| (name.to_owned(), text))
    };
    names.chain([AUDIT]).filter_map(text).collect()
}
