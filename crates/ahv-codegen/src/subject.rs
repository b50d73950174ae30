//! A table beside its IR and its numbers: what files are made from.

use crate::Table;
use crate::ir::{Choice, ChoiceOption, Document, Parameter, ParameterSet};
use crate::values::{CHOICES, Values};

/// A table beside its IR, and the numbers that the IR names in the units of the package.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    /// Sources and choices.
    pub(crate) table: &'a Table,
    /// The structure.
    pub(crate) document: &'a Document,
    /// The numbers.
    pub(crate) values: &'a Values,
}

impl<'a> Subject<'a> {
    /// The nominal value of a parameter.
    pub(crate) fn value(&self, parameter: &Parameter) -> f64 {
        let parameters = self.document.parameters.iter().zip(&self.values.nominal);
        let found = parameters.filter(|(known, _)| known.name == parameter.name);
        found.map(|(_, value)| *value).next().unwrap_or(f64::NAN)
    }

    /// The value that a set gives to a parameter.
    pub(crate) fn replacement(&self, set: &ParameterSet, parameter: &str) -> f64 {
        let sets = self.document.sets.iter().zip(&self.values.sets);
        let mut values = sets
            .filter(|(known, _)| known.name == set.name)
            .flat_map(|(_, values)| values);
        let found = values.find(|(name, _)| name == parameter);
        found.map_or(f64::NAN, |(_, value)| *value)
    }

    /// The option that the table chooses.
    pub(crate) fn chosen(&self, choice: &'a Choice) -> Option<&'a ChoiceOption> {
        let name = self.table.text(&[CHOICES, &choice.name])?;
        choice.options.iter().find(|option| option.name == name)
    }

    /// An entry of the validity box, angles in rad.
    pub(crate) fn bounds(&self, name: &str) -> Option<(f64, f64)> {
        let entries = self.document.validity.iter().zip(&self.values.bounds);
        let found = entries.filter(|(variable, _)| variable.name == name);
        found.map(|(_, bounds)| *bounds).next()
    }
}
