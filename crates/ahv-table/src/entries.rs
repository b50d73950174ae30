//! Checks of single entries: their keys, numbers, units and provenance.

use toml_edit::{Item, TableLike};

use crate::fault::{shortened, suggestion};
use crate::unit::{self, Unit, degrees, in_radians};
use crate::{Fault, Part, Quantity, Text};

const KEYS: [&str; 5] = ["value", "unit", "source", "status", "uncertainty"];
const STATUSES: [&str; 4] = ["published", "derived", "unverified", "assumed"];

/// A table with its faults.
pub(crate) struct Entries<'a> {
    pub(crate) text: &'a Text,
    pub(crate) faults: Vec<Fault>,
    /// The unit system of the table.
    pub(crate) system: &'static str,
    /// The relative uncertainty of an entry that does not have its own.
    pub(crate) uncertainty: f64,
}

impl<'a> Entries<'a> {
    /// Records a fault of the key at `path`.
    pub(crate) fn key(&mut self, rule: &'static str, path: &[&str], message: &str, help: &str) {
        let fault = Fault::new(rule, path, Part::Key, message, help);
        self.faults.push(fault);
    }

    /// Records a fault of the value at `path`.
    pub(crate) fn value(&mut self, rule: &'static str, path: &[&str], message: &str, help: &str) {
        let fault = Fault::new(rule, path, Part::Value, message, help);
        self.faults.push(fault);
    }

    /// The section `name`, if it is one.
    pub(crate) fn content(&self, name: &str) -> Option<&'a dyn TableLike> {
        self.text.root().get(name)?.as_table_like()
    }

    /// The section `name`, which a table must have.
    pub(crate) fn section(&mut self, name: &str) -> Option<&'a dyn TableLike> {
        let content = self.content(name);
        if self.text.root().get(name).is_none() {
            let message = format!("the section `[{name}]` is missing");
            self.key("missing", &[], &message, "");
        } else if content.is_none() {
            let message = format!("`{name}` must be a section");
            self.value("shape", &[name], &message, "");
        }
        content
    }

    /// Records the keys of a section or an entry that are not known.
    pub(crate) fn only(
        &mut self,
        rule: &'static str,
        path: &[&str],
        content: &dyn TableLike,
        known: &[&str],
    ) {
        let what = rule.trim_start_matches("unknown-");
        for (key, _) in content.iter().filter(|(key, _)| !known.contains(key)) {
            let message = format!("unknown {what} `{}`", shortened(key));
            self.key(
                rule,
                &[path, &[key]].concat(),
                &message,
                &suggestion(key, known),
            );
        }
    }

    /// The number of the entry at `path`, in the unit `expected`; `None` if it has none.
    pub(crate) fn entry(&mut self, path: &[&str], expected: &str) -> Option<Quantity> {
        let item = self.text.item(path);
        let Some(entry) = item.and_then(Item::as_table_like) else {
            let message = "an entry is a table like { value = 1.0, unit = \"1/rad\" }";
            self.value("shape", path, message, "");
            return None;
        };
        self.only("unknown-key", path, entry, &KEYS);
        for key in ["value", "unit"] {
            if entry.get(key).is_none() {
                self.key("missing", path, &format!("`{key}` is missing"), "");
            }
        }
        let value = entry
            .get("value")
            .and_then(|value| self.number(value, &[path, &["value"]].concat()));
        let unit = entry.get("unit");
        let degrees = unit.and_then(|unit| self.unit(unit, &[path, &["unit"]].concat(), expected));
        let uncertainty = self.provenance(entry, path);
        Some(Quantity {
            value: in_radians(value?, degrees.unwrap_or(0)),
            uncertainty,
        })
    }

    /// A finite number.
    pub(crate) fn number(&mut self, item: &Item, path: &[&str]) -> Option<f64> {
        let number = item
            .as_float()
            .or_else(|| item.as_integer().map(|n| n as f64));
        let shown = path.join(".");
        match number {
            None => {
                let message = format!("`{shown}` must be a number");
                self.value("not-a-number", path, &message, "");
                None
            }
            Some(number) if !number.is_finite() => {
                let message = format!("`{shown}` must be a finite number");
                self.value("not-finite", path, &message, "");
                None
            }
            finite => finite,
        }
    }

    /// The [`degrees`] of a unit that is the expected one, or that with degrees for radians; `None` for other units.
    pub(crate) fn unit(&mut self, item: &Item, path: &[&str], expected: &str) -> Option<i32> {
        let Some(text) = item.as_str() else {
            self.value("unit", path, "`unit` must be a text", "");
            return None;
        };
        let help = format!("the unit here is `{expected}`");
        let Some(found) = Unit::parse(text) else {
            let message = format!(
                "`{}` is not a unit; known are {}, with `*`, `/` and `^`",
                shortened(text),
                unit::known()
            );
            self.value("unit", path, &message, &help);
            return None;
        };
        let degrees = degrees(text);
        let wanted = degrees.map(|degrees| in_radians(1.0, degrees));
        match Unit::parse(expected).and_then(|expected| found.in_terms_of(&expected)) {
            Some(ratio) if wanted.is_some_and(|wanted| (ratio / wanted - 1.0).abs() < 1e-9) => {
                degrees
            }
            Some(_) => {
                let system = self.system;
                let message =
                    format!("`{text}` measures the right thing, but the table is in {system}");
                let help = format!("write the value in `{expected}`");
                self.value("unit", path, &message, &help);
                None
            }
            None => {
                let message = format!("the unit `{text}` does not fit");
                self.value("unit", path, &message, &help);
                None
            }
        }
    }

    /// Checks source, status and uncertainty of an entry or the header; returns the uncertainty.
    pub(crate) fn provenance(&mut self, entry: &dyn TableLike, path: &[&str]) -> f64 {
        let sources = self.content("sources");
        let sources: Vec<&str> = sources
            .iter()
            .flat_map(|it| it.iter().map(|it| it.0))
            .collect();
        self.one_of(entry, path, "source", "unknown-source", &sources);
        self.one_of(entry, path, "status", "unknown-status", &STATUSES);
        let Some(item) = entry.get("uncertainty") else {
            return self.uncertainty;
        };
        let path = [path, &["uncertainty"]].concat();
        let uncertainty = self.number(item, &path).unwrap_or(f64::NAN);
        if uncertainty < 0.0 {
            let message = "a relative uncertainty is not negative";
            self.value("uncertainty", &path, message, "");
        }
        uncertainty
    }

    /// Checks that the text under `key`, if there is one, is a known one.
    fn one_of(
        &mut self,
        entry: &dyn TableLike,
        path: &[&str],
        key: &str,
        rule: &'static str,
        known: &[&str],
    ) {
        let Some(item) = entry.get(key) else { return };
        if !item.as_str().is_some_and(|text| known.contains(&text)) {
            let text = shown(item);
            let message = format!("unknown {key} `{text}`");
            let help = suggestion(&text, known);
            self.value(rule, &[path, &[key]].concat(), &message, &help);
        }
    }
}

/// A value for a message: a text without its quotes.
pub(crate) fn shown(item: &Item) -> String {
    let text = item.as_str().map(str::to_owned);
    shortened(text.unwrap_or_else(|| item.to_string()).trim())
}
