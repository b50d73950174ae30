//! What a table says otherwise than another of the same family: its numbers, and all else.

use std::collections::BTreeMap;

use ahv_table::{Text, visible};
use serde::Serialize;
use toml_edit::TableLike;

use crate::Subject;
use crate::contents::{Contents, Number};

/// What differs between two tables.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Numbers, in the order of the new table; those that it has no more come last.
    pub changes: Vec<Change>,
    /// By how much the polynomials of the table's own set change.
    pub quantities: Vec<QuantityChange>,
    /// Everything else: path, old and new text.
    pub others: Vec<(String, Option<String>, Option<String>)>,
}

/// A number that differs, in its value or in what is said of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Its keys, as TOML writes them.
    pub path: String,
    /// What it was; none if it is new.
    pub old: Option<Side>,
    /// What it is; none if it was removed.
    pub new: Option<Side>,
    /// The change of the value over the old one; none from 0, or of a unit that measures something else.
    pub relative: Option<f64>,
    /// The change of the value over its old uncertainty; none where that is 0.
    pub uncertainties: Option<f64>,
}

/// A number with what is said of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Its value as it is written.
    pub value: String,
    /// Its unit as it is written.
    pub unit: String,
    /// Key of its source.
    pub source: String,
    /// How far it can be trusted.
    pub status: String,
    /// Its relative uncertainty.
    pub uncertainty: Option<f64>,
}

/// The change of a polynomial over the validity box of the new table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuantityChange {
    /// Its section.
    pub section: String,
    /// Its unit.
    pub unit: String,
    /// What the change is at most: the sum of the largest changes of the terms. None where a variable has no interval.
    pub at_most: Option<f64>,
    /// This over the sum of the largest magnitudes of the old terms.
    pub share: Option<f64>,
}

impl Difference {
    /// Between two tables of the models of `subject`.
    #[must_use]
    pub fn new(old: &Text, new: &Text, subject: &Subject) -> Self {
        let [before, after] = [old, new].map(|text| Contents::read(text, subject.family));
        let mut changes: Vec<Change> = Vec::new();
        for entry in &after.entries {
            let earlier = find(&before, entry);
            changes.extend(change(earlier, Some(entry)));
        }
        let removed = before
            .entries
            .iter()
            .filter(|it| find(&after, it).is_none());
        changes.extend(removed.filter_map(|it| change(Some(it), None)));
        Self {
            changes,
            quantities: quantities(&before, &after),
            others: others(&before, &after),
        }
    }

    /// Whether both tables say the same.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty() && self.others.is_empty()
    }
}

/// The entry that another table has in the place of this one; monomials have more than one spelling.
fn find<'c, 'a>(contents: &'c Contents<'a>, entry: &Number<'_>) -> Option<&'c Number<'a>> {
    let mut entries = contents.entries.iter();
    entries.find(|it| {
        let monomial = |it: &Number<'_>| it.term.as_ref().map(|(_, powers)| format!("{powers:?}"));
        let is_same = it.key == entry.key || it.term.is_some() && monomial(it) == monomial(entry);
        (it.set, it.section) == (entry.set, entry.section) && is_same
    })
}

fn change(old: Option<&Number<'_>>, new: Option<&Number<'_>>) -> Option<Change> {
    let sides = [old, new].map(|it| it.map(side));
    let [before, after] = &sides;
    if before == after {
        return None;
    }
    let path = new.or(old)?.path();
    let ratio = old.zip(new).map(|(old, new)| (new.value - old.value, old));
    let relative = ratio.map(|(change, old)| change / old.value.abs());
    let uncertainties = ratio.map(|(change, old)| change / (old.value.abs() * old.uncertainty));
    let finite = |it: &f64| it.is_finite();
    let [old, new] = sides;
    Some(Change {
        path: path
            .iter()
            .map(|key| quoted(key))
            .collect::<Vec<_>>()
            .join("."),
        old,
        new,
        relative: relative.filter(finite),
        uncertainties: uncertainties.filter(finite),
    })
}

