//! The manifest: what the generated files were made from, one hash a line.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

use crate::EmitError;

/// Provenance of a generated package. No time, path or user stands in it.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
pub struct Manifest {
    /// Version of the IR's schema.
    pub schema_version: u64,
    /// Version of the emitter.
    pub emitter: String,
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
