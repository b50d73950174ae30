//! A table and its IR, and how their numbers and words are written.

use crate::Table;
use crate::ir::{Choice, ChoiceOption, Document, Parameter, ParameterSet};
pub(super) use crate::values::CHOICES;
use crate::values::Values;
use crate::wording::visible;

/// Sections of a table that hold parameters of the vehicle and its surroundings rather than a curve fit.
const PLAIN_SECTIONS: [&str; 5] = ["vehicle", "environment", "modes", "noise", CHOICES];

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

/// Whether a section of a table holds the coefficients of a curve fit.
pub(super) fn is_fit(section: &str) -> bool {
    !PLAIN_SECTIONS.contains(&section)
}

impl<'a> Subject<'a> {
    /// The nominal value of a parameter.
    pub(super) fn value(&self, parameter: &Parameter) -> f64 {
        let parameters = self.document.parameters.iter().zip(&self.values.nominal);
        let found = parameters.filter(|(known, _)| known.name == parameter.name);
        found.map(|(_, value)| *value).next().unwrap_or(f64::NAN)
    }

    /// The value that a set gives to a parameter.
    pub(super) fn replacement(&self, set: &ParameterSet, parameter: &str) -> f64 {
        let sets = self.document.sets.iter().zip(&self.values.sets);
        let mut values = sets
            .filter(|(known, _)| known.name == set.name)
            .flat_map(|(_, values)| values);
        let found = values.find(|(name, _)| name == parameter);
        found.map_or(f64::NAN, |(_, value)| *value)
    }

    /// The option that the table chooses.
    pub(super) fn chosen(&self, choice: &'a Choice) -> Option<&'a ChoiceOption> {
        let name = self.table.text(&[CHOICES, &choice.name])?;
        choice.options.iter().find(|option| option.name == name)
    }

    /// An entry of the validity box, angles in rad.
    pub(super) fn bounds(&self, name: &str) -> Option<(f64, f64)> {
        let entries = self.document.validity.iter().zip(&self.values.bounds);
        let found = entries.filter(|(variable, _)| variable.name == name);
        found.map(|(_, bounds)| *bounds).next()
    }
}

/// A value as a reader wants it: an angle in degrees, and nothing of what rounding left behind.
pub(super) fn readable(value: f64, unit: &str) -> (f64, String) {
    match unit.strip_prefix("rad") {
        Some(rest) if rest.is_empty() || rest == "/s" => {
            let degrees = value.to_degrees();
            ((degrees * 1e9).round() / 1e9, format!("deg{rest}"))
        }
        _ => (value, unit.to_owned()),
    }
}

/// A number for a table of the documentation, in its shortest decimal form.
pub(super) fn plain_number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e7).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// A unit for a reader.
pub(super) fn unit_text(unit: &str) -> &str {
    if unit == "1" { "–" } else { unit }
}

/// Text in a cell of a Markdown table.
pub(super) fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// Text of a user in a cell of a Markdown table: it shows as it stands, whatever it means in Markdown or HTML.
pub(super) fn verbatim(text: &str) -> String {
    let text = visible(text);
    let mut escaped = String::with_capacity(text.len());
    let (mut rest, mut in_word) = (text.chars().peekable(), false);
    while let Some(c) = rest.next() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            // Inside a word an underscore means nothing.
            '_' if in_word && rest.peek().is_some_and(|c| c.is_alphanumeric()) => escaped.push(c),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '$' | '~' => escaped.extend(['\\', c]),
            _ => escaped.push(c),
        }
        in_word = c.is_alphanumeric();
    }
    escaped
}

/// A formula in a cell of a Markdown table, or in a sentence.
pub(super) fn inline_math(latex: &str) -> String {
    // A bar would end the cell.
    format!("${}$", latex.replace('|', "\\vert "))
}