fn side(number: &Number<'_>) -> Side {
    Side {
        value: number.written.clone(),
        unit: visible(number.unit),
        source: visible(number.source),
        status: visible(number.status),
        uncertainty: Some(number.uncertainty).filter(|it| it.is_finite()),
    }
}

/// A key as TOML writes it.
fn quoted(key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
    match !key.is_empty() && key.chars().all(is_bare) {
        true => key.to_owned(),
        false => format!("\"{}\"", visible(key)),
    }
}

fn quantities(before: &Contents<'_>, after: &Contents<'_>) -> Vec<QuantityChange> {
    let mut found = Vec::new();
    for fit in after.family.table.fits {
        let is_term =
            |it: &&Number<'_>| it.term.is_some() && it.set.is_none() && it.section == fit.section;
        let value = |it: Option<&Number<'_>>| it.map_or(0.0, |it| it.value);
        let kept = after.entries.iter().filter(is_term);
        let kept = kept.map(|it| (it, it.value - value(find(before, it))));
        let gone = before.entries.iter().filter(is_term);
        let gone = gone.filter(|it| find(after, it).is_none());
        let gone = gone.map(|it| (it, -it.value));
        let changes: Vec<_> = kept
            .chain(gone)
            .filter(|(_, change)| *change != 0.0)
            .collect();
        if changes.is_empty() {
            continue;
        }
        // Both in the box of the new table: what it was is known, and where it is used is said now.
        let at_most = changes.iter().try_fold(0.0, |sum, (it, change)| {
            Some(sum + after.monomial(it)? * change.abs())
        });
        let terms = before.entries.iter().filter(is_term);
        let whole: f64 = terms.filter_map(|it| after.largest(it)).sum();
        found.push(QuantityChange {
            section: fit.section.to_owned(),
            unit: after.converted(fit.unit).0,
            at_most,
            share: at_most.map(|it| it / whole).filter(|it| it.is_finite()),
        });
    }
    found
}

/// Everything in a table but its numbers, by paths.
fn leaves(contents: &Contents<'_>) -> BTreeMap<String, String> {
    fn collect(
        table: &dyn TableLike,
        path: &mut Vec<String>,
        numbers: &[Vec<String>],
        found: &mut BTreeMap<String, String>,
    ) {
        for (key, item) in table.iter() {
            path.push(key.to_owned());
            match item.as_table_like() {
                _ if numbers.contains(path) => {}
                Some(inner) if !inner.is_empty() => collect(inner, path, numbers, found),
                // An empty section, such as a set that replaces nothing, says something, too.
                _ => {
                    let keys: Vec<String> = path.iter().map(|key| quoted(key)).collect();
                    let text = item.clone().into_value().map(|value| {
                        let value = value.decorated("", "");
                        visible(&value.to_string())
                    });
                    found.insert(keys.join("."), text.unwrap_or_default());
                }
            }
            path.pop();
        }
    }
    let paths = contents.entries.iter().map(Number::path);
    let numbers: Vec<Vec<String>> = paths
        .map(|path| path.into_iter().map(str::to_owned).collect())
        .collect();
    let mut found = BTreeMap::new();
    collect(contents.text.root(), &mut Vec::new(), &numbers, &mut found);
    found
}

fn others(
    before: &Contents<'_>,
    after: &Contents<'_>,
) -> Vec<(String, Option<String>, Option<String>)> {
    let [old, new] = [before, after].map(leaves);
    let mut paths: Vec<&String> = old.keys().chain(new.keys()).collect();
    paths.sort();
    paths.dedup();
    let differs = paths
        .into_iter()
        .filter(|path| old.get(*path) != new.get(*path));
    differs
        .map(|path| (path.clone(), old.get(path).cloned(), new.get(path).cloned()))
        .collect()
}
