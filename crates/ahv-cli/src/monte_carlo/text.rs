//! What is told of the flights in words: a table that fits a terminal.

use std::fmt::Write;

use ahv_analysis::monte_carlo::{Remains, StateSpread};
use ahv_analysis::statistics::{Estimate, OpenEstimate};

use super::Summary;
use crate::number::Shown;
use crate::output::readable;

/// Significant digits of a standard deviation; all numbers of its row have as many decimals.
const DIGITS: i32 = 3;
/// A number as large as this one is a power of ten.
const LARGE: f64 = 1e8;
/// A number takes no more places than these: the table fits 100 columns.
const WIDEST: usize = 9;
/// Parameters that are listed.
const LISTED: usize = 4;

/// Headings of the table; the interval of the mean is as wide to both sides.
const HEADINGS: [&str; 9] = [
    "state", "unit", "mean", "+-", "std", "low", "high", "0.5 %", "99.5 %",
];

impl Summary<'_> {
    pub(super) fn text(&self) -> String {
        let mut text = self.head();
        let last = self.outcome.snapshots.last();
        let states = last.into_iter().flat_map(|it| &it.states);
        let labels = self.ready.vehicle.states.iter();
        let rows = labels
            .zip(states)
            .map(|((name, unit), state)| row(name, unit, state));
        let rows: Vec<[String; HEADINGS.len()]> = rows.collect();
        text += &table(&rows);
        if rows.iter().flatten().any(|cell| cell.ends_with('*')) {
            text += "\n* the sample is too small for an interval with two ends of this point";
        }
        text += &self.control();
        // Writing into a String cannot fail.
        let _ = write!(
            text,
            "\nleft the validity box: {}",
            percent(self.left_any(last, 0))
        );
        if self.has_limits() {
            let _ = write!(
                text,
                "\nleft the limits: {}",
                percent(self.left_any(last, 1))
            );
        }
        let _ = write!(
            text,
            "\nlost, with a state that was no longer finite, or parameters that break a rule: {} of {}",
            self.outcome.lost, self.outcome.members
        );
        if self.outcome.not_flown > 0 {
            let _ = write!(
                text,
                "\n{} of them did not fly, for their parameters break a rule",
                self.outcome.not_flown
            );
        }
        text += &self.causes();
        let _ = write!(text, "\ndigest of the last states: {}", self.outcome.digest);
        text
    }

    /// What the control variate did at the end.
    fn control(&self) -> String {
        let Some(last) = self.outcome.snapshots.last() else {
            return String::new();
        };
        if !self.arguments.control_variate {
            return String::new();
        }
        let states = self.ready.vehicle.states.iter().zip(&last.states);
        let shown = states.filter_map(|((name, _), state)| {
            let Remains { mean, std } = state.remains?;
            Some(format!("{name} {:.3e} {:.3e}", Shown(mean), Shown(std)))
        });
        let shown: Vec<String> = shown.collect();
        if !shown.is_empty() {
            return format!(
                "\nby the control variate; what remains of the variance of mean and standard deviation:\n  {}",
                shown.join("\n  ")
            );
        }
        let lost = self.outcome.flown() - last.members;
        let why = match lost {
            0 => "the flights are too few, or their linear companions do not move".to_owned(),
            _ => format!(
                "{lost} flights were lost, and those that are left are no sample of what is known"
            ),
        };
        format!("\nno control variate: {why}")
    }

    /// What was flown.
    fn head(&self) -> String {
        let (outcome, experiment) = (&self.outcome, &self.ready.experiment);
        let flights = if self.is_complete() {
            format!("{} flights", outcome.members)
        } else {
            format!(
                "interrupted: {} of {} flights",
                outcome.members, outcome.asked
            )
        };
        let with = |is: bool, what: &'static str| if is { what } else { "" };
        format!(
            "{}: {}\n{}\n{} of {} s, {} {} s, {}, seed {}{}{}\n{:.3e} member-steps per second, threads {}\n\
             at the end, with intervals of 95 % of mean and standard deviation:\n",
            self.ready.vehicle.name(),
            self.ready.place,
            self.ready.vehicle.described(),
            flights,
            Shown(self.ready.duration()),
            experiment.scheme.name(),
            Shown(experiment.dt),
            experiment.mode.name(),
            experiment.seed,
            with(experiment.dispersion.is_some(), ", dispersed"),
            with(experiment.feedback.is_some(), ", feedback"),
            self.rate(),
            self.ready.threads(outcome.asked),
        )
    }

    /// The parameters that the lost members, and the states at the end, have to do with most.
    fn causes(&self) -> String {
        let causes = self
            .causes
            .iter()
            .filter(|cause| !cause.correlations.0.is_empty());
        let lines = causes.map(|cause| {
            let listed = cause.correlations.0.iter().take(LISTED);
            let listed = listed.map(|(name, rank)| format!("{name} {rank:+.2}"));
            format!(
                "\n  {:<12} {}",
                cause.of,
                listed.collect::<Vec<_>>().join(", ")
            )
        });
        let lines: String = lines.collect();
        match lines.as_str() {
            "" => String::new(),
            lines => format!(
                "\nrank correlations with the drawn parameters, where they are not chance:{lines}"
            ),
        }
    }
}

