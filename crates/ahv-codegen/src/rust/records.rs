//! Structs as calls of macros of `ahv-core`, which know what such structs have: each name stands once.

use super::format::verbatim;
use super::layout::{WIDTH, flow, flowed};
use crate::wording::wrapped;
use crate::{EmitError, ir};

/// A field, with what it is where its name does not say it.
pub(super) struct Field<'a> {
    pub(super) name: &'a str,
    pub(super) about: Option<String>,
}

/// The fields of another struct that are taken over, in groups that have lines of their own.
pub(super) struct Copied<'a> {
    pub(super) of: &'a str,
    pub(super) groups: Vec<Vec<&'a str>>,
}

/// A struct of numbers: what is described first, then what its name describes.
pub(super) fn record(
    about: &[String],
    name: &str,
    fields: &[Field<'_>],
    copied: &Copied<'_>,
) -> String {
    let mut lines = documented("    ", about);
    lines.push(format!("    pub struct {name}<R> {{"));
    let mut plain = Vec::new();
    for field in fields {
        match &field.about {
            Some(about) => {
                lines.extend(documented("        ", &wrapped(about)));
                lines.push(format!("        {},", field.name));
            }
            None => plain.push(field.name),
        }
    }
    lines.extend((!plain.is_empty()).then(|| flowed("        ", &plain)));
    lines.push("    }".to_owned());
    if !copied.groups.is_empty() {
        lines.push(format!("    from {} {{", copied.of));
        let groups = copied.groups.iter();
        lines.extend(groups.map(|group| flowed("        ", group)));
        lines.push("    }".to_owned());
    }
    call("record", &lines)
}

/// A vector, from the name, the description and the unit of each component.
pub(super) fn vector<'a>(
    about: &str,
    name: &str,
    fields: impl Iterator<Item = (&'a str, String, &'a str)>,
    units: &ir::Units,
) -> Result<String, EmitError> {
    let mut lines = documented("    ", &[about.to_owned()]);
    lines.push(format!("    pub struct {name}<T> {{"));
    for (name, about, unit) in fields {
        let (si, factor) = units.si(unit)?;
        lines.extend(documented("        ", &[about]));
        lines.push(format!("        {name}: [{unit:?}, {si:?}, {factor:?}],"));
    }
    lines.push("    }".to_owned());
    Ok(call("vector", &lines))
}

/// A struct of the entries of an array, by rows; `entries` are the places of all.
pub(super) fn entries(about: &str, head: &str, entries: &[&[String]]) -> String {
    let mut lines = documented("    ", &[about.to_owned()]);
    lines.push(format!("    {head} {{"));
    for (row, others) in rows(entries) {
        let items = items(&others);
        let one = format!(
            "        {row} {{ {} }}",
            items.join(" ").trim_end_matches(',')
        );
        if one.chars().count() <= WIDTH {
            lines.push(one);
        } else {
            lines.push(format!("        {row} {{"));
            lines.push(flow("            ", &items));
            lines.push("        }".to_owned());
        }
    }
    lines.push("    }".to_owned());
    call("entries", &lines)
}

/// Entries by their first index.
fn rows<'a>(entries: &[&'a [String]]) -> Vec<(&'a str, Vec<&'a [String]>)> {
    let mut rows: Vec<(&str, Vec<&[String]>)> = Vec::new();
    for entry in entries {
        let Some((first, others)) = entry.split_first() else {
            continue;
        };
        match rows.iter_mut().find(|(row, _)| row == first) {
            Some((_, row)) => row.push(others),
            None => rows.push((first, vec![others])),
        }
    }
    rows
}

/// What stands in a row: names with commas, or rows again.
fn items(entries: &[&[String]]) -> Vec<String> {
    let rows = rows(entries).into_iter();
    let item = |(row, others): (&str, Vec<&[String]>)| match others.as_slice() {
        [[]] => format!("{row},"),
        others => {
            let inner = items(others).join(" ");
            format!("{row} {{ {} }}", inner.trim_end_matches(','))
        }
    };
    rows.map(item).collect()
}

fn documented(indent: &str, docs: &[String]) -> Vec<String> {
    let docs = docs.iter();
    docs.map(|line| format!("{indent}/// {line}")).collect()
}

/// The call of a macro of `ahv-core`.
fn call(name: &str, lines: &[String]) -> String {
    verbatim(&format!("ahv_core::{name}! {{\n{}\n}}", lines.join("\n")))
}
