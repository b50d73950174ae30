//! Reads a table of coefficients and checks it, for a package of models that was generated from such a table.
//!
//! [`Text`] is a table as TOML, with the places of its entries; `ahv generate` reads its tables with it, too. [`check`]
//! compares a whole table, all sections and sets, with what the models' own table says of itself
//! ([`ahv_core::Table`]). It names no section, parameter or model: those are data. Its reference is the reader of the
//! generator (`generator/ahv_generator/table.py`): both report the same rules at the same places, which a test of
//! random changes compares (`tests/tests/rules.rs`). Start with [`check`].
//!
//! ```
//! use ahv_table::{Family, Text, check};
//!
//! let families = [Family::of::<ahv_models::dcom::Model<f64>>()];
//! let path = concat!(env!("CARGO_MANIFEST_DIR"), "/example/dcom.toml");
//! let own = std::fs::read_to_string(path)?;
//!
//! // A table that the models were made of has no fault; its first set is its own.
//! let checked = check(&Text::parse(own.clone())?, &families).map_err(|faults| faults[0].to_string())?;
//! assert_eq!(checked.sets[0].name, "section5.1");
//!
//! // A mass below 0 breaks a rule of the models. The fault has the place of the number.
//! let wrong = Text::parse(own.replacen("m = { value = ", "m = { value = -", 1))?;
//! let faults = check(&wrong, &families).expect_err("a mass is positive");
//! assert_eq!(faults[0].path, ["vehicle", "m", "value"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod edit;
mod entries;
mod fault;
mod header;
mod joins;
mod monomial;
mod names;
mod reader;
mod sets;
mod text;
mod unit;

use ahv_core::{Bounds, ChoiceOption, GeneratedModel, Table, Vector};

pub use edit::Edit;
pub use fault::{Fault, visible};
pub use monomial::{Powers, powers};
pub use text::{Part, Text, Unreadable};
pub use unit::{Unit, degrees, in_radians, in_si, si_name};

/// The models of one table, which all models of a package belong to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Family {
    /// The table.
    pub table: &'static Table,
    /// Names of the parameters that its entries are.
    pub names: &'static [&'static str],
    /// Their units.
    pub units: &'static [&'static str],
    /// The same in metre, kilogram, second and radian.
    pub si_units: &'static [&'static str],
}

impl Family {
    /// Of no models: a table of theirs has no section of numbers.
    pub const NONE: Self = Self {
        table: &Table {
            name: "",
            models: &[],
            unit_system: header::FOOT_SLUG,
            entries: &[],
            choices: &[],
            joins: &[],
            validity: &[],
            fits: &[],
            rules: &[],
        },
        names: &[],
        units: &[],
        si_units: &[],
    };

    /// The family of the model `M`.
    #[must_use]
    pub fn of<M: GeneratedModel>() -> Self {
        Self {
            table: M::TABLE,
            names: <M::ParametersOf<f64> as Vector<f64>>::NAMES,
            units: <M::ParametersOf<f64> as Vector<f64>>::UNITS,
            si_units: <M::ParametersOf<f64> as Vector<f64>>::SI_UNITS,
        }
    }
}

/// A table without a fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The models that it lists.
    pub models: Vec<&'static str>,
    /// Its unit system: `ft-slug-s-rad` or `si`.
    pub unit_system: &'static str,
    /// Its sets of parameters. The first is its own; the others hold what they replace.
    pub sets: Vec<Set>,
    /// What it chooses.
    pub choices: Vec<&'static ChoiceOption>,
    /// Its validity box, in the order of [`Table::validity`], with angles in rad; `None` for an interval that only other
    /// models have.
    pub validity: Vec<Option<Bounds>>,
}

/// A set of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// Its name.
    pub name: String,
    /// Its entries, in the order of [`Table::entries`].
    pub entries: Vec<Option<Quantity>>,
}

/// The number of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Its value, in the unit system of the table.
    pub value: f64,
    /// Its relative uncertainty.
    pub uncertainty: f64,
}

/// Checks a table for one of the families of a package, which the models that it lists decide.
///
/// A coefficient that the table does not list counts as 0. A table with entries that the models of its family do not
/// have is a fault, `needs-generation`.
///
/// # Errors
///
/// All faults of the table, in the order of their places.
pub fn check(text: &Text, families: &[Family]) -> Result<Checked, Vec<Fault>> {
    header::check(text, families).map_err(|mut faults| {
        faults.sort_by_key(|fault| text.offset(fault));
        faults
    })
}
