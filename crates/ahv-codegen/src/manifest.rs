//! The manifest: what the generated files were made from, one hash a line.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

use crate::EmitError;

/// Provenance of a generated package. No time, path or user stands in it.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
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
    /// Passes of the emitter that were left out; a tree to keep has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without_passes: Vec<String>,
}

impl Manifest {
    /// Reads the text of a manifest.
    ///
    /// # Errors
    /// [`EmitError::Manifest`] when it is not one.
    pub fn parse(text: &str) -> Result<Self, EmitError> {
        serde_json::from_str(text).map_err(|error| EmitError::Manifest(error.to_string()))
    }

    /// The text of the manifest.
    pub fn render(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
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
