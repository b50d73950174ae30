//! Emits Rust from the intermediate representation of vehicle models.
//!
//! [`emit()`] is a function from tables (their values) and IR (their structure) to a [`Tree`] of files. Writing that
//! tree and comparing it with the one on disk are the business of the caller.
//!
//! ```
//! use std::fs::read_to_string;
//! use ahv_codegen::{AUDIT, Options, Table, emit};
//!
//! let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/example");
//! let table = Table::parse("com.toml", &read_to_string(format!("{folder}/com.toml"))?)?;
//! let ir = |name: &str| Ok::<_, std::io::Error>((
//!     name.to_owned(),
//!     read_to_string(format!("{folder}/{name}.json"))?,
//! ));
//! let tree = emit(&[table], &[ir("com")?, ir(AUDIT)?].into(), &Options::default())?;
//! assert!(tree["src/com/drift.rs"].contains("pub fn drift"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod c;
mod call;
mod docs;
mod emit;
mod graph;
pub mod ir;
mod manifest;
mod numbered;
mod options;
mod parallel;
mod rust;
mod schedule;
mod shape;
mod subject;
mod table;
mod table_schema;
mod template;
#[cfg(test)]
mod testing;
mod values;
mod wording;

use std::collections::BTreeMap;

pub use ahv_table::{Part, Unreadable};
pub use c::identifier as c_identifier;
pub use docs::AUDIT;
pub use emit::{Known, emit, emit_again};
pub use graph::passes::{Pass, Passes, UnknownPass};
pub use manifest::{Earlier, Manifest, sha256};
pub use numbered::{Numbered, numbered};
pub use options::{Core, Options, Target};
pub use table::Table;

/// Files by their path relative to the folder of the generated package, with `/` between its parts.
pub type Tree = BTreeMap<String, String>;

/// Why nothing was emitted.
#[derive(Debug, thiserror::Error)]
pub enum EmitError {
    /// The IR was made for another version of this crate.
    #[error(
        "the IR of table `{table}` has schema version {found}, but this version of ahv reads {}; derive it again",
        ir::SCHEMA_VERSION
    )]
    SchemaVersion {
        /// Table of the IR.
        table: String,
        /// Version found.
        found: u64,
    },
    /// The text is not an IR.
    #[error("the IR of table `{table}` cannot be read: {message}")]
    Ir {
        /// Table of the IR.
        table: String,
        /// What is wrong.
        message: String,
    },
    /// Table and IR do not belong together, or two tables make the same model.
    #[error("{0}")]
    Mismatch(String),
    /// The manifest cannot be read.
    #[error("generated/manifest.json cannot be read: {0}")]
    Manifest(String),
    /// A template cannot be filled in: a fault of the emitter.
    #[error("internal error: a template cannot be filled in: {0}")]
    Template(String),
    /// Emitted text is not Rust: a fault of the emitter.
    #[error("internal error: {path} is not valid Rust: {message}")]
    NotRust {
        /// File at fault.
        path: String,
        /// What the parser says.
        message: String,
    },
}
