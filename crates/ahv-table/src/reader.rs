//! Checks the sections of a table.

use ahv_core::{Bounds, Choice, ChoiceOption, EntryKind, Interval, Table};
use toml_edit::Item;

use crate::entries::{Entries, shown};
use crate::fault::suggestion;
use crate::monomial::{Powers, powers, powers_in};
use crate::{Checked, Family, Fault, Quantity, Set, unit};

pub(crate) const HEADER: &str = "table";
pub(crate) const SI: &str = "si";
pub(crate) const SOURCES: &str = "sources";
const CHOICES: &str = "choices";
const VALIDITY: &str = "validity";
pub(crate) const SETS: &str = "sets";
/// What joins a model, and the models that have it.
pub(crate) const PARTS: &str = "parts";
pub(crate) const JOINED: &str = "joined";
/// What is emitted is decided when the models are generated.
const EMIT: &str = "emit";
const BOX_KEYS: [&str; 3] = ["min", "max", "unit"];

/// Advice for what the models of the package do not have.
pub(crate) const GENERATE: &str =
    "a table with other entries is made into models by `ahv generate`";

/// Reads what a family has.
pub(crate) struct Reader<'a> {
    pub(crate) entries: Entries<'a>,
    pub(crate) family: Family,
    pub(crate) table: &'static Table,
    pub(crate) models: Vec<&'static str>,
    /// The sections of the entries, in order, and whether they hold coefficients.
    pub(crate) sections: Vec<(&'static str, bool)>,
    /// Key of each entry as the table has it.
    pub(crate) keys: Vec<Option<&'a str>>,
    /// The table's own values.
    pub(crate) own: Vec<Option<Quantity>>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(entries: Entries<'a>, family: Family, models: Vec<&'static str>) -> Self {
        let table = family.table;
        let mut sections: Vec<(&str, bool)> = Vec::new();
        for entry in table.entries {
            let wanted = entry.kind != EntryKind::Switch && Table::has(entry.models, &models);
            if wanted && !sections.iter().any(|(known, _)| *known == entry.section) {
                sections.push((entry.section, entry.kind != EntryKind::Parameter));
            }
        }
        Self {
            entries,
            family,
            table,
            models,
            sections,
            keys: vec![None; table.entries.len()],
            own: vec![None; table.entries.len()],
        }
    }

    pub(crate) fn read(mut self, own_set: String) -> Result<Checked, Vec<Fault>> {
        let choices = self.table.choices.iter();
        let choices: Vec<&Choice> = choices.filter(|it| self.has_choice(it)).collect();
        let mut known = vec![
            HEADER, SOURCES, CHOICES, VALIDITY, SETS, PARTS, JOINED, EMIT,
        ];
        known.retain(|name| *name != CHOICES || !choices.is_empty());
        known.extend(self.sections.iter().map(|(name, _)| name));
        let root = self.entries.text.root();
        self.entries.only("unknown-section", &[], root, &known);
        for (section, is_polynomial) in self.sections.clone() {
            match is_polynomial {
                true => self.polynomial(section),
                false => self.group(section),
            }
        }
        self.joins();
        let choices = self.choices(&choices);
        let validity = self.validity();
        let further = self.sets(&own_set);
        self.rules(&further);
        if !self.entries.faults.is_empty() {
            return Err(self.entries.faults);
        }
        let own = Set {
            name: own_set,
            entries: self.own,
        };
        let sets = std::iter::once(own).chain(further);
        Ok(Checked {
            models: self.models,
            unit_system: self.entries.system,
            sets: sets.collect(),
            choices,
            validity,
        })
    }

    fn has_choice(&self, choice: &Choice) -> bool {
        let mut entries = self.table.entries.iter();
        entries.any(|it| {
            it.kind == EntryKind::Switch
                && it.key == choice.name
                && Table::has(it.models, &self.models)
        })
    }

    /// The indices of the entries of a section.
    pub(crate) fn indices(&self, section: &str) -> Vec<usize> {
        let entries = self.table.entries.iter().enumerate();
        let wanted = entries.filter(|(_, entry)| {
            let own = entry.section == section && entry.kind != EntryKind::Switch;
            own && Table::has(entry.models, &self.models)
        });
        wanted.map(|(index, _)| index).collect()
    }

    /// Reads entry `index`, whose key the table writes as `key`.
    fn take(&mut self, index: usize, section: &'static str, key: &'a str) {
        let expected = self.expected(index);
        self.keys[index] = Some(key);
        self.own[index] = self.entries.entry(&[section, key], expected);
    }

    /// The unit of entry `index` in the system of the table.
    pub(crate) fn expected(&self, index: usize) -> &'static str {
        let units = match self.entries.system {
            SI => self.family.si_units,
            _ => self.family.units,
        };
        units.get(index).copied().unwrap_or("1")
    }

    /// The parameters of a section.
    fn group(&mut self, section: &'static str) {
        let Some(content) = self.entries.section(section) else {
            return;
        };
        let indices = self.indices(section);
        let known: Vec<&str> = indices
            .iter()
            .map(|&it| self.table.entries[it].key)
            .collect();
        self.entries
            .only("unknown-key", &[section], content, &known);
        for index in indices {
            let entry = self.table.entries[index];
            match content.get(entry.key) {
                Some(_) => self.take(index, section, entry.key),
                None => self.missing(section, entry.key, entry.doc, ""),
            }
        }
    }

    fn missing(&mut self, section: &str, key: &str, doc: &str, help: &str) {
        let doc = match doc {
            "" => String::new(),
            doc => format!(" ({doc})"),
        };
        let message = format!("`{key}`{doc} is missing in `[{section}]`");
        self.entries.key("missing", &[section], &message, help);
    }

    /// The coefficients of a polynomial.
    fn polynomial(&mut self, section: &'static str) {
        let Some(content) = self.entries.section(section) else {
            return;
        };
        if content.is_empty() {
            let message = format!("`[{section}]` has no coefficient");
            self.entries.key("no-coefficient", &[section], &message, "");
            return;
        }
        let indices = self.indices(section);
        let mut seen: Vec<(&str, Powers<'_>)> = Vec::new();
        for (key, _) in content.iter() {
            let Some(monomial) = self.monomial(section, key) else {
                continue;
            };
            let path = [section, key];
            if let Some((other, _)) = seen.iter().find(|(_, known)| *known == monomial) {
                let message = format!("`{key}` is the same monomial as `{other}`");
                self.entries.key("duplicate-monomial", &path, &message, "");
                continue;
            }
            let mut of_key = indices.iter().copied();
            let index =
                of_key.find(|&it| powers(self.table.entries[it].key).as_ref() == Some(&monomial));
            seen.push((key, monomial));
            match index {
                Some(index) => self.take(index, section, key),
                None => {
                    let message =
                        format!("the models have no coefficient of `{key}` in `[{section}]`");
                    self.entries
                        .key("needs-generation", &path, &message, GENERATE);
                }
            }
        }
        for index in indices {
            let entry = self.table.entries[index];
            if entry.kind == EntryKind::RequiredCoefficient && self.keys[index].is_none() {
                self.missing(section, entry.key, entry.doc, "");
            }
        }
    }

    /// The monomial that a key of a polynomial is, if it may be one.
    fn monomial<'k>(&mut self, section: &str, key: &'k str) -> Option<Powers<'k>> {
        let fit = self.table.fits.iter().find(|fit| fit.section == section)?;
        let read = powers_in(key, fit);
        if let Err((rule, message, help)) = &read {
            self.entries.key(rule, &[section, key], message, help);
        }
        read.ok()
    }

    fn choices(&mut self, choices: &[&'static Choice]) -> Vec<&'static ChoiceOption> {
        let content = match choices {
            [] => None,
            _ => self.entries.section(CHOICES),
        };
        let Some(content) = content else {
            return Vec::new();
        };
        let known: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
        self.entries
            .only("unknown-choice", &[CHOICES], content, &known);
        let mut chosen = Vec::new();
        for choice in choices {
            let known: Vec<&str> = choice.options.iter().map(|option| option.name).collect();
            let Some(item) = content.get(choice.name) else {
                let help = format!("choose one of `{}`", known.join("`, `"));
                self.missing(CHOICES, choice.name, "", &help);
                continue;
            };
            let option = item.as_str().and_then(|name| choice.option(name));
            if option.is_none() {
                let text = shown(item);
                let message = format!("`{text}` is not an option of `{}`", choice.name);
                let path = [CHOICES, choice.name];
                self.entries.value(
                    "unknown-option",
                    &path,
                    &message,
                    &suggestion(&text, &known),
                );
            }
            chosen.extend(option);
        }
        chosen
    }

    fn validity(&mut self) -> Vec<Option<Bounds>> {
        let intervals = self.table.validity;
        let Some(content) = self.entries.section(VALIDITY) else {
            return vec![None; intervals.len()];
        };
        let wanted: Vec<bool> = intervals
            .iter()
            .map(|it| Table::has(it.models, &self.models))
            .collect();
        let known = intervals.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
        let known: Vec<&str> = known.map(|(interval, _)| interval.name).collect();
        self.entries
            .only("unknown-key", &[VALIDITY], content, &known);
        let mut found = Vec::new();
        for (interval, wanted) in intervals.iter().zip(wanted) {
            let item = content.get(interval.name).filter(|_| wanted);
            if item.is_none() && wanted {
                self.missing(VALIDITY, interval.name, "", "");
            }
            found.push(item.and_then(|item| self.interval(interval, item)));
        }
        found
    }

    /// An interval, with angles in rad.
    fn interval(&mut self, interval: &Interval, item: &Item) -> Option<Bounds> {
        let path = [VALIDITY, interval.name];
        let entries = &mut self.entries;
        let Some(content) = item.as_table_like() else {
            let message = "a range is a table like { min = -5.0, max = 5.0, unit = \"deg\" }";
            entries.value("shape", &path, message, "");
            return None;
        };
        entries.only("unknown-key", &path, content, &BOX_KEYS);
        for key in BOX_KEYS
            .into_iter()
            .filter(|key| content.get(key).is_none())
        {
            entries.key("missing", &path, &format!("`{key}` is missing"), "");
        }
        let (min, max, unit) = (
            content.get("min")?,
            content.get("max")?,
            content.get("unit")?,
        );
        let min = entries.number(min, &[VALIDITY, interval.name, "min"]);
        let max = entries.number(max, &[VALIDITY, interval.name, "max"]);
        if min.zip(max).is_some_and(|(min, max)| min >= max) {
            let path = [VALIDITY, interval.name, "min"];
            entries.value("range", &path, "`min` must be below `max`", "");
        }
        let expected = match entries.system {
            SI => unit::si_name(interval.unit),
            _ => interval.unit.to_owned(),
        };
        let path = [VALIDITY, interval.name, "unit"];
        let degrees = entries.unit(unit, &path, &expected)?;
        let [min, max] = [min?, max?].map(|end| unit::in_radians(end, degrees));
        Some(Bounds::new(min, max))
    }
}
