//! The numbers of a table, as its IR names them, in the unit system that is asked for.

use std::collections::{BTreeMap, HashMap};

use ahv_table::{degrees, in_radians};

use crate::ir::{Document, Parameter, UnitSystem, Units, Variable};
use crate::{EmitError, Table};

/// Section of the parameters that a choice sets.
pub(crate) const CHOICES: &str = "choices";

/// The numbers of a table.
pub(crate) struct Values {
    /// One for each parameter, in their order.
    pub(crate) nominal: Vec<f64>,
    /// What each set replaces, by the parameter's name.
    pub(crate) sets: Vec<Vec<(String, f64)>>,
    /// Ends of the validity box, angles in rad.
    pub(crate) bounds: Vec<(f64, f64)>,
    /// Of each set the numbers that the table has in degrees, by the parameter's name: how they are computed from those.
    pub(crate) written: Vec<HashMap<String, String>>,
}

/// The name of a degree in rad where a number is computed from it.
pub(crate) const DEGREE: &str = "DEGREE";

impl Values {
    /// Reads the numbers that a document names, and turns document and numbers into the unit system `system`.
    pub(crate) fn read(
        table: &Table,
        document: &mut Document,
        system: Option<UnitSystem>,
    ) -> Result<Self, EmitError> {
        let mut found = Self {
            nominal: Vec::new(),
            sets: Vec::new(),
            bounds: Vec::new(),
            written: vec![HashMap::new(); document.sets.len()],
        };
        for parameter in &document.parameters {
            found.nominal.push(value(table, document, parameter)?);
            let (section, key) = &parameter.path;
            found.note(0, &parameter.name, table, &[section, key]);
        }
        for (index, set) in document.sets.iter().enumerate() {
            let mut replaced = Vec::new();
            for replacement in &set.parameters {
                let path: Vec<&str> = replacement.path.iter().map(String::as_str).collect();
                replaced.push((replacement.name.clone(), entry(table, &path)?));
                found.note(index, &replacement.name, table, &path);
            }
            found.sets.push(replaced);
        }
        for variable in &document.validity {
            found.bounds.push(bounds(table, variable)?);
        }
        if system.is_some_and(|system| system != document.units.system) {
            found.convert(document)?;
        }
        found.check(table, document)?;
        Ok(found)
    }

    /// A finite number of a table may be none in other units.
    fn check(&self, table: &Table, document: &Document) -> Result<(), EmitError> {
        let parameters = document.parameters.iter().zip(&self.nominal);
        let own = parameters.map(|(it, value)| (format!("{}.{}", it.path.0, it.path.1), *value));
        let sets = document
            .sets
            .iter()
            .zip(&self.sets)
            .flat_map(|(set, values)| {
                let values = values.iter();
                values.map(|(name, value)| (format!("{name} of set {}", set.name), *value))
            });
        let ends = document.validity.iter().zip(&self.bounds);
        let ends = ends.flat_map(|(it, (min, max))| {
            [min, max].map(|end| (format!("validity.{}", it.name), *end))
        });
        match own
            .chain(sets)
            .chain(ends)
            .find(|(_, value)| !value.is_finite())
        {
            Some((place, _)) => Err(EmitError::Mismatch(format!(
                "{}: `{place}` is beyond the numbers of f64 in the units of the package [not-finite]",
                table.file_name
            ))),
            None => Ok(()),
        }
    }

    /// Keeps how the number of an entry in degrees is computed.
    fn note(&mut self, set: usize, name: &str, table: &Table, path: &[&str]) {
        let degrees = degrees_of(table, path);
        let printed = table.number(&[path, &["value"]].concat());
        if let (Some(printed), Some(written)) = (printed, self.written.get_mut(set))
            && degrees != 0
        {
            let step = if degrees > 0 { " * " } else { " / " };
            let steps = format!("{step}{DEGREE}").repeat(degrees.unsigned_abs() as usize);
            written.insert(name.to_owned(), format!("{printed:?}{steps}"));
        }
    }

    /// A number of a set as Rust.
    pub(crate) fn text(&self, set: usize, name: &str, value: f64) -> String {
        let written = self.written.get(set).and_then(|written| written.get(name));
        written.cloned().unwrap_or_else(|| format!("{value:?}"))
    }

