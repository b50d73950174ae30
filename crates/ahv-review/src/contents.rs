//! The numbers of a table, read as far as they can be: what is wrong with them is reported by the check of the table.

use std::collections::BTreeMap;

use ahv_core::Fit;
use ahv_table::{Family, Powers, Text, Unit, degrees, in_radians, powers, si_name};
use toml_edit::{Item, TableLike, Value};

const HEADER: &str = "table";
const SETS: &str = "sets";
const SI: &str = "si";
/// Sections that hold no numbers of models.
const OTHERS: [&str; 7] = [
    HEADER, "sources", "choices", "validity", "parts", "joined", "emit",
];

/// A table with its numbers.
pub(crate) struct Contents<'a> {
    pub(crate) text: &'a Text,
    pub(crate) family: Family,
    pub(crate) system: &'a str,
    /// Entries of the table, then those of its sets, in their order.
    pub(crate) entries: Vec<Number<'a>>,
    /// Ends of the intervals of the validity box, angles in rad.
    pub(crate) validity: BTreeMap<&'a str, (f64, f64)>,
}

/// An entry of a table or of one of its sets.
pub(crate) struct Number<'a> {
    /// The set that it is part of; none for the table's own.
    pub(crate) set: Option<&'a str>,
    pub(crate) section: &'a str,
    pub(crate) key: &'a str,
    /// Its value, with angles in rad.
    pub(crate) value: f64,
    /// Its value and its unit as the table writes them.
    pub(crate) written: String,
    pub(crate) unit: &'a str,
    pub(crate) source: &'a str,
    pub(crate) status: &'a str,
    pub(crate) uncertainty: f64,
    /// Whether it has a source and a status of its own.
    pub(crate) has_own: [bool; 2],
    /// Its polynomial and its monomial, if it is a coefficient.
    pub(crate) term: Option<(&'static Fit, Powers<'a>)>,
}

impl<'a> Contents<'a> {
    pub(crate) fn read(text: &'a Text, family: Family) -> Self {
        let header = text.item(&[HEADER]).and_then(Item::as_table_like);
        let mut contents = Self {
            text,
            family,
            system: word(header, "units").unwrap_or_default(),
            entries: Vec::new(),
            validity: BTreeMap::new(),
        };
        for (section, item) in text.root().iter() {
            match (section, item.as_table_like()) {
                ("validity", Some(content)) => contents.intervals(content),
                (SETS, Some(sets)) => {
                    for (set, sections) in sets.iter() {
                        let sections = sections.as_table_like().into_iter();
                        for (section, item) in sections.flat_map(|it| it.iter()) {
                            contents.section(header, Some(set), section, item);
                        }
                    }
                }
                _ if OTHERS.contains(&section) => {}
                _ => contents.section(header, None, section, item),
            }
        }
        // A set replaces: what it does not name is the table's own, which comes first.
        contents.entries.sort_by_key(|entry| entry.set.is_some());
        contents
    }

    fn intervals(&mut self, content: &'a dyn TableLike) {
        for (name, item) in content.iter() {
            let ends = item.as_table_like();
            let turned = word(ends, "unit").and_then(degrees).unwrap_or(0);
            let end = |key| number(ends?.get(key)?).map(|it| in_radians(it, turned));
            if let (Some(min), Some(max)) = (end("min"), end("max")) {
                self.validity.insert(name, (min, max));
            }
        }
    }

    fn section(
        &mut self,
        header: Option<&'a dyn TableLike>,
        set: Option<&'a str>,
        section: &'a str,
        item: &'a Item,
    ) {
        let mut fits = self.family.table.fits.iter();
        let fit = fits.find(|fit| fit.section == section);
        for (key, item) in item.as_table_like().into_iter().flat_map(|it| it.iter()) {
            let Some(entry) = item.as_table_like() else {
                continue;
            };
            let Some((value, written)) = entry
                .get("value")
                .and_then(|it| Some((number(it)?, written(it)?)))
            else {
                continue;
            };
            let unit = word(Some(entry), "unit").unwrap_or("1");
            let own = |key| word(Some(entry), key);
            let stated = |key| own(key).or_else(|| word(header, key)).unwrap_or_default();
            let uncertainty = entry.get("uncertainty");
            let uncertainty = uncertainty.or_else(|| header?.get("uncertainty"));
            self.entries.push(Number {
                set,
                section,
                key,
                value: in_radians(value, degrees(unit).unwrap_or(0)),
                written,
                unit,
                source: stated("source"),
                status: stated("status"),
                uncertainty: uncertainty.and_then(number).unwrap_or(f64::NAN),
                has_own: ["source", "status"].map(|key| own(key).is_some()),
                term: fit.and_then(|fit| Some((fit, monomial(fit, key)?))),
            });
        }
    }

