//! How the numbers and words of a table are written in the documentation.

pub(super) use crate::subject::Subject;
pub(super) use crate::values::CHOICES;
use crate::wording::visible;

/// Sections of a table that hold parameters of the vehicle and its surroundings rather than a curve fit.
const PLAIN_SECTIONS: [&str; 5] = ["vehicle", "environment", "modes", "noise", CHOICES];

/// Whether a section of a table holds the coefficients of a curve fit.
pub(super) fn is_fit(section: &str) -> bool {
    !PLAIN_SECTIONS.contains(&section)
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

/// The tag of an equation of the paper.
pub(super) fn tag(equation: &str) -> String {
    let inner = equation
        .strip_prefix('(')
        .and_then(|text| text.strip_suffix(')'));
    inner.unwrap_or(equation).to_owned()
}
