//! The values of a table for a model.

use std::collections::BTreeMap;

use ahv_core::{Bounds, Entry, GeneratedModel, ParameterSet, Vector};
use toml_edit::{Item, TableLike};

use super::Table;
use crate::failure::Failure;
use crate::names;
use crate::units::Units;
use crate::vehicle::Values;

/// Sections that hold no values of parameters.
const OTHER_SECTIONS: [&str; 5] = ["table", "sources", "choices", "validity", "sets"];

/// Parameters as they are read.
struct Reading<'a, P> {
    table: &'a Table,
    units: Units,
    /// Whether values are divided by their factor to SI.
    from_si: bool,
    entries: &'static [Entry],
    parameters: P,
    uncertainty: P,
    given: Vec<bool>,
}

impl Table {
    /// The table's values for the model `M` and the set called `set`, or its own.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] with the place of what the model cannot take.
    pub(crate) fn values<M: GeneratedModel>(
        &self,
        set: Option<&str>,
    ) -> Result<Values<M>, Failure> {
        self.check_model::<M>()?;
        let (units, built_in) = (self.units()?, Units::of_table(M::TABLE.unit_system));
        if units == Units::FootSlug && built_in == Units::Si {
            let message = "the models were generated in si, and take no table in ft-slug-s-rad";
            return Err(self.fault(&["table", "units"], message));
        }
        let mut reading = Reading {
            table: self,
            units,
            from_si: units != built_in,
            entries: M::TABLE.entries,
            parameters: M::ParametersOf::<f64>::splat(0.0),
            uncertainty: M::ParametersOf::<f64>::splat(0.0),
            given: vec![false; M::ParametersOf::<f64>::LEN],
        };
        reading.sections(&[], self.document.as_table())?;
        reading.check_complete::<M>()?;
        let own = self.word(&["table", "set"])?;
        let letters = |letter: char| {
            letter.is_ascii_lowercase() || letter.is_ascii_digit() || "._-".contains(letter)
        };
        if !own.starts_with(|letter: char| letter.is_ascii_lowercase()) || !own.chars().all(letters)
        {
            let message = "`set` must name the table's own parameter set, in lower-case letters, digits, `.`, `_`, `-`";
            return Err(self.fault(&["table", "set"], message));
        }
        let set = set.unwrap_or(own);
        if set != own {
            reading.sections(&["sets", set], self.further_set(set, own)?)?;
        }
        let parameters = self.chosen::<M>(reading.parameters)?;
        self.check_rules::<M>(&parameters, set, own)?;
        let from_si = reading.from_si;
        Ok(Values {
            set: set.to_owned().into(),
            parameters,
            uncertainty: reading.uncertainty,
            state_bounds: self.bounds(M::STATE_BOUNDS, units, from_si)?,
            input_bounds: self.bounds(M::INPUT_BOUNDS, units, from_si)?,
        })
    }

    /// The relative uncertainty of the entry at `path`: its own, or that of the table.
    fn uncertainty(&self, path: &[&str]) -> Result<f64, Failure> {
        let own = [path, &["uncertainty"]].concat();
        let path = match self.item(&own) {
            Some(_) => own.as_slice(),
            None => &["table", "uncertainty"],
        };
        let uncertainty = self.number(path)?;
        if uncertainty < 0.0 {
            return Err(self.fault(path, "a relative uncertainty is not negative"));
        }
        Ok(uncertainty)
    }

    fn check_model<M: GeneratedModel>(&self) -> Result<(), Failure> {
        let path = ["table", "models"];
        let models = self.item(&path).and_then(Item::as_array);
        let mut models = models.into_iter().flatten().filter_map(|it| it.as_str());
        if models.any(|model| model == M::NAME) {
            return Ok(());
        }
        Err(self.fault(&path, &format!("the table is not for {}", M::NAME)))
    }

    fn further_set(&self, name: &str, own: &str) -> Result<&dyn TableLike, Failure> {
        let sets = self.item(&["sets"]).and_then(Item::as_table_like);
        let found = sets.and_then(|sets| sets.get(name)?.as_table_like());
        found.ok_or_else(|| {
            let others = sets.into_iter().flat_map(|sets| sets.iter());
            let known: Vec<&str> = std::iter::once(own).chain(others.map(|it| it.0)).collect();
            let problem = names::unknown("set of parameters", name, &known);
            Failure::Request(format!("--set: {problem} (in {})", self.shown))
        })
    }

    /// `parameters` with the table's choices made.
    fn chosen<M: GeneratedModel>(
        &self,
        parameters: M::ParametersOf<f64>,
    ) -> Result<M::ParametersOf<f64>, Failure> {
        M::TABLE
            .choices
            .iter()
            .try_fold(parameters, |parameters, choice| {
                let path = ["choices", choice.name];
                let name = self.word(&path)?;
                let option = choice.option(name).ok_or_else(|| {
                    let known: Vec<&str> =
                        choice.options.iter().map(|option| option.name).collect();
                    self.fault(&path, &names::unknown(choice.name, name, &known))
                })?;
                Ok(option.apply(parameters))
            })
    }

    /// Holds parameters of the set `set` against the rules of the table.
    fn check_rules<M: GeneratedModel>(
        &self,
        parameters: &M::ParametersOf<f64>,
        set: &str,
        own: &str,
    ) -> Result<(), Failure> {
        let Some(rule) = M::TABLE.rules.iter().find(|rule| !rule.holds(parameters)) else {
            return Ok(());
        };
        let first = rule.terms.first().and_then(|term| term.parameters.first());
        let index = first.and_then(|name| M::ParametersOf::<f64>::index_of(name));
        let Some(Entry { section, key, .. }) = index.and_then(|index| M::TABLE.entries.get(index))
        else {
            return Err(Failure::Request(format!("{}: {}", self.shown, rule.reason)));
        };
        let replaced = ["sets", set, section, key, "value"];
        let path: &[&str] = match set != own && self.item(&replaced).is_some() {
            true => &replaced,
            false => &replaced[2..],
        };
        Err(self.fault(path, rule.reason))
    }