    /// The entries that stand in the table itself.
    pub(crate) fn own(&self) -> impl Iterator<Item = &Number<'a>> {
        self.entries.iter().filter(|entry| entry.set.is_none())
    }

    /// The parameter that an entry is the value of, as an index into [`Family::names`].
    pub(crate) fn parameter(&self, entry: &Number<'_>) -> Option<usize> {
        let mut known = self.family.table.entries.iter();
        known.position(|it| {
            let same = || powers(it.key).is_some_and(|own| Some(own) == powers(entry.key));
            let is_key = it.key == entry.key || entry.term.is_some() && same();
            it.section == entry.section && is_key
        })
    }

    /// The interval of a variable of a polynomial, angles in rad.
    pub(crate) fn interval(&self, fit: &Fit, variable: &str) -> Option<(f64, f64)> {
        let mut variables = fit.variables.iter();
        let found = variables.find(|it| it.name == variable)?;
        self.validity.get(found.interval?).copied()
    }

    /// The largest magnitude of a term over the validity box; `None` if a variable of its monomial is not bounded.
    pub(crate) fn largest(&self, entry: &Number<'_>) -> Option<f64> {
        Some(self.monomial(entry)? * entry.value.abs())
    }

    /// The same of the monomial by itself.
    pub(crate) fn monomial(&self, entry: &Number<'_>) -> Option<f64> {
        let (fit, powers) = entry.term.as_ref()?;
        powers.iter().try_fold(1.0, |product, (name, exponent)| {
            let (min, max) = self.interval(fit, name)?;
            let power = i32::try_from(*exponent).ok()?;
            Some(product * min.abs().max(max.abs()).powi(power))
        })
    }

    /// A unit of the family in the table's system, and what turns a value of the family into one of the table.
    pub(crate) fn converted(&self, unit: &str) -> (String, f64) {
        if self.system != SI || self.family.table.unit_system == SI {
            return (unit.to_owned(), 1.0);
        }
        let si = si_name(unit);
        let factor = Unit::parse(unit)
            .zip(Unit::parse(&si))
            .and_then(|(own, si)| own.in_terms_of(&si));
        (si, factor.unwrap_or(1.0))
    }
}

/// The models that a table lists.
#[must_use]
pub fn models(text: &Text) -> Vec<&str> {
    let listed = text.item(&[HEADER, "models"]);
    let listed = listed.and_then(Item::as_array).into_iter();
    listed.flatten().filter_map(|it| it.as_str()).collect()
}

impl<'a> Number<'a> {
    /// The keys under which it stands.
    pub(crate) fn path(&self) -> Vec<&'a str> {
        match self.set {
            Some(set) => vec![SETS, set, self.section, self.key],
            None => vec![self.section, self.key],
        }
    }
}

/// The monomial of a key, if its variables are those of the polynomial.
fn monomial<'k>(fit: &Fit, key: &'k str) -> Option<Powers<'k>> {
    let powers = powers(key)?;
    let known = |name: &str| fit.variables.iter().any(|it| it.name == name);
    powers.keys().all(|name| known(name)).then_some(powers)
}

fn word<'a>(table: Option<&'a dyn TableLike>, key: &str) -> Option<&'a str> {
    table?.get(key)?.as_str()
}

/// A number as the table writes it.
pub(crate) fn written(item: &Item) -> Option<String> {
    match item.as_value()? {
        Value::Integer(number) => Some(number.display_repr().into_owned()),
        Value::Float(number) => Some(number.display_repr().into_owned()),
        _ => None,
    }
}

fn number(item: &Item) -> Option<f64> {
    let whole = || item.as_integer().map(|it| it as f64);
    item.as_float().or_else(whole).filter(|it| it.is_finite())
}
