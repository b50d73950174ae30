//! The intermediate representation: what the derivation hands to the emitter, as JSON.

use serde::Deserialize;
use std::collections::BTreeMap;

use crate::EmitError;

/// The schema that this crate reads.
pub const SCHEMA_VERSION: u64 = 1;

/// The models of one table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Always [`SCHEMA_VERSION`].
    pub schema_version: u64,
    /// What made the document.
    pub provenance: Provenance,
    /// Parameters and coefficients, in the order of the table.
    pub parameters: Vec<Parameter>,
    /// Entries of the validity box.
    pub validity: Vec<Variable>,
    /// The models.
    pub models: Vec<Model>,
}

/// What made a document.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Name of the table.
    pub table: String,
    /// Version of the derivation.
    pub generator: String,
    /// Version of CasADi.
    pub casadi: String,
}

/// A parameter or coefficient; its value stays in the table.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Name in the generated code.
    pub name: String,
    /// Section and key in the table.
    pub path: (String, String),
    /// Symbol in LaTeX.
    pub symbol: String,
    /// Unit.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// Key of its source.
    pub source: String,
    /// `published`, `derived`, `unverified` or `assumed`.
    pub status: String,
    /// Relative uncertainty.
    pub uncertainty: f64,
}

/// A named scalar of a basis or of the validity box.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variable {
    /// Name in the generated code.
    pub name: String,
    /// Symbol in LaTeX.
    #[serde(default)]
    pub symbol: String,
    /// Unit.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// The entry of the validity box that bounds it.
    #[serde(default)]
    pub validity: Option<String>,
}

/// A model: named vectors, quantities in evaluation order, functions.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Module name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Equations of the paper.
    pub equations: String,
    /// `state`, `input`, and where the model has them `noise` and `mode`.
    pub bases: BTreeMap<String, Vec<Variable>>,
    /// Named quantities, each written in earlier names.
    pub quantities: Vec<Quantity>,
    /// Functions to emit.
    pub functions: Vec<Function>,
}

/// A quantity with a name in the field.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Name in the generated code.
    pub name: String,
    /// Symbol in LaTeX.
    pub symbol: String,
    /// Unit.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// Equation of the paper.
    pub equation: String,
    /// Heading under which it is computed.
    pub section: String,
    /// Its definition.
    pub expr: Expr,
}

/// A function of the generated code.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Function {
    /// Name.
    pub name: String,
    /// File that it stands in.
    pub group: String,
    /// What it computes.
    pub doc: String,
    /// Equation of the paper.
    pub equation: String,
    /// Results; several are returned as a tuple.
    pub outputs: Vec<Output>,
}

/// A scalar (no basis), vector or matrix; entries that are not listed are structural zeros.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name, empty where the function has one output.
    pub name: String,
    /// Bases of its rows and columns.
    pub basis: Vec<String>,
    /// Unit of a scalar.
    pub unit: Option<String>,
    /// Structurally non-zero entries.
    pub entries: Vec<Entry>,
}

/// An entry of an output.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Names of its row and column.
    pub at: Vec<String>,
    /// Its value.
    pub expr: Expr,
}

/// A tree: a name, a number, or an operator with its arguments.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub enum Expr {
    /// A quantity, or a leaf with its prefix (`x.`, `u.`, `w.`, `p.`).
    Name(String),
    /// A constant.
    Number(f64),
    /// `[op, argument, …]`.
    Apply(Vec<Expr>),
}

impl Document {
    /// Reads a document.
    ///
    /// # Errors
    /// [`EmitError::SchemaVersion`] for another schema, [`EmitError::Ir`] for text that does not hold the schema.
    pub fn parse(table: &str, text: &str) -> Result<Self, EmitError> {
        #[derive(Deserialize)]
        struct Version {
            schema_version: u64,
        }
        let unreadable = |error: serde_json::Error| EmitError::Ir {
            table: table.to_owned(),
            message: error.to_string(),
        };
        let version: Version = serde_json::from_str(text).map_err(unreadable)?;
        if version.schema_version != SCHEMA_VERSION {
            return Err(EmitError::SchemaVersion {
                table: table.to_owned(),
                found: version.schema_version,
            });
        }
        serde_json::from_str(text).map_err(unreadable)
    }
}

impl Parameter {
    /// What it is and its unit, as a sentence.
    pub(crate) fn described(&self) -> String {
        described(&self.doc, &self.unit)
    }

    /// The variant of `ahv_core::Status` for the status.
    pub(crate) fn status_variant(&self) -> &'static str {
        match self.status.as_str() {
            "published" => "Published",
            "derived" => "Derived",
            "assumed" => "Assumed",
            _ => "Unverified",
        }
    }
}

impl Variable {
    /// What it is and its unit, as a sentence.
    pub(crate) fn described(&self) -> String {
        described(&self.doc, &self.unit)
    }
}

/// What a quantity is and its unit, as a sentence.
pub(crate) fn described(doc: &str, unit: &str) -> String {
    let unit = if unit == "1" { "dimensionless" } else { unit };
    format!("{}, {unit}.", capitalised(doc))
}

/// The text with its first letter in upper case.
pub(crate) fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(characters).collect()
    })
}
