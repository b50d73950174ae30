//! The intermediate representation: what the derivation hands to the emitter, as JSON.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt;

use crate::EmitError;

mod table;
pub use table::{
    Choice, ChoiceOption, EntryKind, Fit, FitVariable, Parameter, ParameterSet, Replacement, Rule,
    Sign, Status, UnitSystem, Units,
};

/// The schema that this crate reads.
pub const SCHEMA_VERSION: u64 = 5;

/// The models of one table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Always [`SCHEMA_VERSION`].
    pub schema_version: u64,
    /// What made the document.
    pub provenance: Provenance,
    /// Units of the table, and the same in the other system.
    pub units: Units,
    /// What a user chooses by name.
    pub choices: Vec<Choice>,
    /// What `[parts]` and `[joined]` say: section, name, key, and the text that stands there.
    pub joins: Vec<[String; 4]>,
    /// Sets of parameters; the first is the table's own and replaces nothing.
    pub sets: Vec<ParameterSet>,
    /// Parameters and coefficients, in the order of the table.
    pub parameters: Vec<Parameter>,
    /// Entries of the validity box.
    pub validity: Vec<Variable>,
    /// What the monomials of its polynomials may be.
    pub fits: Vec<Fit>,
    /// What the numbers of the table must obey.
    pub rules: Vec<Rule>,
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

/// What the components of a vector, or the rows and columns of a matrix, are.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// Further arguments of a function.
    Argument,
    /// Where the equations of motion go over to another formula.
    Boundary,
    /// Inputs.
    Input,
    /// Quantities that people look at.
    Output,
    /// Flexible modes.
    Mode,
    /// Wiener processes.
    Noise,
    /// Parameters of the table; [`Document::parameters`] holds them.
    Parameter,
    /// States.
    State,
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
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
    /// Of an entry of the validity box: the models whose tables have it; empty if all have it.
    #[serde(default)]
    pub models: Vec<String>,
}

/// A model: named vectors, quantities in evaluation order, functions.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Module name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Equations of the paper; empty where the model is from none.
    pub equations: String,
    /// States, inputs, and where the model has them Wiener processes, modes and further arguments.
    pub bases: BTreeMap<Basis, Vec<Variable>>,
    /// Named quantities, each written in earlier names.
    pub quantities: Vec<Quantity>,
    /// Functions to emit.
    pub functions: Vec<Function>,
    /// What kind of noise drives the model, where one does.
    #[serde(default)]
    pub noise: Option<NoiseStructure>,
    /// What who uses the model should know first.
    pub note: Option<String>,
    /// What a steady state is.
    pub trim: Trim,
    /// Modes of motion.
    pub modes: Vec<ModeOfMotion>,
    /// Inputs and outputs for zeros and gains.
    pub defaults: Defaults,
    /// Deviations of states and inputs that cost 1 in a regulator.
    pub deviations: BTreeMap<String, f64>,
}

/// What a steady state is, as `ahv_core::TrimProblem`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trim {
    /// States and outputs that are given.
    pub given: Vec<Given>,
    /// States and inputs that are sought.
    pub sought: Vec<Sought>,
    /// Rows of the drift and outputs that vanish.
    pub equations: Vec<Equation>,
    /// States that move all the same.
    pub moving: Vec<String>,
    /// States, inputs and outputs of a steady state that people look at.
    pub shown: Vec<String>,
}

/// A state or an output that is given.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// The state or output.
    pub name: String,
    /// Its value where none is asked for.
    pub default: f64,
    /// It must be above this.
    pub above: Option<f64>,
    /// It must be below this.
    pub below: Option<f64>,
}

/// A state or input that is sought.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sought {
    /// The state or input.
    pub name: String,
    /// Where the search starts.
    pub start: f64,
    /// A change that counts as 1.
    pub scale: f64,
}

/// A row of the drift, or an output, that vanishes.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Equation {
    /// The row.
    pub name: String,
    /// How much it weighs where not all rows can vanish.
    pub weight: f64,
    /// Another row and a given state by which it is measured.
    pub like: Option<(String, String)>,
}

/// A mode of motion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModeOfMotion {
    /// Its name.
    pub name: String,
    /// The states that take part.
    pub states: Vec<String>,
    /// Name of the slowest of an odd number of real poles.
    pub slowest: Option<String>,
}

