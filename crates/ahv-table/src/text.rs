//! TOML text, and where its entries stand.

use std::error::Error;
use std::fmt::{self, Display};
use std::ops::Range;

use toml_edit::{Document, DocumentMut, InlineTable, Item, Key, TableLike, Value};

use crate::Fault;

/// A table as TOML.
#[derive(Debug)]
pub struct Text {
    document: Document<String>,
}

/// Text that is not TOML.
#[derive(Clone, Debug, PartialEq)]
pub struct Unreadable {
    /// What is wrong.
    pub message: String,
    /// Where, in bytes.
    pub span: Option<Range<usize>>,
}

/// The side of an entry that a fault concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Its key.
    Key,
    /// Its value.
    Value,
}

impl Text {
    /// Reads TOML 1.0, the version that the generator's Python reads.
    ///
    /// # Errors
    ///
    /// [`Unreadable`] with the place of the fault; a duplicate key is one.
    pub fn parse(text: String) -> Result<Self, Unreadable> {
        let document = Document::parse(text).map_err(|error| Unreadable {
            message: error.message().trim().replace('\n', "; "),
            span: error.span(),
        })?;
        match newer_in_table(document.as_table(), document.raw()) {
            Some((at, what)) => Err(Unreadable {
                message: format!("{what}: this is TOML 1.1, and tables are TOML 1.0"),
                span: Some(at..at + 1),
            }),
            None => Ok(Self { document }),
        }
    }

    /// The text itself.
    #[must_use]
    pub fn raw(&self) -> &str {
        self.document.raw()
    }

    pub(crate) fn mutable(&self) -> DocumentMut {
        self.document.clone().into_mut()
    }

    /// The whole table.
    #[must_use]
    pub fn root(&self) -> &dyn TableLike {
        self.document.as_table()
    }

    /// What stands at a path of keys.
    #[must_use]
    pub fn item(&self, path: &[&str]) -> Option<&Item> {
        let root = self.document.as_item();
        path.iter()
            .try_fold(root, |item, key| item.as_table_like()?.get(key))
    }

    /// Where the key or the value at a path stands, in bytes; of the innermost entry around it if there is none.
    #[must_use]
    pub fn span<S: AsRef<str>>(&self, path: &[S], part: Part) -> Option<Range<usize>> {
        let mut table = self.root();
        let mut found = None;
        for (depth, key) in path.iter().enumerate() {
            let Some((name, item)) = table.get_key_value(key.as_ref()) else {
                break;
            };
            let last = depth + 1 == path.len();
            found = match part {
                Part::Value if last => item.span().or_else(|| name.span()),
                _ => name.span().or_else(|| item.span()),
            };
            match item.as_table_like() {
                Some(inner) => table = inner,
                None => break,
            }
        }
        found
    }

    /// A fault in one line: `FILE:LINE:COLUMN: what is wrong; what would be right [rule]`.
    #[must_use]
    pub fn line(&self, file: &str, fault: &Fault) -> String {
        line(file, self.document.raw(), self.offset(fault), fault)
    }

    /// Where a fault stands, in bytes.
    pub(crate) fn offset(&self, fault: &Fault) -> usize {
        self.span(&fault.path, fault.part).map_or(0, |it| it.start)
    }
}

impl Display for Unreadable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl Error for Unreadable {}

impl Unreadable {
    /// The fault in one line, as [`Text::line`] shows others.
    #[must_use]
    pub fn line(&self, file: &str, text: &str) -> String {
        let fault = Fault::new("unreadable", &[], Part::Key, &self.message, "");
        let start = self.span.as_ref().map_or(0, |it| it.start);
        line(file, text, start, &fault)
    }
}

fn line(file: &str, text: &str, at: usize, fault: &Fault) -> String {
    let before = text.get(..at).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    format!("{file}:{line}:{column}: {fault}")
}

