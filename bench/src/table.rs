//! Tables for a terminal and for the documentation.

use std::fmt::Write as _;

use crate::race::Finish;

/// A heading, what is to be said about the figures, the names of the columns, and the rows.
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) note: String,
    pub(crate) columns: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// Rates in millions a second, and how many times faster than the first on as many threads.
    pub(crate) fn of_rates(title: String, note: String, finishes: &[Finish]) -> Self {
        let row = |it: &Finish| {
            let [rates, faster] = [it.seconds.rates(1e-6), it.ratio.rates(1.0)];
            let cells = |[lower, median, upper]: [f64; 3], decimals: usize| {
                [
                    format!("{median:.decimals$}"),
                    format!("{lower:.decimals$}–{upper:.decimals$}"),
                ]
            };
            let mut row = vec![
                it.threads.to_string(),
                it.candidate.to_owned(),
                it.how.to_owned(),
            ];
            row.extend(cells(rates, 1));
            row.extend(cells(faster, 2));
            row
        };
        Self {
            title,
            note,
            columns: vec![
                "threads",
                "candidate",
                "how",
                "10⁶/s",
                "quartiles",
                "faster",
                "quartiles",
            ],
            rows: finishes.iter().map(row).collect(),
        }
    }

    /// For a terminal.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let head: Vec<String> = self.columns.iter().map(|&it| it.to_owned()).collect();
        let lines = || std::iter::once(&head).chain(&self.rows);
        let width = |column: usize| {
            let widths = lines().map(|row| row[column].chars().count());
            widths.max().unwrap_or_default()
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        for row in lines() {
            let cells = row.iter().zip(&widths).map(|(cell, &width)| {
                if is_figure(cell) {
                    format!("{cell:>width$}")
                } else {
                    format!("{cell:<width$}")
                }
            });
            let cells: Vec<String> = cells.collect();
            let _ = writeln!(text, "{}", cells.join("  ").trim_end());
        }
        text
    }

    /// For the documentation.
    pub(crate) fn markdown(&self) -> String {
        let mut text = format!(
            "| {} |\n|{}\n",
            self.columns.join(" | "),
            "---|".repeat(self.columns.len())
        );
        for row in &self.rows {
            let _ = writeln!(text, "| {} |", row.join(" | "));
        }
        text
    }
}

fn is_figure(cell: &str) -> bool {
    cell.starts_with(|first: char| first.is_ascii_digit())
}
