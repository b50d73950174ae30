//! What its family says of a table: what it may hold, without a derivation of its models.

use std::path::Path;

use ahv_codegen::Part;
use ahv_codegen::ir::Document;
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::derive::{self, Diagnostics};
use crate::failure::Failure;
use crate::interrupt;
use crate::python;
use crate::surroundings::Surroundings;
use crate::tables::DiagnosticPart;

/// What the family of a table says of it.
#[derive(Debug)]
pub enum Described {
    /// The table has no fault: the models that it lists, and its IR without models.
    Table {
        /// The models.
        models: Vec<String>,
        /// The IR.
        document: Box<Document>,
    },
    /// Its faults.
    Faults(Vec<FamilyFault>),
}

/// Something that a table may not say, at a path of keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FamilyFault {
    /// The rule.
    pub rule: String,
    /// The keys.
    pub path: Vec<String>,
    /// Whether key or value is at fault.
    pub part: Part,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
}

#[derive(Deserialize)]
struct Answer {
    models: Vec<String>,
    table: Box<RawValue>,
}

/// Asks the family of the table at `path` about it: one that comes along, or a Python file beside the table.
///
/// # Errors
/// No usable Python; a fault in the file of the family; a signal.
pub fn describe(path: &Path, surroundings: &Surroundings) -> Result<Described, Failure> {
    let python = python::for_generation(surroundings)?;
    let mut command = python.command();
    command.arg("describe").arg(path);
    let output = interrupt::output(&mut command, |error| {
        Failure::new(format!("cannot run Python: {error}"))
    })?;
    let unreadable = |error: &dyn std::fmt::Display| {
        Failure::new(format!("the answer of the family cannot be read: {error}"))
    };
    if output.status.success() {
        let answer: Answer =
            serde_json::from_slice(&output.stdout).map_err(|error| unreadable(&error))?;
        let document = Document::parse("described", answer.table.get());
        return Ok(Described::Table {
            models: answer.models,
            document: Box::new(document.map_err(|error| unreadable(&error))?),
        });
    }
    let Ok(Diagnostics { diagnostics }) = serde_json::from_slice(&output.stdout) else {
        return Err(derive::with_stderr(
            "the family of the table cannot be asked".to_owned(),
            &output,
        ));
    };
    let mut faults = Vec::new();
    for found in diagnostics {
        if let Some(line) = found.line {
            let (file, message) = (found.file, found.message);
            return Err(Failure::new(format!("{file}:{line}: {message}")));
        }
        faults.push(FamilyFault {
            rule: found.rule,
            path: found.path,
            part: match found.part {
                DiagnosticPart::Key => Part::Key,
                DiagnosticPart::Value => Part::Value,
            },
            message: found.message,
            help: found.help,
        });
    }
    Ok(Described::Faults(faults))
}