    /// The table's intervals for the components of `built_in`.
    fn bounds<B: Vector<Bounds>>(
        &self,
        built_in: B,
        units: Units,
        from_si: bool,
    ) -> Result<B, Failure> {
        let mut bounds = built_in;
        for (index, name) in B::NAMES.iter().enumerate() {
            // eta_1, eta_2 … share the interval of eta.
            let key = name.trim_end_matches(|c: char| c.is_ascii_digit());
            let path = ["validity", key.trim_end_matches('_')];
            let (expected, factor) = scale::<B, Bounds>(index, units, from_si);
            let factor = factor * self.unit(&path, expected, true)?;
            let [min, max] = ["min", "max"].map(|end| self.number(&[path[0], path[1], end]));
            let (min, max) = (min? * factor, max? * factor);
            if min > max {
                return Err(self.fault(&path, "`min` exceeds `max`"));
            }
            bounds.set(index, Bounds::new(min, max));
        }
        Ok(bounds)
    }
}

impl<P: Vector<f64>> Reading<'_, P> {
    /// Reads the entries of `sections`, which stand at `prefix`.
    fn sections(&mut self, prefix: &[&str], sections: &dyn TableLike) -> Result<(), Failure> {
        for (section, item) in sections
            .iter()
            .filter(|(name, _)| !OTHER_SECTIONS.contains(name))
        {
            let path = [prefix, &[section]].concat();
            let entries = item.as_table_like().ok_or_else(|| {
                self.table.fault(
                    &path,
                    &format!("`{section}` should be a section of entries"),
                )
            })?;
            for (key, _) in entries.iter() {
                self.entry(&[path.as_slice(), &[key]].concat(), section, key)?;
            }
        }
        Ok(())
    }

    fn entry(&mut self, path: &[&str], section: &str, key: &str) -> Result<(), Failure> {
        let powers = monomial(key);
        let known = |entry: &Entry| {
            entry.section == section && (entry.key == key || monomial(entry.key) == powers)
        };
        let Some(index) = self.entries.iter().position(known) else {
            return Err(self.table.key_fault(path, &self.unknown(section, key)));
        };
        let (expected, factor) = scale::<P, f64>(index, self.units, self.from_si);
        let value = self.table.number(&[path, &["value"]].concat())?;
        self.table.unit(path, expected, false)?;
        self.parameters.set(index, value * factor);
        self.uncertainty.set(index, self.table.uncertainty(path)?);
        if let Some(given) = self.given.get_mut(index) {
            *given = true;
        }
        Ok(())
    }

    /// A coefficient that is not listed is 0; a parameter that the model uses must be listed.
    fn check_complete<M: GeneratedModel<ParametersOf<f64> = P>>(&self) -> Result<(), Failure> {
        let Some(ParameterSet { parameters, .. }) = M::SETS.first() else {
            return Ok(());
        };
        let uses = |index| {
            let mut other = *parameters;
            other.set(index, parameters.get(index).unwrap_or(0.0) + 1.0);
            M::with_parameters(&other) != M::with_parameters(parameters)
        };
        for (index, entry) in self.entries.iter().enumerate() {
            let is_monomial = monomial(entry.key).is_some();
            let missing = self.given.get(index) == Some(&false) && entry.section != "choices";
            if missing && !is_monomial && uses(index) {
                let (key, section) = (entry.key, entry.section);
                let message = format!("`{key}` is missing in `[{section}]`");
                return Err(self.table.fault(&[section], &message));
            }
        }
        Ok(())
    }

    /// What to say of an entry that the models have no parameter for.
    fn unknown(&self, section: &str, key: &str) -> String {
        let known = self.entries.iter().filter(|entry| entry.section == section);
        let known: Vec<&str> = known.map(|entry| entry.key).collect();
        let problem = match known.as_slice() {
            [] => format!("the models have no section `{section}`"),
            known => names::unknown("key", key, known),
        };
        format!(
            "{problem}. The models were generated without it: a table with other entries is made into models by `ahv generate`"
        )
    }
}

/// The unit of component `index` of a `V` in the system `units`, and the factor from there to the generated models.
fn scale<V: Vector<T>, T>(index: usize, units: Units, from_si: bool) -> (&'static str, f64) {
    let labels = match units {
        Units::FootSlug => V::UNITS,
        Units::Si => V::SI_UNITS,
    };
    let factor = V::SI_FACTORS.get(index).copied().unwrap_or(1.0);
    let unit = labels.get(index).copied().unwrap_or("1");
    (unit, if from_si { 1.0 / factor } else { 1.0 })
}

/// The powers of a monomial's variables by name; `None` if `key` is none.
fn monomial(key: &str) -> Option<BTreeMap<&str, u32>> {
    let mut powers = BTreeMap::new();
    if key == "1" {
        return Some(powers);
    }
    for factor in key.split('*') {
        let (name, exponent) = factor
            .trim()
            .split_once('^')
            .unwrap_or((factor.trim(), "1"));
        let exponent: u32 = exponent.parse().ok()?;
        let power: &mut u32 = powers.entry(name).or_default();
        *power = power.checked_add(exponent)?;
    }
    Some(powers)
}
