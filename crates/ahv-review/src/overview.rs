//! A table to look at: its numbers with their sources, and what each contributes.

use std::fmt::{self, Display};

use ahv_core::{EntryKind, Fit};
use ahv_table::{Text, visible};
use serde::Serialize;
use toml_edit::Item;

use crate::Subject;
use crate::contents::{Contents, Number, models, written};

/// Width of the bar of a whole, in characters.
const BAR: usize = 20;

/// A table, group by group. Its texts hold no character that acts on a terminal or a page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Overview {
    /// Its name.
    pub name: String,
    /// The models that it lists.
    pub models: Vec<String>,
    /// Its system of units.
    pub units: String,
    /// Its sections with numbers, and those of its sets.
    pub groups: Vec<Group>,
    /// Its validity box.
    pub validity: Vec<Interval>,
    /// Its sources by their keys.
    pub sources: Vec<(String, String)>,
}

/// A section.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// The set that it is part of; none for the table's own.
    pub set: Option<String>,
    /// Its name.
    pub section: String,
    /// Of a polynomial, what it is; else empty.
    pub doc: String,
    /// Its unit, of a polynomial.
    pub unit: Option<String>,
    /// Its entries.
    pub entries: Vec<Row>,
}

/// An entry.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its key.
    pub key: String,
    /// Its value as it is written.
    pub value: String,
    /// Its unit as it is written.
    pub unit: String,
    /// What it is, of a parameter.
    pub doc: String,
    /// Its relative uncertainty.
    pub uncertainty: Option<f64>,
    /// How far it can be trusted.
    pub status: String,
    /// Key of its source.
    pub source: String,
    /// The largest magnitude of its term over the validity box, in the unit of the quantity; none of a parameter, or where a variable has no
    /// interval.
    pub largest: Option<f64>,
    /// This over the sum of all terms' of the quantity.
    pub share: Option<f64>,
}

/// An interval of the validity box.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Its name.
    pub name: String,
    /// Its lower end as it is written.
    pub min: String,
    /// Its upper end as it is written.
    pub max: String,
    /// Its unit as it is written.
    pub unit: String,
}

impl Overview {
    /// Of a table of the models of `subject`; what is wrong with the table is left out.
    #[must_use]
    pub fn new(text: &Text, subject: &Subject) -> Self {
        let contents = Contents::read(text, subject.family);
        let of_same = |a: &Number<'_>, b: &Number<'_>| (a.set, a.section) == (b.set, b.section);
        let groups = contents.entries.chunk_by(of_same);
        let word = |path: &[&str]| {
            let text = text.item(path).and_then(Item::as_str);
            visible(text.unwrap_or_default())
        };
        Self {
            name: word(&["table", "name"]),
            models: models(text).into_iter().map(visible).collect(),
            units: visible(contents.system),
            groups: groups.map(|it| group(&contents, it)).collect(),
            validity: validity(text),
            sources: sources(text),
        }
    }
}

fn group(contents: &Contents<'_>, numbers: &[Number<'_>]) -> Group {
    let [first, ..] = numbers else {
        unreachable!("a chunk holds one at least")
    };
    let is_fit = |fit: &&Fit| fit.section == first.section;
    let fit = contents.family.table.fits.iter().find(is_fit);
    // A set is shown with what it replaces in the sum: the terms that it leaves are the table's.
    let replaced = |own: &&Number<'_>| !numbers.iter().any(|it| it.key == own.key);
    let others = contents.own().filter(|it| it.section == first.section);
    let kept = others
        .filter(replaced)
        .filter_map(|it| contents.largest(it));
    let largest: Vec<Option<f64>> = numbers.iter().map(|it| contents.largest(it)).collect();
    let whole = largest.iter().flatten().sum::<f64>() + kept.sum::<f64>();
    let rows = numbers.iter().zip(largest).map(|(number, largest)| Row {
        key: visible(number.key),
        value: number.written.clone(),
        unit: visible(number.unit),
        doc: doc(contents, number),
        uncertainty: Some(number.uncertainty).filter(|it| it.is_finite()),
        status: visible(number.status),
        source: visible(number.source),
        largest,
        share: largest.filter(|_| whole > 0.0).map(|it| it / whole),
    });
    Group {
        set: first.set.map(visible),
        section: visible(first.section),
        doc: fit.map_or("", |it| it.doc).to_owned(),
        unit: fit.map(|it| contents.converted(it.unit).0),
        entries: rows.collect(),
    }
}