/// Inputs and outputs for zeros and gains, where none are asked for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Defaults {
    /// Inputs.
    pub inputs: Vec<String>,
    /// Outputs.
    pub outputs: Vec<String>,
}

/// The columns of the diffusion, as the derivation found them by symbolic computation.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseStructure {
    /// One for each Wiener process.
    pub columns: Vec<NoiseColumn>,
    /// Pairs of columns with L^j b^k = L^k b^j, a column with itself left out.
    pub commuting: Vec<(String, String)>,
}

/// A column of the diffusion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseColumn {
    /// The Wiener process.
    pub name: String,
    /// What its entries depend on.
    pub class: NoiseClass,
}

/// What the entries of a column of the diffusion depend on, by the names of `ahv_core::NoiseClass`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum NoiseClass {
    /// No entry depends on the state.
    Constant,
    /// An entry depends on the state of its own row alone.
    Diagonal,
    /// Entries depend on states of other rows.
    General,
}

impl fmt::Display for NoiseClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
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
    /// Whether the structurally non-zero entries are offered by themselves as well.
    #[serde(default)]
    pub compressed: bool,
}

/// A scalar (no basis), vector or matrix; entries that are not listed are structural zeros.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name, empty where the function has one output.
    pub name: String,
    /// Bases of its rows and columns.
    pub basis: Vec<Basis>,
    /// Unit of a scalar.
    pub unit: Option<String>,
    /// Structurally non-zero entries.
    pub entries: Vec<Entry>,
    /// Whether its last two bases are one and entries stand for their mirror images too.
    #[serde(default)]
    pub symmetric: bool,
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
    /// A quantity, or a leaf with its prefix (`x.`, `u.`, `w.`, `p.`, `t.`).
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

impl Model {
    /// Two components of one vector must not share a name.
    pub(crate) fn check_names(&self) -> Result<(), EmitError> {
        for (basis, variables) in &self.bases {
            let names: BTreeSet<_> = variables.iter().map(|v| &v.name).collect();
            if names.len() != variables.len() {
                return Err(EmitError::Mismatch(format!(
                    "the basis `{basis}` of model `{}` holds a name twice",
                    self.name
                )));
            }
        }
        Ok(())
    }

    /// Positions of the quantities that the derivation of a function goes through.
    pub(crate) fn derivation(&self, function: &Function) -> HashSet<usize> {
        let quantities = self.quantities.iter().zip(0..);
        let places: HashMap<&str, usize> = quantities.map(|(q, at)| (&*q.name, at)).collect();
        let entries = function.outputs.iter().flat_map(|it| &it.entries);
        let mut open: Vec<&Expr> = entries.map(|entry| &entry.expr).collect();
        let mut found = HashSet::new();
        while let Some(expr) = open.pop() {
            match expr {
                Expr::Number(_) => {}
                Expr::Name(name) => {
                    let place = places.get(&**name).copied();
                    let new = place.filter(|&place| found.insert(place));
                    open.extend(new.map(|place| &self.quantities[place].expr));
                }
                // The first is the operation.
                Expr::Apply(items) => open.extend(items.iter().skip(1)),
            }
        }
        found
    }

    /// Name, what it is, and from which equations.
    pub(crate) fn heading(&self) -> String {
        let name = self.name.to_uppercase();
        match self.equations.as_str() {
            "" => format!("{name}: {}", self.title),
            equations => format!("{name}: {}, eq. {equations}", self.title),
        }
    }

    /// Multiplies the numbers of trim and deviations with the factor of their state, input or output.
    pub(crate) fn scale_description(&mut self, factor: impl Fn(&str) -> f64) {
        for given in &mut self.trim.given {
            let factor = factor(&given.name);
            let bounds = [&mut given.above, &mut given.below];
            for value in bounds.into_iter().flatten().chain([&mut given.default]) {
                *value *= factor;
            }
        }
        for sought in &mut self.trim.sought {
            let factor = factor(&sought.name);
            sought.start *= factor;
            sought.scale *= factor;
        }
        for (name, deviation) in &mut self.deviations {
            *deviation *= factor(name);
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
