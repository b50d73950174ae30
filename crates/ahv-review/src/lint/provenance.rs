//! Where numbers come from, and how far they can be trusted.

use ahv_table::Part;
use toml_edit::Item;

use super::Findings;
use crate::contents::Contents;

pub(super) fn find(findings: &mut Findings<'_>, contents: &Contents<'_>) {
    for entry in &contents.entries {
        let path = entry.path();
        if entry.has_own == [false, true] {
            let (status, source) = (entry.status, entry.source);
            let message = format!(
                "`{}` is `{status}`, and has the table's source `{source}`",
                entry.key
            );
            let help = "name the `source` of this number";
            let path = [path.as_slice(), &["status"]].concat();
            findings.add("no-source", &path, Part::Value, message, help);
        }
        // What is assumed may be meant exactly.
        if entry.status == "unverified" && entry.uncertainty == 0.0 {
            let message = format!("`{}` is unverified, and its uncertainty is 0", entry.key);
            let help = "give the `uncertainty` that such a number has";
            findings.add("no-uncertainty", &path, Part::Key, message, help);
        }
    }
    unused(findings, contents);
    unverified(findings, contents);
}

fn unused(findings: &mut Findings<'_>, contents: &Contents<'_>) {
    let default = contents.text.item(&["table", "source"]);
    let default = default.and_then(Item::as_str).unwrap_or_default();
    let sources = contents
        .text
        .item(&["sources"])
        .and_then(Item::as_table_like);
    for (source, _) in sources.into_iter().flat_map(|it| it.iter()) {
        let cited = contents.entries.iter().any(|entry| entry.source == source);
        if !cited && source != default {
            let message = format!("no entry cites the source `{source}`");
            findings.add(
                "unused-source",
                &["sources", source],
                Part::Key,
                message,
                "",
            );
        }
    }
}

fn unverified(findings: &mut Findings<'_>, contents: &Contents<'_>) {
    let mut open = contents
        .entries
        .iter()
        .filter(|it| it.status == "unverified");
    let Some(first) = open.next() else { return };
    let message = match 1 + open.count() {
        1 => "this number is unverified".to_owned(),
        count => format!("{count} numbers are unverified; this is the first"),
    };
    let help = "find their source, or give them the status `assumed`";
    findings.add("unverified", &first.path(), Part::Key, message, help);
}