type Place = (usize, &'static str);

/// The first thing that TOML 1.0 does not have.
fn newer_in_table(table: &dyn TableLike, text: &str) -> Option<Place> {
    table.iter().find_map(|(key, item)| {
        let (key, _) = table.get_key_value(key)?;
        newer_in_key(key, text).or_else(|| match item {
            Item::Value(value) => newer_in_value(value, text),
            Item::ArrayOfTables(tables) => {
                tables.iter().find_map(|table| newer_in_table(table, text))
            }
            other => newer_in_table(other.as_table()?, text),
        })
    })
}

fn newer_in_value(value: &Value, text: &str) -> Option<Place> {
    match value {
        Value::String(_) => newer_escape(value.span()?, text),
        Value::Datetime(moment) => {
            let seconds = moment.value().time.is_none_or(|time| time.second.is_some());
            (!seconds).then_some((value.span()?.start, "a time without seconds"))
        }
        Value::Array(array) => array.iter().find_map(|value| newer_in_value(value, text)),
        Value::InlineTable(table) => newer_in_inline(table, text),
        _ => None,
    }
}

fn newer_in_inline(table: &InlineTable, text: &str) -> Option<Place> {
    let inside = newer_in_table(table, text);
    let span = table.span().filter(|_| !table.is_dotted());
    let Some(span) = span else {
        return inside; // Of dotted keys: the table around it holds them.
    };
    let mut parts = Vec::new();
    collect_parts(table, &mut parts);
    parts.sort_unstable_by_key(|part| part.start);
    let ends = std::iter::once(span.start).chain(parts.iter().map(|part| part.end));
    let starts = parts.iter().map(|part| part.start).chain([span.end]);
    let line_end = ends.zip(starts).find_map(|(end, start)| {
        let at = end + text.get(end..start)?.find('\n')?;
        Some((at, "an inline table of more than one line"))
    });
    let comma = table.trailing_comma().then(|| {
        let last = text.get(span.clone()).and_then(|text| text.rfind(','));
        (
            span.start + last.unwrap_or(0),
            "a comma at the end of an inline table",
        )
    });
    inside.or(line_end).or(comma)
}

/// The places of keys and values in an inline table.
fn collect_parts(table: &InlineTable, parts: &mut Vec<Range<usize>>) {
    for (key, value) in table.iter() {
        parts.extend(table.key(key).and_then(Key::span));
        match value {
            Value::InlineTable(inner) if inner.is_dotted() => collect_parts(inner, parts),
            value => parts.extend(value.span()),
        }
    }
}

fn newer_in_key(key: &Key, text: &str) -> Option<Place> {
    newer_escape(key.span()?, text)
}

/// `\e` or `\x` in a quoted text.
fn newer_escape(span: Range<usize>, text: &str) -> Option<Place> {
    let quoted = text.get(span.clone())?;
    if !quoted.starts_with('"') {
        return None;
    }
    let mut characters = quoted.char_indices();
    while let Some((at, character)) = characters.next() {
        if character == '\\' && matches!(characters.next(), Some((_, 'e' | 'x'))) {
            return Some((span.start + at, "the escape \\e or \\x"));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::Text;

    #[test]
    fn tables_are_toml_1_0() {
        for (text, place) in [
            ("a = { b = 1, }", "1:12"),
            ("a = { b = 1,\n c = 2 }", "1:13"),
            (
                "a = { b.c = 1, d.e = [\n1,\n], f = \"\"\"\n\"\"\"\n}",
                "4:4",
            ),
            ("[s]\na = [{ b = { c = 1 ,} }]", "2:20"),
            ("a = \"\\\\\\e\"", "1:8"),
            ("\"\\x41\" = 1", "1:2"),
            ("a = 07:32", "1:5"),
            ("[[a]]\nb = { c = 1, }", "2:12"),
        ] {
            let unreadable = Text::parse(text.to_owned()).expect_err(text);
            let line = unreadable.line("f", text);
            assert!(line.starts_with(&format!("f:{place}: ")), "{text}: {line}");
            assert!(line.ends_with("TOML 1.0 [unreadable]"), "{text}: {line}");
        }
        for text in [
            "a = { b = [\n1,\n], c = \"\"\"\n\"\"\", d.e = '\\e' }",
            "a = \"\\\\e\"",
            "a = 07:32:00",
            "a = [ 1, ]",
        ] {
            assert!(Text::parse(text.to_owned()).is_ok(), "{text}");
        }
    }
}
