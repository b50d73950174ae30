//! Filters of templates: values as Rust has them.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Display;

use askama::Values;

use crate::wording::visible;

/// A number.
#[askama::filter_fn]
pub(crate) fn number(value: &f64, _: &dyn Values) -> askama::Result<String> {
    Ok(literal(*value))
}

/// A number, a right angle by its name.
pub(crate) fn literal(value: f64) -> String {
    let sign = if value < 0.0 { "-" } else { "" };
    if value.abs() == FRAC_PI_2 {
        format!("{sign}core::f64::consts::FRAC_PI_2")
    } else {
        format!("{value:?}")
    }
}

/// A text.
#[askama::filter_fn]
pub(crate) fn text(text: impl Display, _: &dyn Values) -> askama::Result<String> {
    Ok(quoted(text))
}

/// A list of texts.
#[askama::filter_fn]
pub(crate) fn texts(texts: impl AsRef<[String]>, _: &dyn Values) -> askama::Result<String> {
    let texts: Vec<String> = texts.as_ref().iter().map(quoted).collect();
    Ok(format!("[{}]", texts.join(", ")))
}

/// A text that may be missing.
#[askama::filter_fn]
pub(crate) fn optional(text: &Option<String>, _: &dyn Values) -> askama::Result<String> {
    let text = text.as_ref().map(quoted);
    Ok(text.map_or_else(|| "None".to_owned(), |text| format!("Some({text})")))
}

fn quoted(text: impl Display) -> String {
    format!("{:?}", visible(&text.to_string()))
}
