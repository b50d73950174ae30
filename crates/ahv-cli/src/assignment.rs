//! `name=value` on the command line, for the components of a named vector.

use std::f64::consts::PI;

use ahv_analysis::statistics::OpenEstimate;

use crate::failure::Failure;
use crate::labels::Labels;
use crate::names;
use crate::number::Shown;

const RAD_PER_DEG: f64 = PI / 180.0;

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

fn parse_value(name: &str, text: &str, unit: &'static str) -> Result<f64, String> {
    let units = accepted(unit);
    let with_unit = units
        .iter()
        .find_map(|&(unit, factor)| Some((text.strip_suffix(unit)?, factor)));
    let (number, factor) = with_unit.unwrap_or((text, 1.0));
    let number: f64 = number.trim().parse().map_err(|_| match units.first() {
        Some((first, _)) => {
            format!("`{text}` is no value for {name}; write for example {name}=1.5{first}")
        }
        None => format!("`{text}` is no value for {name}, which is a bare number"),
    })?;
    let is_angle = unit.starts_with("rad");
    if is_angle && with_unit.is_none() {
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

/// Decimals that a person needs.
const DECIMALS: usize = 6;

/// Decimals of an angle in deg, or of a number near 1, at which two different doubles look different.
const MOST_DECIMALS: usize = 17;

/// A value with its unit for a person to read: angles are in deg.
pub(crate) fn show(value: f64, unit: &str) -> String {
    show_with(value, unit, DECIMALS)
}

/// The same with as many more decimals as it takes to tell it from `other`.
pub(crate) fn show_beside(value: f64, other: f64, unit: &str) -> String {
    let look =
        |decimals: &usize| show_with(value, unit, *decimals) != show_with(other, unit, *decimals);
    match (DECIMALS..MOST_DECIMALS).find(look) {
        Some(decimals) => show_with(value, unit, decimals),
        None if value == other => show(value, unit),
        None => format!("{value:e} {unit}"),
    }
}

/// A value with its interval, each end as `shown` has it; "-" for a value that is not known, "open" for an end that is not.
pub(crate) fn interval(estimate: &OpenEstimate, shown: impl Fn(f64) -> String) -> String {
    let OpenEstimate { value, low, high } = *estimate;
    let value = value.map_or_else(|| "-".to_owned(), &shown);
    let [low, high] = [low, high].map(|end| end.map_or_else(|| "open".to_owned(), &shown));
    format!("{value} [{low}, {high}]")
}

fn show_with(value: f64, unit: &str, decimals: usize) -> String {
    match unit {
        // A unit belongs to a number.
        _ if !value.is_finite() => number(value, decimals),
        "1" => number(value, decimals),
        "rad" => format!("{} deg", number(value / RAD_PER_DEG, decimals)),
        "rad/s" => format!("{} deg/s", number(value / RAD_PER_DEG, decimals)),
        other => format!("{} {other}", number(value, decimals)),
    }
}

/// So many decimals at most; powers of ten where decimals would be unreadable.
fn number(value: f64, decimals: usize) -> String {
    if value.is_nan() || value.abs() >= 1e9 {
        return format!("{:.decimals$e}", Shown(value));
    }
    let text = format!("{value:.decimals$}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{show, show_beside};

    #[test]
    fn a_value_is_told_from_a_bound() {
        assert_eq!(show_beside(1.5, 1.0, "1"), "1.5");
        assert_eq!(show_beside(1.000_000_03, 1.0, "1"), "1.00000003");
        assert_eq!(show_beside(1.0, 1.0, "1"), "1");
        assert_eq!(show_beside(1e-308, 0.0, "ft/s"), "1e-308 ft/s");
    }

    #[test]
    fn numbers_are_shown_for_a_person() {
        assert_eq!(show(85_000.0, "ft"), "85000 ft");
        assert_eq!(show(-1e-9, "1"), "0");
        assert_eq!(show(0.5_f64.to_radians(), "rad"), "0.5 deg");
        assert_eq!(show(-0.1_f64.to_radians(), "rad/s"), "-0.1 deg/s");
        assert_eq!(show(-1.25e50, "ft/s"), "-1.250000e50 ft/s");
        assert_eq!(show(f64::NAN, "1"), "not a number");
        assert_eq!(show(f64::INFINITY, "rad"), "infinite");
    }
}
