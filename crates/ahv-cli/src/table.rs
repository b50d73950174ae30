//! `--table`: a table whose values take the place of those that the models were generated with.

mod unit;
mod values;

use std::ops::Range;
use std::path::Path;
use std::{fs, io};

use toml_edit::{Document, Item};

use crate::failure::Failure;
use crate::names;
use crate::units::Units;
use unit::Unit;

/// The text of a table.
pub(crate) struct Table {
    shown: String,
    text: String,
    document: Document<String>,
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if it cannot be read, or is not TOML.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let text = text_of(path)
            .map_err(|error| Failure::Request(format!("cannot read {shown}: {error}")))?;
        match Document::parse(text.clone()) {
            Ok(document) => Ok(Self {
                shown,
                text,
                document,
            }),
            Err(error) => {
                let message = error.message().trim().replace('\n', "; ");
                Err(fault(&shown, &text, error.span(), &message))
            }
        }
    }

    /// The units of the table's values.
    fn units(&self) -> Result<Units, Failure> {
        let path = ["table", "units"];
        let text = self.word(&path)?;
        let known = [Units::FootSlug, Units::Si];
        let found = known.into_iter().find(|it| it.name() == text);
        found.ok_or_else(|| {
            let problem = names::unknown("units", text, &known.map(Units::name));
            self.fault(&path, &problem)
        })
    }

    /// The factor that turns the value of the entry at `path` into the unit `expected`: 1, or a degree where `degrees`
    /// are allowed.
    fn unit(&self, path: &[&str], expected: &str, degrees: bool) -> Result<f64, Failure> {
        let path = [path, &["unit"]].concat();
        let text = self.word(&path)?;
        let help = format!("the unit here is `{expected}`");
        let found = Unit::parse(text).ok_or_else(|| {
            let known = "known are ft, slug, lb, m, kg, N, s, rad and deg, with *, / and ^";
            let text = shortened(text);
            self.fault(&path, &format!("`{text}` is no unit; {known}; {help}"))
        })?;
        match Unit::parse(expected).and_then(|expected| found.in_terms_of(&expected)) {
            Some(ratio) if is_about(ratio, 1.0) => Ok(1.0),
            Some(ratio) if degrees && is_about(ratio, Unit::DEGREE) => Ok(Unit::DEGREE),
            Some(_) => {
                let own = self.units()?.name();
                let message =
                    format!("`{text}` measures the right thing, but the table is in {own}");
                Err(self.fault(
                    &path,
                    &format!("{message}; write the value in `{expected}`"),
                ))
            }
            None => Err(self.fault(&path, &format!("the unit `{text}` does not fit; {help}"))),
        }
    }

    fn number(&self, path: &[&str]) -> Result<f64, Failure> {
        let item = self.item(path);
        let number =
            item.and_then(|it| it.as_float().or_else(|| it.as_integer().map(|n| n as f64)));
        let finite = number.filter(|number| number.is_finite());
        finite.ok_or_else(|| {
            self.fault(
                path,
                &format!("`{}` should be a finite number", path.join(".")),
            )
        })
    }

    fn word(&self, path: &[&str]) -> Result<&str, Failure> {
        let text = self.item(path).and_then(Item::as_str);
        text.ok_or_else(|| self.fault(path, &format!("`{}` should be a text", path.join("."))))
    }

    fn item(&self, path: &[&str]) -> Option<&Item> {
        path.iter()
            .try_fold(self.document.as_item(), |item, key| item.get(key))
    }

    /// A fault at the value of `path`, or of the innermost entry around it that is there.
    fn fault(&self, path: &[&str], message: &str) -> Failure {
        let mut lengths = (0..=path.len()).rev();
        let span = lengths.find_map(|length| self.item(path.get(..length)?)?.span());
        fault(&self.shown, &self.text, span, message)
    }

    /// A fault at the key at the end of `path`.
    fn key_fault(&self, path: &[&str], message: &str) -> Failure {
        let key = path.split_last().and_then(|(key, section)| {
            let (key, _) = self.item(section)?.as_table_like()?.get_key_value(key)?;
            key.span()
        });
        match key {
            Some(span) => fault(&self.shown, &self.text, Some(span), message),
            None => self.fault(path, message),
        }
    }
}

/// The text of a regular file: a pipe would wait for a writer, a device has no end.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() || kind.is_dir() {
        fs::read_to_string(path)
    } else {
        let message = "it is a pipe, a socket or a device, not a file";
        Err(io::Error::new(io::ErrorKind::InvalidInput, message))
    }
}

/// The start of a text, in characters that do not act on a terminal.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    let start: String = text.chars().take(LONGEST).collect();
    let more = if start.len() < text.len() { "..." } else { "" };
    format!("{}{more}", start.escape_debug())
}

fn is_about(ratio: f64, expected: f64) -> bool {
    (ratio / expected - 1.0).abs() < 1e-9
}

/// A fault at its line and column, or in a file as a whole.
fn fault(shown: &str, text: &str, span: Option<Range<usize>>, message: &str) -> Failure {
    // What stands in a table must not act on a terminal.
    let acts =
        |c: char| c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let message = message.replace(acts, "\u{fffd}");
    let before = span.and_then(|span| text.get(..span.start));
    Failure::Request(match before {
        Some(before) => {
            let line = before.matches('\n').count() + 1;
            let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
            format!("{shown}:{line}:{column}: {message}")
        }
        None => format!("{shown}: {message}"),
    })
}
