//! The table with fitted coefficients.

use std::path::Path;

use ahv_core::Table;
use ahv_table::{Text, degrees, in_radians};

use super::outcome::Fitted;
use super::plan::Plan;
use super::samples::Columns;
use crate::failure::Failure;

/// Key of the source of fitted coefficients.
const SOURCE: &str = "fit";

/// Of an error so much may be rounded off a coefficient.
const ROUNDED: f64 = 1e-3;

/// The text of the structure with fitted values, their uncertainties, their source and the box of the samples.
///
/// # Errors
///
/// [`Failure::Numeric`] for a fault of this program.
pub(super) fn table(
    structure: &Text,
    path: &Path,
    plan: &Plan,
    columns: &Columns,
    fitted: &[Fitted],
) -> Result<String, Failure> {
    let mut edit = structure.edit();
    let drawn = !columns.drawn.is_empty();
    let kind = if drawn { "misfit" } else { "standard errors" };
    let count = columns.responses.first().map_or(0, Vec::len);
    let weighted = if columns.weights.is_some() {
        "weighted "
    } else {
        ""
    };
    let source = format!(
        "ahv fit: {weighted}least squares of {count} samples of {}; uncertainties by {kind}",
        columns.origin
    );
    edit.text(&["sources", SOURCE], &source);
    for it in fitted {
        let section = plan.quantities[it.quantity].fit.section;
        let kept = |key: &str| it.terms.iter().any(|term| term.key == key);
        for old in plan.quantities[it.quantity]
            .terms
            .iter()
            .filter(|old| !kept(&old.key))
        {
            edit.remove(&[section, &old.key]);
        }
        for (index, term) in it.terms.iter().enumerate() {
            let error = it.uncertainty(index, drawn);
            let value = rounded(it.estimate.values[index], ROUNDED * error);
            let at = |field| [section, term.key.as_str(), field];
            edit.number(&at("value"), rounded_bits(value * term.factor()));
            edit.text(&at("unit"), &term.unit);
            edit.text(&at("source"), SOURCE);
            edit.text(&at("status"), "derived");
            let relative = if value == 0.0 {
                0.0
            } else {
                error / value.abs()
            };
            edit.number(&at("uncertainty"), digits(relative, 2));
        }
    }
    for (name, (low, high)) in intervals(structure, plan, columns) {
        let unit = structure
            .item(&["validity", name, "unit"])
            .and_then(|it| it.as_str());
        let factor = 1.0 / in_radians(1.0, degrees(unit.unwrap_or("1")).unwrap_or(0));
        edit.number(&["validity", name, "min"], digits(low * factor, 12));
        edit.number(&["validity", name, "max"], digits(high * factor, 12));
    }
    let fault = |why: String| Failure::Numeric(format!("{}: {why}", path.display()));
    let text = Text::parse(edit.into_text()).map_err(|error| fault(error.to_string()))?;
    ahv_review::laid_out(&text).map_err(|error| fault(error.to_string()))
}

/// Entries of the validity box with the intervals that the samples span; one of a single value has none.
pub(super) fn intervals(
    structure: &Text,
    plan: &Plan,
    columns: &Columns,
) -> Vec<(&'static str, (f64, f64))> {
    let listed = ahv_review::models(structure);
    let spanned = |name: &str| {
        let drawn = columns.drawn.iter().find(|it| it.0 == name).map(|it| it.1);
        let index = plan.variables.iter().position(|it| it.name == name);
        drawn.or_else(|| {
            let column = columns.variables.get(index?)?.iter();
            Some(
                column.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
                    (low.min(*it), high.max(*it))
                }),
            )
        })
    };
    let table = plan.family.table;
    let intervals = table
        .validity
        .iter()
        .filter(|it| Table::has(it.models, &listed));
    let spanned = intervals.filter_map(|interval| {
        let of = plan
            .variables
            .iter()
            .filter(|it| it.interval == Some(interval.name))
            .map(|it| it.name);
        let names = of.chain(interval.variables.iter().copied());
        let ends = names
            .filter_map(spanned)
            .reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))?;
        (ends.0 < ends.1).then_some((interval.name, ends))
    });
    spanned.collect()
}

/// A value without the digits below `room`.
fn rounded(value: f64, room: f64) -> f64 {
    if value == 0.0 || room <= 0.0 {
        return value;
    }
    let places = (value.abs().log10().floor() - room.log10().floor()).clamp(0.0, 17.0);
    digits(value, places as usize + 1)
}

/// So many significant digits of a value.
fn digits(value: f64, count: usize) -> f64 {
    let places = count.saturating_sub(1);
    format!("{value:.places$e}").parse().unwrap_or(value)
}

/// A value whose conversion of units added digits of rounding: 16 significant digits.
fn rounded_bits(value: f64) -> f64 {
    digits(value, 16)
}
