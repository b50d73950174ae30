//! Values of the generated code that are numbered for want of a name.

use std::collections::BTreeMap;

use crate::graph::passes::Passes;
use crate::ir::Document;
use crate::schedule::program::Program;
use crate::{EmitError, Table};

/// A value whose name only says whose part it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbered {
    /// The model.
    pub model: String,
    /// The function that computes it.
    pub function: String,
    /// The name.
    pub name: String,
    /// Why no name describes it, as a sentence.
    pub reason: String,
}

/// The values of the package whose names only say whose part they are.
///
/// # Errors
/// As [`emit`].
pub fn numbered(
    tables: &[Table],
    irs: &BTreeMap<String, String>,
) -> Result<Vec<Numbered>, EmitError> {
    let mut found = Vec::new();
    for table in tables {
        let text = irs.get(&table.name).map_or("", String::as_str);
        let document = Document::parse(&table.name, text)?;
        for model in &document.models {
            let program = Program::new(model, &model.name, &document, &Passes::default())?;
            let names = program.numbered().into_iter();
            found.extend(names.map(|(function, name, reason)| Numbered {
                model: model.name.clone(),
                function,
                name,
                reason,
            }));
        }
    }
    Ok(found)
}
