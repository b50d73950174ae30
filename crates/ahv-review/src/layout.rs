//! The layout of a table: columns of entries that stand in lines one below the other. Order, numbers as they are
//! written, comments, empty lines and everything else stay.

use std::fmt::{self, Display};
use std::ops::Range;

use ahv_table::{Text, Unreadable};
use toml_edit::{InlineTable, Item, TableLike, Value};

/// A layout that would say something else: a fault of this program, and nothing is written.
#[derive(Debug)]
pub struct NotTheSame;

impl Display for NotTheSame {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("internal error: the layout would change what the table says")
    }
}

impl std::error::Error for NotTheSame {}

/// An entry that has a line to itself.
struct Row<'a> {
    /// Its place from the start of its key to the end of its value, in bytes.
    span: Range<usize>,
    key: &'a str,
    /// Names and values as they are written.
    fields: Vec<(&'a str, &'a str)>,
}

/// The text with aligned columns. It is the same table, and its own layout is itself.
///
/// # Errors
/// [`NotTheSame`], which a test of random tables has not seen.
pub fn laid_out(table: &Text) -> Result<String, NotTheSame> {
    let text = table.raw();
    let mut rows = Vec::new();
    collect(table.root(), text, &mut rows);
    rows.sort_by_key(|row| row.span.start);
    let mut laid_out = String::with_capacity(text.len());
    let mut written = 0;
    for block in rows.chunk_by(|row, next| is_below(text, row, next)) {
        for (row, line) in block.iter().zip(lines(block)) {
            laid_out.push_str(&text[written..row.span.start]);
            laid_out.push_str(&line);
            written = row.span.end;
        }
    }
    laid_out.push_str(&text[written..]);
    match Text::parse(laid_out.clone()) {
        Ok(other) if said(&other) == said(table) => Ok(laid_out),
        Ok(_) | Err(Unreadable { .. }) => Err(NotTheSame),
    }
}

/// Whether a row stands in the line below another.
fn is_below(text: &str, row: &Row<'_>, next: &Row<'_>) -> bool {
    let between = &text[row.span.end..next.span.start];
    between.matches('\n').count() == 1
}

/// The rows among the entries of a table, and of the tables in it.
fn collect<'a>(table: &'a dyn TableLike, text: &'a str, rows: &mut Vec<Row<'a>>) {
    for (key, item) in table.iter() {
        match item {
            Item::Value(Value::InlineTable(entry)) if !entry.is_dotted() => {
                let key = table.get_key_value(key).and_then(|(key, _)| key.span());
                rows.extend(key.and_then(|key| row(text, key, entry)));
            }
            Item::Table(inner) => collect(inner, text, rows),
            _ => {}
        }
    }
}

/// The row of an entry; `None` where something else stands in its line before it, or it has more than one line.
fn row<'a>(text: &'a str, key: Range<usize>, entry: &'a InlineTable) -> Option<Row<'a>> {
    let span = key.start..entry.span()?.end;
    let before = &text[..span.start];
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    if !before[line..].trim().is_empty() || text[span.clone()].contains('\n') {
        return None;
    }
    let mut fields = Vec::new();
    for (name, value) in entry.iter() {
        let is_dotted = value.as_inline_table().is_some_and(InlineTable::is_dotted);
        let name = entry.key(name)?.span().filter(|_| !is_dotted)?;
        fields.push((&text[name], &text[value.span()?]));
    }
    Some(Row {
        span,
        key: &text[key],
        fields,
    })
}

/// The lines of rows that stand one below the other.
fn lines(block: &[Row<'_>]) -> Vec<String> {
    let width = |text: &str| text.chars().count();
    let keys = block.iter().map(|row| width(row.key)).max().unwrap_or(0);
    let mut lines: Vec<String> = block
        .iter()
        .map(|row| format!("{:<keys$} = {{", row.key))
        .collect();
    let columns = block.iter().map(|row| row.fields.len()).max().unwrap_or(0);
    for column in 0..columns {
        let fields = block.iter().map(|row| row.fields.get(column));
        let fields: Vec<Option<&(&str, &str)>> = fields.collect();
        // Numbers are aligned at their points.
        let whole = |value: &str| value.find(['.', 'e', 'E']).unwrap_or(value.len());
        let numbers = fields
            .iter()
            .flatten()
            .filter(|(_, value)| is_number(value));
        let most = numbers.map(|(_, value)| whole(value)).max().unwrap_or(0);
        let shown: Vec<Option<String>> = fields
            .iter()
            .map(|field| {
                let (name, value) = field.as_ref()?;
                let indent = match is_number(value) {
                    true => most - whole(value),
                    false => 0,
                };
                Some(format!(" {name} = {:indent$}{value}", ""))
            })
            .collect();
        let widest = shown
            .iter()
            .flatten()
            .map(|it| width(it))
            .max()
            .unwrap_or(0);
        for ((line, row), shown) in lines.iter_mut().zip(block).zip(&shown) {
            let Some(shown) = shown else { continue };
            line.push_str(shown);
            if column + 1 < row.fields.len() {
                line.push(',');
                line.extend(std::iter::repeat_n(' ', widest - width(shown)));
            }
        }
    }
    lines.iter_mut().for_each(|line| line.push_str(" }"));
    lines
}

fn is_number(value: &str) -> bool {
    value.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c)) && !value.contains(':')
}

/// Everything that a table says, in its order, with numbers as they are written.
fn said(table: &Text) -> String {
    fn of_table(table: &dyn TableLike, said: &mut String) {
        for (key, item) in table.iter() {
            said.push_str(&format!("{key:?}("));
            match item {
                Item::Value(Value::InlineTable(inner)) => of_table(inner, said),
                Item::Table(inner) => of_table(inner, said),
                other => said.push_str(&format!("{:?}", other.to_string().trim())),
            }
            said.push_str("), ");
        }
    }
    let mut text = String::new();
    of_table(table.root(), &mut text);
    text
}
