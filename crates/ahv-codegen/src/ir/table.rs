//! What the IR says of a table: its units, choices, sets, parameters and rules.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use super::described;

/// The unit system of a table, and what each of its units is in the other system.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// That of the table.
    pub system: UnitSystem,
    /// The other of the two.
    pub other: UnitSystem,
    /// Unit and factor in the other system, by the unit in this one.
    pub factors: BTreeMap<String, (String, f64)>,
}

/// A system of units.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum UnitSystem {
    /// Foot, slug, second, radian.
    #[serde(rename = "ft-slug-s-rad")]
    FootSlug,
    /// Metre, kilogram, second, radian.
    #[serde(rename = "si")]
    Si,
}

impl UnitSystem {
    /// Its name in tables and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FootSlug => "ft-slug-s-rad",
            Self::Si => "si",
        }
    }
}

impl FromStr for UnitSystem {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let named = [Self::FootSlug, Self::Si]
            .into_iter()
            .find(|it| it.name() == name);
        named.ok_or_else(|| "systems of units: ft-slug-s-rad, si".to_owned())
    }
}

/// A choice that a user makes by name, in `[choices]` of a table or when a model is made.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Key in `[choices]`.
    pub name: String,
    /// Type of the choice in the generated code.
    #[serde(rename = "type")]
    pub type_name: String,
    /// What is chosen.
    pub doc: String,
    /// The names to choose from.
    pub options: Vec<ChoiceOption>,
}

/// One way to choose.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChoiceOption {
    /// Its name.
    pub name: String,
    /// What it means.
    pub doc: String,
    /// Values of the parameters that it sets.
    pub values: BTreeMap<String, f64>,
}

/// Entries that replace those of the table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterSet {
    /// Name, such as `section5.3`.
    pub name: String,
    /// The entries.
    pub parameters: Vec<Replacement>,
}

/// A parameter that a set replaces; its value stays in the table.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replacement {
    /// Name of the parameter.
    pub name: String,
    /// Keys in the table.
    pub path: Vec<String>,
    /// Key of its source.
    pub source: String,
    /// How far its value can be trusted.
    pub status: Status,
    /// Relative uncertainty.
    pub uncertainty: f64,
}

/// A parameter or coefficient; its value stays in the table. One whose section is `choices` is set by a choice.
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
    /// What kind of entry it is.
    pub kind: EntryKind,
    /// The models whose tables have it; empty if all have it.
    pub models: Vec<String>,
    /// Key of its source.
    pub source: String,
    /// How far its value can be trusted.
    pub status: Status,
    /// Relative uncertainty.
    pub uncertainty: f64,
}

/// A kind of entry, by the constructors of `ahv_core::Entry`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum EntryKind {
    /// A parameter.
    Parameter,
    /// A coefficient that a table may leave out.
    Coefficient,
    /// A coefficient that a table must list.
    Required,
    /// A parameter that a choice sets.
    Switch,
}

impl EntryKind {
    /// Whether it stands in a section of its own, not among the choices.
    pub fn is_of_section(&self) -> bool {
        *self != Self::Switch
    }
}

impl fmt::Display for EntryKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

/// A curve-fitted quantity: a section of the table whose keys are monomials, as `ahv_core::Fit`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// Its section.
    pub section: String,
    /// Its unit.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// The variables that its monomials may have.
    pub variables: Vec<FitVariable>,
    /// Those whose linear coefficient a table must list.
    pub required: Vec<String>,
    /// Those in which it is of degree one at most, together.
    pub affine: Vec<String>,
    /// The models whose tables have it; empty if all have it.
    pub models: Vec<String>,
}

/// A variable of monomials, as `ahv_core::FitVariable`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitVariable {
    /// Its name.
    pub name: String,
    /// Its unit, angles in rad.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// The entry of the validity box that bounds it; none bounds a derived variable.
    pub interval: Option<String>,
}

/// A polynomial of parameters that must have a sign, as `ahv_core::Rule`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// What kind of rule it is.
    pub name: String,
    /// Its terms: a factor and the names of the parameters.
    pub terms: Vec<(f64, Vec<String>)>,
    /// The sign.
    pub must: Sign,
    /// The rule as a sentence.
    pub reason: String,
}

/// A sign that a number must have, by the names of `ahv_core::Sign`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sign {
    /// Above 0.
    Positive,
    /// 0 or above.
    NotNegative,
    /// Anything but 0.
    NotZero,
}

/// How far a value can be trusted, by the names of `ahv_core::Status`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Printed in the source.
    Published,
    /// Computed from published values.
    Derived,
    /// Of unknown origin.
    Unverified,
    /// Chosen for want of a source.
    Assumed,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

impl Parameter {
    /// What it is and its unit, as a sentence.
    pub(crate) fn described(&self) -> String {
        described(&self.doc, &self.unit)
    }
}