    fn convert(&mut self, document: &mut Document) -> Result<(), EmitError> {
        let units = Units {
            system: document.units.other,
            other: document.units.system,
            factors: BTreeMap::new(),
        };
        let from = std::mem::replace(&mut document.units, units);
        let mut scales = HashMap::new();
        for (parameter, value) in document.parameters.iter_mut().zip(&mut self.nominal) {
            let factor = from.convert(&mut parameter.unit)?;
            *value *= factor;
            scales.insert(parameter.name.clone(), factor);
        }
        for (name, written) in self.written.iter_mut().flatten() {
            let factor = scales.get(name).copied().unwrap_or(1.0);
            if factor != 1.0 {
                *written += &format!(" * {factor:?}");
            }
        }
        for (name, value) in self.sets.iter_mut().flatten() {
            *value *= scales.get(name).copied().unwrap_or(1.0);
        }
        for (variable, (min, max)) in document.validity.iter_mut().zip(&mut self.bounds) {
            let factor = from.convert(&mut variable.unit)?;
            (*min, *max) = (*min * factor, *max * factor);
        }
        for fit in &mut document.fits {
            from.convert(&mut fit.unit)?;
            for variable in &mut fit.variables {
                from.convert(&mut variable.unit)?;
            }
        }
        for model in &mut document.models {
            for variable in model.bases.values_mut().flatten() {
                let factor = from.convert(&mut variable.unit)?;
                scales.insert(variable.name.clone(), factor);
            }
            model.scale_description(|name| scales.get(name).copied().unwrap_or(1.0));
            for quantity in &mut model.quantities {
                from.convert(&mut quantity.unit)?;
            }
            let outputs = model.functions.iter_mut().flat_map(|f| &mut f.outputs);
            for unit in outputs.filter_map(|output| output.unit.as_mut()) {
                from.convert(unit)?;
            }
        }
        let back = from.factors.iter();
        document.units.factors = back
            .map(|(unit, (other, factor))| (other.clone(), (unit.clone(), 1.0 / factor)))
            .collect();
        Ok(())
    }
}

impl Units {
    /// Replaces a unit by that of the other system; the factor for its values.
    fn convert(&self, unit: &mut String) -> Result<f64, EmitError> {
        let (other, factor) = self.other_unit(unit)?;
        let (other, factor) = (other.to_owned(), factor);
        *unit = other;
        Ok(factor)
    }

    /// A unit in the other system, and the factor for its values.
    fn other_unit(&self, unit: &str) -> Result<(&str, f64), EmitError> {
        let found = self.factors.get(unit).ok_or_else(|| {
            EmitError::Mismatch(format!(
                "the IR does not say what the unit `{unit}` is in the system `{}`; derive it again",
                self.other.name()
            ))
        })?;
        Ok((&found.0, found.1))
    }

    /// A unit in the International System, and the factor for its values.
    pub(crate) fn si<'a>(&'a self, unit: &'a str) -> Result<(&'a str, f64), EmitError> {
        if self.system == UnitSystem::Si {
            Ok((unit, 1.0))
        } else {
            self.other_unit(unit)
        }
    }

    /// The base units in words.
    pub(crate) fn in_words(&self) -> &'static str {
        if self.system == UnitSystem::Si {
            "metre, kilogram, second and radian"
        } else {
            "foot, slug, second and radian"
        }
    }
}

/// The number of an entry, with angles in rad.
fn entry(table: &Table, path: &[&str]) -> Result<f64, EmitError> {
    let value = number(table, &[path, &["value"]].concat())?;
    Ok(in_radians(value, degrees_of(table, path)))
}

/// The degrees in the unit of an entry; other units than that of the model are refused by the derivation.
fn degrees_of(table: &Table, path: &[&str]) -> i32 {
    let unit = table.text(&[path, &["unit"]].concat());
    unit.and_then(degrees).unwrap_or(0)
}

fn number(table: &Table, path: &[&str]) -> Result<f64, EmitError> {
    table.number(path).ok_or_else(|| {
        EmitError::Mismatch(format!(
            "{} has no number at `{}`, which its IR names; derive it again",
            table.file_name,
            path.join(".")
        ))
    })
}

/// The value of a parameter, from its entry or from the choice that sets it.
fn value(table: &Table, document: &Document, parameter: &Parameter) -> Result<f64, EmitError> {
    let (section, key) = (parameter.path.0.as_str(), parameter.path.1.as_str());
    if section != CHOICES {
        return entry(table, &[section, key]);
    }
    let chosen = table.text(&[section, key]).unwrap_or_default();
    let choice = document.choices.iter().find(|choice| choice.name == key);
    let option = choice.and_then(|choice| choice.options.iter().find(|o| o.name == chosen));
    let value = option.and_then(|option| option.values.get(&parameter.name));
    value.copied().ok_or_else(|| {
        EmitError::Mismatch(format!(
            "{} chooses `{chosen}` at `{section}.{key}`, which its IR does not know; derive it again",
            table.file_name
        ))
    })
}

fn bounds(table: &Table, variable: &Variable) -> Result<(f64, f64), EmitError> {
    let path = ["validity", variable.name.as_str()];
    let degrees = degrees_of(table, &path);
    let end = |key| {
        Ok(in_radians(
            number(table, &[path[0], path[1], key])?,
            degrees,
        ))
    };
    Ok((end("min")?, end("max")?))
}
