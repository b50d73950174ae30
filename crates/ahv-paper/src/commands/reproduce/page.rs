//! The page: sections of words, tables and pictures.

use ahv_cli::failure::Failure;
use askama::Template;

use super::sentences::{self, Sentence};
use crate::commands::number::significant;
use crate::reproduce::p_value::Verdict;

/// The whole page.
#[derive(Template)]
#[template(path = "reproduce.html")]
pub(super) struct Page {
    /// What it is about, and how it was made.
    pub(super) subject: Sentence,
    /// What agrees with the paper.
    pub(super) agrees: Vec<Sentence>,
    /// What does not, or cannot.
    pub(super) cannot: Vec<Sentence>,
    /// The rest.
    pub(super) sections: Vec<Section>,
}

/// A part of the page.
#[derive(Default)]
pub(super) struct Section {
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pub(super) paragraphs: Vec<Sentence>,
    pub(super) tables: Vec<Table>,
    pub(super) pictures: Vec<Picture>,
}

/// A table, on the page and as a CSV file.
pub(super) struct Table {
    /// Its file.
    pub(super) file: &'static str,
    pub(super) caption: String,
    pub(super) head: Vec<&'static str>,
    pub(super) rows: Vec<Row>,
}

/// A row of a table.
pub(super) struct Row {
    pub(super) cells: Vec<Cell>,
    /// An explanation, in a row of its own on the page and in a last column of the CSV file.
    pub(super) why: Option<Sentence>,
}

impl From<Vec<Cell>> for Row {
    fn from(cells: Vec<Cell>) -> Self {
        Self { cells, why: None }
    }
}

/// An entry of a table.
pub(super) enum Cell {
    /// Words.
    Words(String),
    /// A number or an interval.
    Number(String),
    /// Whether something holds.
    Verdict(bool),
    /// Whether a number belongs to a distribution.
    Inside(Verdict),
}

/// A picture, on the page and as an SVG file.
pub(super) struct Picture {
    /// Its file.
    pub(super) file: &'static str,
    pub(super) caption: String,
    pub(super) svg: String,
}

impl Cell {
    /// Words.
    pub(super) fn words(text: impl Into<String>) -> Self {
        Self::Words(text.into())
    }

    /// A number, with four significant digits.
    pub(super) fn number(value: f64) -> Self {
        Self::Number(significant(value))
    }

    /// What stands in the cell.
    pub(super) fn text(&self) -> &str {
        match self {
            Self::Words(text) | Self::Number(text) => text,
            Self::Verdict(true) => "yes",
            Self::Verdict(false) => "no",
            Self::Inside(verdict) => sentences::verdict(*verdict),
        }
    }

    /// How it looks.
    pub(super) fn class(&self) -> &'static str {
        match self {
            Self::Words(_) => "words",
            Self::Number(_) => "number",
            Self::Verdict(true) | Self::Inside(Verdict::Inside) => "yes",
            Self::Verdict(false) | Self::Inside(Verdict::Outside) => "no",
            Self::Inside(Verdict::Undecided) => "undecided",
        }
    }
}

impl Page {
    /// The page as HTML that needs nothing else to be read.
    ///
    /// # Errors
    ///
    /// [`Failure::Numeric`] if it cannot be written.
    pub(super) fn html(&self) -> Result<String, Failure> {
        let html = self.render();
        html.map_err(|error| Failure::Numeric(format!("cannot write the page: {error}")))
    }
}

impl Table {
    /// The table as CSV.
    ///
    /// # Errors
    ///
    /// [`Failure::Numeric`] if it cannot be written.
    pub(super) fn csv(&self) -> Result<Vec<u8>, Failure> {
        let problem =
            |error: String| Failure::Numeric(format!("cannot write {}: {error}", self.file));
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut write = |row: Vec<&str>| {
            writer
                .write_record(row)
                .map_err(|error| problem(error.to_string()))
        };
        let explained = self.rows.iter().any(|row| row.why.is_some());
        let mut head = self.head.clone();
        head.extend(explained.then_some("why"));
        write(head)?;
        for Row { cells, why } in &self.rows {
            let mut row: Vec<&str> = cells.iter().map(Cell::text).collect();
            // A model without a trim has no numbers.
            row.resize(self.head.len(), "");
            row.extend(explained.then(|| why.as_ref().map_or("", Sentence::text)));
            write(row)?;
        }
        writer
            .into_inner()
            .map_err(|error| problem(error.to_string()))
    }
}
