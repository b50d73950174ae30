//! The manifest: what the generated files were made from, one hash a line.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

use crate::{EmitError, Tree};

/// Provenance of a generated package. No time, path or user stands in it.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Manifest {
    /// Version of the IR's schema.
    pub schema_version: u64,
    /// Version of the emitter.
    pub emitter: String,
    /// Hash of the emitter's sources. Older versions wrote none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub emitter_sources: String,
    /// Hash of what derives: the generator's sources and its locked packages. Older versions wrote none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub generator: String,
    /// Unit system of the package. Older versions wrote none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub units: String,
    /// Hash of the structure of each table: of all that the derivation reads. Older versions wrote none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub structure: BTreeMap<String, String>,
    /// Hash of the values of each table.
    pub tables: BTreeMap<String, String>,
    /// Hash of each IR.
    pub ir: BTreeMap<String, String>,
    /// Hash of the templates.
    pub templates: String,
    /// The language of the models; none for Rust.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub language: Option<String>,
    /// Passes of the emitter that were left out; a tree to keep has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without_passes: Vec<String>,
    /// Hash of each file of the package but the IRs and the manifest, by its path. Older versions wrote none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, String>,
    /// Hash of all that stands before it. A merge of two manifests has none that fits.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub seal: String,
}

impl Manifest {
    /// Reads the text of a manifest, of another version of ahv too.
    ///
    /// # Errors
    /// [`EmitError::Manifest`] when it is not one; that of another program has no hashes of these names.
    pub fn parse(text: &str) -> Result<Self, EmitError> {
        let manifest: Self =
            serde_json::from_str(text).map_err(|error| EmitError::Manifest(error.to_string()))?;
        let hashed = |map: &BTreeMap<String, String>| map.values().all(|it| is_hash(it));
        let all = is_hash(&manifest.templates)
            && [&manifest.tables, &manifest.ir, &manifest.files].map(hashed) == [true; 3];
        if !all || manifest.tables.is_empty() {
            return Err(EmitError::Manifest("a hash is missing".to_owned()));
        }
        Ok(manifest)
    }

    /// The same with the seal that fits.
    #[must_use]
    pub fn sealed(mut self) -> Self {
        self.seal = String::new();
        self.seal = sha256(&self.render());
        self
    }

    /// Whether it stands as one run wrote it.
    #[must_use]
    pub fn is_sealed(&self) -> bool {
        self.clone().sealed().seal == self.seal
    }

    /// The hash of the text that ahv wrote to a path, with line feeds alone at the ends of lines.
    #[must_use]
    pub fn written(&self, path: &str) -> Option<&str> {
        let table = path
            .strip_prefix("ir/")
            .and_then(|it| it.strip_suffix(".json"));
        let hash = match table {
            Some(table) => self.ir.get(table),
            None => self.files.get(path),
        };
        hash.map(String::as_str)
    }

    /// The text of the manifest.
    pub fn render(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// A tree that was emitted before, as far as it is still what its manifest says.
#[derive(Debug)]
pub struct Earlier {
    /// Its manifest.
    pub manifest: Manifest,
    files: Tree,
}

impl Earlier {
    /// Files whose hash is not that of the manifest are left out: they are somebody's, or another emitter's.
    #[must_use]
    pub fn new(manifest: Manifest, mut files: Tree) -> Self {
        files.retain(|path, text| manifest.written(path) == Some(&sha256(text)));
        Self { manifest, files }
    }

    /// The text of a file, as it was emitted.
    #[must_use]
    pub fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path).map(String::as_str)
    }

    /// The files whose paths are `wanted`, if all that were written are there.
    pub(crate) fn all(&self, wanted: impl Fn(&str) -> bool) -> Option<Tree> {
        let paths = self.manifest.files.keys().filter(|path| wanted(path));
        paths
            .map(|path| Some((path.clone(), self.files.get(path)?.clone())))
            .collect()
    }

    /// Whether the emitter of `now` makes the same of the same IR.
    pub(crate) fn has_emitter_of(&self, now: &Manifest) -> bool {
        let emitter = |it: &Manifest| {
            let sources =
                [&it.emitter, &it.emitter_sources, &it.templates, &it.units].map(Clone::clone);
            let passes = it.without_passes.clone();
            (it.schema_version, it.language.clone(), sources, passes)
        };
        emitter(&self.manifest) == emitter(now)
    }

    /// Whether a table had the IR that it has in `now`, and a file of the same name.
    pub(crate) fn has_ir_of(&self, now: &Manifest, table: &str) -> bool {
        let has = |of: fn(&Manifest) -> &BTreeMap<String, String>| {
            let known = of(&self.manifest).get(table);
            known.is_some() && known == of(now).get(table)
        };
        has(|it| &it.structure) && has(|it| &it.ir)
    }

    /// Whether it had the same values, too.
    pub(crate) fn has_table_of(&self, now: &Manifest, table: &str) -> bool {
        self.has_ir_of(now, table) && self.manifest.tables.get(table) == now.tables.get(table)
    }
}

fn is_hash(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// SHA-256 of a text, in hexadecimal.
pub fn sha256(text: &str) -> String {
    use std::fmt::Write;
    Sha256::digest(text.as_bytes())
        .iter()
        .fold(String::with_capacity(64), |mut hex, byte| {
            // Writing to a String cannot fail.
            let _ = write!(hex, "{byte:02x}");
            hex
        })
}
