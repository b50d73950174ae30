//! The section on (27)–(35) as printed.

use super::page::{Cell, Row, Section, Table};
use super::{Findings, sentences};
use crate::reproduce::differences::Difference;

/// The printed form beside the exact one.
pub(super) fn section(differences: &[Difference], findings: &mut Findings) -> Section {
    let shares = differences
        .iter()
        .map(|it| (it.name, it.largest / it.exact));
    let greatest = shares.max_by(|(_, a), (_, b)| a.total_cmp(b));
    if let Some((name, share)) = greatest {
        findings.push(sentences::printed_form(name, share));
    }
    let row = |it: &Difference| {
        Row::from(vec![
            Cell::words(it.canard),
            Cell::words(it.name),
            Cell::words(it.unit),
            Cell::number(it.largest),
            Cell::number(it.exact),
        ])
    };
    Section {
        id: "differences",
        title: "As printed and exact",
        paragraphs: vec![sentences::differences()],
        tables: vec![Table {
            file: "differences.csv",
            caption: "Largest magnitudes over the box of validity: exact form less printed form, and the exact form".to_owned(),
            head: vec!["canard", "difference", "unit", "largest", "largest of the exact form"],
            rows: differences.iter().map(row).collect(),
        }],
        pictures: Vec::new(),
    }
}
