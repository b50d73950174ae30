//! `name=value` on the command line, for the components of a named vector.

use crate::failure::Failure;
use crate::labels::Labels;
use crate::names;
use crate::show::RAD_PER_DEG;

/// Values given for components of a vector.
pub(crate) struct Assignments {
    names: &'static [&'static str],
    values: Vec<(usize, f64)>,
}

impl Assignments {
    /// Reads `name=value` pairs for the components of these labels, given by `option`.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] that says what is wrong and what would be right.
    pub(crate) fn parse(option: &str, texts: &[String], labels: Labels) -> Result<Self, Failure> {
        let mut values: Vec<(usize, f64)> = Vec::new();
        for text in texts {
            let new = Self::one(option, text, labels)?;
            if values.iter().any(|old| old.0 == new.0) {
                return Err(Failure::Request(format!(
                    "{option}: `{text}` gives a value a second time"
                )));
            }
            values.push(new);
        }
        Ok(Self {
            names: labels.names,
            values,
        })
    }

    /// Reads one `name=value` pair: the index of the component, and its value.
    ///
    /// # Errors
    ///
    /// As [`Self::parse`].
    pub(crate) fn one(option: &str, text: &str, labels: Labels) -> Result<(usize, f64), Failure> {
        parse_one(text, labels).map_err(|message| Failure::Request(format!("{option}: {message}")))
    }

    /// What is given, by name.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let named = |&(index, value)| Some((*self.names.get(index)?, value));
        self.values.iter().filter_map(named)
    }

    /// The value given for `name`.
    pub(crate) fn get(&self, name: &str) -> Option<f64> {
        self.iter().find(|(own, _)| *own == name).map(|it| it.1)
    }

    /// Writes the values into `vector`.
    pub(crate) fn apply(&self, vector: &mut [f64]) {
        for &(index, value) in &self.values {
            if let Some(component) = vector.get_mut(index) {
                *component = value;
            }
        }
    }
}

fn parse_one(text: &str, labels: Labels) -> Result<(usize, f64), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}` is not of the form NAME=VALUE"))?;
    let name = name.trim();
    let index = labels.index_of(name);
    let index = index.ok_or_else(|| names::unknown("name", name, labels.names))?;
    let value = parse_value(name, value.trim(), labels.unit(name))?;
    Ok((index, value))
}

/// Units in which a quantity of unit `unit` may be given, with their size in `unit`.
fn accepted(unit: &'static str) -> Vec<(&'static str, f64)> {
    match unit {
        "rad" => vec![("deg", RAD_PER_DEG), ("rad", 1.0)],
        "rad/s" => vec![("deg/s", RAD_PER_DEG), ("rad/s", 1.0)],
        "1" => Vec::new(),
        other => vec![(other, 1.0)],
    }
}

/// The number and the unit of a value whose unit is not accepted.
fn other_unit(text: &str) -> Option<(&str, &str)> {
    let ends = text.char_indices().rev().map(|(end, _)| text.split_at(end));
    let mut parts = ends.map(|(number, unit)| (number.trim(), unit));
    parts.find(|(number, _)| number.parse().is_ok_and(f64::is_finite))
}

fn parse_value(name: &str, text: &str, unit: &'static str) -> Result<f64, String> {
    let units = accepted(unit);
    let with_unit = units
        .iter()
        .find_map(|&(unit, factor)| Some((text.strip_suffix(unit)?, factor)));
    let (number, factor) = with_unit.unwrap_or((text, 1.0));
    let number: f64 = number.trim().parse().map_err(|_| match units.first() {
        Some((first, _)) => match other_unit(text) {
            Some((number, other)) => format!(
                "`{text}`: {name} is in {}, not in {other}; write for example {name}={number}{first}",
                units.iter().map(|it| it.0).collect::<Vec<_>>().join(" or ")
            ),
            None => format!("`{text}` is no value for {name}; write for example {name}=1.5{first}"),
        },
        None => format!("`{text}` is no value for {name}, which is a bare number"),
    })?;
    let is_angle = unit.starts_with("rad");
    // What is no number gets no better by a unit.
    if is_angle && with_unit.is_none() && number.is_finite() {
        let examples: Vec<String> = units
            .iter()
            .map(|(unit, _)| format!("{name}={text}{unit}"))
            .collect();
        return Err(format!(
            "{name} is an angle and needs a unit: {}",
            examples.join(" or ")
        ));
    }
    let value = number * factor;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("`{text}` is not a finite number"))
    }
}