/// The numbers of a state.
fn row(name: &str, unit: &str, state: &StateSpread) -> [String; HEADINGS.len()] {
    let (unit, factor) = readable(unit);
    let std = state.std.unwrap_or_default();
    let decimals = decimals(std.value.map_or(0.0, |value| value * factor));
    let shown = |value: Option<f64>| value.map(|value| number(value * factor, decimals));
    let or = |value: Option<f64>, other: &str| shown(value).unwrap_or_else(|| other.to_owned());
    let point = |estimate: Option<&OpenEstimate>| {
        let it = estimate.copied().unwrap_or_default();
        let open = it.low.is_none() || it.high.is_none();
        or(it.value, "-") + if open { "*" } else { "" }
    };
    [
        name.to_owned(),
        unit.replace('1', ""),
        or(state.mean.map(|it| it.value), "none"),
        or(state.mean.map(|it| 0.5 * (it.high - it.low)), "none"),
        or(std.value, "none"),
        or(std.low, "open"),
        or(std.high, "open"),
        point(state.quantiles.first()),
        point(state.quantiles.last()),
    ]
}

/// Decimals with which `std` has [`DIGITS`] digits.
fn decimals(std: f64) -> i32 {
    let size = std.abs().log10().floor();
    if size.is_finite() {
        (f64::from(DIGITS - 1) - size) as i32
    } else {
        DIGITS
    }
}

/// A number with so many decimals, or as many as there is room for; with a power of ten where these do not show it.
fn number(value: f64, decimals: i32) -> String {
    let wanted = usize::try_from(decimals).unwrap_or(0);
    let text = |places: usize| format!("{:.places$}", Shown(value + 0.0));
    let fits = |places: &usize| value.abs() < LARGE && text(*places).chars().count() <= WIDEST;
    let places = (0..=wanted.min(WIDEST)).rev().find(fits);
    let shows = |places: usize| places == wanted || value.abs() >= 10_f64.powi(1 - places as i32);
    match places.filter(|&places| shows(places)) {
        Some(places) => text(places),
        None if value == 0.0 => "0".to_owned(),
        None => format!("{:.2e}", Shown(value)),
    }
}

/// Columns as wide as their widest cell; names to the left, numbers to the right.
fn table(rows: &[[String; HEADINGS.len()]]) -> String {
    let heading = HEADINGS.map(str::to_owned);
    let all = || std::iter::once(&heading).chain(rows);
    let width = |column: usize| {
        all()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let line = |row: &[String; HEADINGS.len()]| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let width = width(column);
            match column {
                0 | 1 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            }
        });
        format!("  {}", cells.collect::<Vec<_>>().join(" "))
            .trim_end()
            .to_owned()
    };
    all().map(line).collect::<Vec<_>>().join("\n")
}

fn percent(it: Estimate) -> String {
    format!(
        "{:.4} % [{:.4}, {:.4}]",
        100.0 * it.value,
        100.0 * it.low,
        100.0 * it.high
    )
}

#[cfg(test)]
mod tests {
    use super::{decimals, number, table};

    #[test]
    fn a_row_has_the_digits_of_its_deviation() {
        assert_eq!([0.0123, 1.23, 123.0, 0.0].map(decimals), [4, 2, 0, 3]);
        assert_eq!(number(85_000.123_456, decimals(1.23)), "85000.12");
        assert_eq!(number(1.5e-9, decimals(1e-9)), "1.50e-9");
        assert_eq!(number(-0.0, 2), "0.00");
        assert_eq!(number(3e40, 2), "3.00e40");
        // As many as fit, of a mean whose deviation is far smaller.
        assert_eq!(number(-7_702.080_8, decimals(1e-9)), "-7702.081");
        assert_eq!(number(0.0, decimals(1e-300)), "0");
    }

    #[test]
    fn columns_are_aligned() {
        let row = ["gamma", "deg", "1.5", "0.1", "2", "1", "3", "-4*", "7"].map(str::to_owned);
        let table = table(&[row]);
        let ends: Vec<usize> = table.lines().map(|line| line.chars().count()).collect();
        assert_eq!(ends[0], ends[1], "{table}");
    }
}
