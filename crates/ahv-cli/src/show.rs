//! Numbers with their units for a person to read.

use std::f64::consts::PI;

use ahv_analysis::statistics::OpenEstimate;

use crate::number::Shown;

pub(crate) const RAD_PER_DEG: f64 = PI / 180.0;

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