/// What a parameter is; of a coefficient that is its key.
fn doc(contents: &Contents<'_>, number: &Number<'_>) -> String {
    let known = contents.parameter(number);
    let entry = known.and_then(|index| contents.family.table.entries.get(index));
    let parameter = entry.filter(|it| it.kind == EntryKind::Parameter);
    parameter.map_or("", |it| it.doc).to_owned()
}

fn validity(text: &Text) -> Vec<Interval> {
    let content = text.item(&["validity"]).and_then(Item::as_table_like);
    let intervals = content.into_iter().flat_map(|it| it.iter());
    let read = |(name, item): (&str, &Item)| {
        let ends = item.as_table_like()?;
        let [min, max] = ["min", "max"].map(|key| written(ends.get(key)?));
        Some(Interval {
            name: visible(name),
            min: min?,
            max: max?,
            unit: visible(ends.get("unit")?.as_str()?),
        })
    };
    intervals.filter_map(read).collect()
}

fn sources(text: &Text) -> Vec<(String, String)> {
    let content = text.item(&["sources"]).and_then(Item::as_table_like);
    let sources = content.into_iter().flat_map(|it| it.iter());
    let owned = |(key, item): (&str, &Item)| Some((visible(key), visible(item.as_str()?)));
    sources.filter_map(owned).collect()
}

impl Group {
    /// The header of the section as a table writes it.
    #[must_use]
    pub fn header(&self) -> String {
        match &self.set {
            Some(set) => format!("[sets.{set:?}.{}]", self.section),
            None => format!("[{}]", self.section),
        }
    }

    /// What it is and its unit, of a polynomial.
    #[must_use]
    pub fn described(&self) -> String {
        match self.unit.as_deref() {
            None => String::new(),
            Some("1") => format!("{}, dimensionless", self.doc),
            Some(unit) => format!("{}, {unit}", self.doc),
        }
    }
}

impl Row {
    /// The relative uncertainty in per cent.
    #[must_use]
    pub fn shown_uncertainty(&self) -> String {
        let percent = |it: f64| format!("±{} %", (it * 1e4).round() / 100.0);
        self.uncertainty.map_or_else(String::new, percent)
    }

    /// The share in per cent.
    #[must_use]
    pub fn shown_share(&self) -> String {
        let percent = |it: f64| format!("{:.1} %", it * 100.0);
        self.share.map_or_else(|| "-".to_owned(), percent)
    }

    fn cells(&self) -> [String; 6] {
        [
            self.key.clone(),
            self.value.clone(),
            self.unit.clone(),
            self.shown_uncertainty(),
            self.status.clone(),
            self.source.clone(),
        ]
    }

    /// The share as a bar.
    fn bar(&self) -> String {
        const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
        let eighths = (self.share.unwrap_or(0.0) * (8 * BAR) as f64).round() as usize;
        format!("{}{}", "█".repeat(eighths / 8), EIGHTHS[eighths % 8])
    }
}

impl Display for Overview {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {}; {}",
            self.name,
            self.models.join(", "),
            self.units
        )?;
        for group in &self.groups {
            let rows: Vec<[String; 6]> = group.entries.iter().map(Row::cells).collect();
            let width = |column: usize| {
                let widths = rows.iter().map(|row| row[column].chars().count());
                widths.max().unwrap_or(0)
            };
            let [key, value, unit, uncertainty, status, source] = std::array::from_fn(width);
            writeln!(f, "\n{} {}", group.header(), group.described())?;
            for (cells, row) in rows.iter().zip(&group.entries) {
                let [k, v, u, x, t, s] = cells;
                let line = format!(
                    "  {k:<key$}  {v:>value$}  {u:<unit$}  {x:>uncertainty$}  {t:<status$}  {s:<source$}"
                );
                let line = match (group.unit.is_some(), row.doc.as_str()) {
                    (true, _) => format!("{line}  {:>7}  {}", row.shown_share(), row.bar()),
                    (false, doc) => format!("{line}  {doc}"),
                };
                writeln!(f, "{}", line.trim_end())?;
            }
        }
        writeln!(f, "\n[validity]")?;
        let longest = self.validity.iter().map(|it| it.name.chars().count()).max();
        let name = longest.unwrap_or(0);
        for it in &self.validity {
            writeln!(
                f,
                "  {:<name$}  {} to {} {}",
                it.name, it.min, it.max, it.unit
            )?;
        }
        writeln!(f, "\n[sources]")?;
        for (key, text) in &self.sources {
            writeln!(f, "  {key}: {text}")?;
        }
        let what = "Per cent and bar: the largest magnitude of the term over the validity box, of the sum over all terms.";
        writeln!(f, "\n{what}")
    }
}
