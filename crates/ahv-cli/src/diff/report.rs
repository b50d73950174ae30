//! Differences for people, for pull requests and for programs.

mod model;

use std::fmt::Write as _;
use std::path::Path;

use ahv_generate::ChangedFile;

use ahv_review::{Change, Difference, Side};
use serde::Serialize;

use super::effect::Effect;
use super::{Compared, Kind};
use crate::show::show_beside;

#[derive(Serialize)]
pub(super) struct Json<'a> {
    tables: Vec<Table<'a>>,
}

#[derive(Serialize)]
struct Table<'a> {
    table: &'a str,
    /// `changed`, `same`, `new` or `removed`.
    status: &'static str,
    #[serde(flatten)]
    difference: Option<&'a Difference>,
    models: &'a [Effect],
    /// With --code.
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<&'a [ChangedFile]>,
}

pub(super) fn json(compared: &[Compared]) -> Json<'_> {
    let tables = compared.iter().map(|it| {
        let (changed, status) = match &it.change {
            Kind::Whole(status) => (None, *status),
            Kind::Changed(changed) if changed.difference.is_empty() => (None, "same"),
            Kind::Changed(changed) => (Some(changed), "changed"),
        };
        Table {
            table: &it.name,
            status,
            difference: changed.map(|it| &it.difference),
            models: changed.map_or(&[], |it| &it.effects),
            code: changed.and_then(|it| it.code.as_deref()),
        }
    });
    Json {
        tables: tables.collect(),
    }
}

/// What a report consists of.
enum Block {
    Title(String),
    Heading(String),
    Line(String),
    Rows(Vec<Vec<String>>),
    /// What it shows, and its file; for pull requests alone.
    Picture(String, String),
}

/// For people.
pub(super) fn text(compared: &[Compared]) -> String {
    let mut text = String::new();
    for block in blocks(compared) {
        // Writing into a String cannot fail.
        let _ = match block {
            Block::Title(title) => writeln!(text, "{title}"),
            Block::Heading(heading) => writeln!(text, "\n{heading}"),
            Block::Line(line) => writeln!(text, "  {line}"),
            Block::Picture(..) => Ok(()),
            Block::Rows(rows) => {
                text.push_str(&aligned(&rows));
                Ok(())
            }
        };
    }
    text
}

fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let cells: Vec<String> = cells
            .map(|(cell, &width)| format!("{cell:<width$}"))
            .collect();
        format!("  {}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// For a pull request.
pub(super) fn markdown(compared: &[Compared]) -> String {
    let mut text = String::new();
    let safe = |text: &str| {
        let escaped = text.replace('\\', "\\\\").replace('|', "\\|");
        escaped
            .replace('<', "&lt;")
            .replace('*', "\\*")
            .replace('_', "\\_")
    };
    for block in blocks(compared) {
        let _ = match block {
            Block::Title(title) => writeln!(text, "### {}\n", safe(&title)),
            Block::Heading(heading) => writeln!(text, "**{}**\n", safe(&heading)),
            Block::Line(line) => writeln!(text, "{}\n", safe(&line)),
            Block::Picture(what, file) => writeln!(text, "![{}](<{file}>)\n", safe(&what)),
            Block::Rows(rows) => {
                for (index, row) in rows.iter().enumerate() {
                    let cells: Vec<String> = row.iter().map(|it| safe(it)).collect();
                    let _ = writeln!(text, "| {} |", cells.join(" | "));
                    if index == 0 {
                        let _ = writeln!(text, "|{}", "---|".repeat(row.len()));
                    }
                }
                writeln!(text)
            }
        };
    }
    text
}

fn blocks(compared: &[Compared]) -> Vec<Block> {
    let mut blocks = Vec::new();
    for it in compared {
        match &it.change {
            Kind::Whole(status) => blocks.push(Block::Title(format!("{}: {status}", it.name))),
            Kind::Changed(changed) if changed.difference.is_empty() => {
                blocks.push(Block::Title(format!("{}: the same", it.name)));
            }
            Kind::Changed(changed) => {
                blocks.push(Block::Title(it.name.clone()));
                of_table(&mut blocks, &changed.difference);
                for (index, effect) in changed.effects.iter().enumerate() {
                    model::blocks(&mut blocks, effect);
                    if let Some(path) = changed.pictures.get(index) {
                        let what = format!("Poles and trims of {}", effect.model);
                        blocks.push(Block::Picture(what, linked(path)));
                    }
                }
                of_code(&mut blocks, changed.code.as_deref());
            }
        }
    }
    blocks
}

fn of_table(blocks: &mut Vec<Block>, difference: &Difference) {
    if !difference.changes.is_empty() {
        blocks.push(Block::Heading("Numbers".to_owned()));
        let header = ["", "old", "new", "change", "of the uncertainty", "also"];
        let rows = difference.changes.iter().map(numbers);
        blocks.push(rows_of(&header, rows));
    }
    if !difference.quantities.is_empty() {
        blocks.push(Block::Heading(
            "Largest change over the validity box".to_owned(),
        ));
        let rows = difference.quantities.iter().map(|it| {
            let at_most = it
                .at_most
                .map_or_else(|| "-".to_owned(), |most| show_beside(most, 0.0, &it.unit));
            vec![it.section.clone(), at_most, percent(it.share)]
        });
        blocks.push(rows_of(&["", "at most", "of the quantity"], rows));
    }
    if !difference.others.is_empty() {
        blocks.push(Block::Heading("Also".to_owned()));
        let shown = |side: &Option<String>| side.clone().unwrap_or_else(|| "-".to_owned());
        let rows = difference.others.iter();
        let rows = rows.map(|(path, old, new)| vec![path.clone(), shown(old), shown(new)]);
        blocks.push(rows_of(&["", "old", "new"], rows));
    }
}

fn rows_of(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Block {
    let header = header.iter().map(|&it| it.to_owned()).collect();
    Block::Rows(std::iter::once(header).chain(rows).collect())
}

fn numbers(change: &Change) -> Vec<String> {
    let side = |side: &Option<Side>| match side {
        Some(side) if side.unit == "1" => side.value.clone(),
        Some(side) => format!("{} {}", side.value, side.unit),
        None => "-".to_owned(),
    };
    let times = change.uncertainties.map(|it| format!("{it:+.2}"));
    let also = change.old.as_ref().zip(change.new.as_ref());
    let also = also.map_or_else(Vec::new, |(old, new)| {
        let texts = [(&old.source, &new.source), (&old.status, &new.status)];
        let differing = texts.into_iter().filter(|(old, new)| old != new);
        let mut also: Vec<String> = differing
            .map(|(old, new)| format!("{old} to {new}"))
            .collect();
        if old.uncertainty != new.uncertainty {
            also.push(format!(
                "±{} to ±{}",
                percent(old.uncertainty),
                percent(new.uncertainty)
            ));
        }
        also
    });
    vec![
        change.path.clone(),
        side(&change.old),
        side(&change.new),
        change
            .relative
            .map_or_else(|| "-".to_owned(), |it| format!("{:+.3} %", it * 100.0)),
        times.unwrap_or_else(|| "-".to_owned()),
        also.join(", "),
    ]
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_owned(), |it| format!("{:.3} %", it * 100.0))
}

/// A path as a link in Markdown has it, between angle brackets.
fn linked(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let escaped = |letter: char| match letter {
        '<' | '>' | '\n' | '\r' | '%' => format!("%{:02X}", u32::from(letter)),
        letter => letter.to_string(),
    };
    path.chars().map(escaped).collect()
}

fn of_code(blocks: &mut Vec<Block>, code: Option<&[ChangedFile]>) {
    let Some(code) = code else {
        return;
    };
    let sum = |of: fn(&ChangedFile) -> usize| code.iter().map(of).sum::<usize>();
    let (added, removed) = (sum(|it| it.added), sum(|it| it.removed));
    let heading = format!("Generated code: +{added} −{removed} lines");
    blocks.push(Block::Heading(heading));
    if code.is_empty() {
        blocks.push(Block::Line("no file changes".to_owned()));
        return;
    }
    let rows = code.iter();
    let rows = rows.map(|it| {
        vec![
            it.path.clone(),
            format!("+{}", it.added),
            format!("−{}", it.removed),
        ]
    });
    blocks.push(rows_of(&["file", "added", "removed"], rows));
}
