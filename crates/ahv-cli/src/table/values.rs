//! The values of a table for a model.

use ahv_core::{Bounds, Vector};
use toml_edit::{Item, TableLike};

use super::Table;
use crate::condition::Values;
use crate::failure::Failure;
use crate::names;
use crate::units::Units;
use crate::vehicle::FlightModel;

/// Sections that hold no values of parameters.
const OTHER_SECTIONS: [&str; 5] = ["table", "sources", "choices", "validity", "sets"];

/// Sections whose keys are parameters, with these; a name without its number stands for all modes. Keys of all other
/// sections are monomials.
const PARAMETERS: [(&str, &[&str]); 4] = [
    ("vehicle", &["m", "i_yy", "s", "c_bar", "z_t"]),
    ("environment", &["rho_0", "h_0", "h_s", "g", "r_e"]),
    ("modes", &["omega", "zeta", "psi"]),
    (
        "noise",
        &[
            "sigma",
            "w_gamma",
            "w_alpha",
            "w_q",
            "gust_rms",
            "gust_time",
        ],
    ),
];

/// Order of the variables in the name of a monomial's coefficient; flexible coordinates follow by number.
const VARIABLES: [&str; 4] = ["phi", "alpha", "delta_e", "delta_c"];

/// Parameters that a model divides by, or takes the root of; `omega` and `zeta` stand for those of all modes.
const POSITIVE: [&str; 10] = [
    "m",
    "i_yy",
    "s",
    "c_bar",
    "rho_0",
    "h_s",
    "r_e",
    "gust_time",
    "omega",
    "zeta",
];

/// Parameters as they are read.
struct Reading<'a, P> {
    table: &'a Table,
    units: Units,
    /// Whether values are divided by their factor to SI.
    from_si: bool,
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
    pub(crate) fn values<M: FlightModel>(&self, set: Option<&str>) -> Result<Values<M>, Failure> {
        self.check_model::<M>()?;
        let (units, built_in) = (self.units()?, Units::of_table(M::UNIT_SYSTEM));
        if units == Units::FootSlug && built_in == Units::Si {
            let message = "the models were generated in si, and take no table in ft-slug-s-rad";
            return Err(self.fault(&["table", "units"], message));
        }
        let mut reading = Reading {
            table: self,
            units,
            from_si: units != built_in,
            parameters: M::Parameters::splat(0.0),
            uncertainty: M::Parameters::splat(0.0),
            given: vec![false; M::Parameters::LEN],
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
        if let Some(contradiction) = M::contradiction(&parameters) {
            return Err(Failure::Request(format!("{}: {contradiction}", self.shown)));
        }
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

    fn check_model<M: FlightModel>(&self) -> Result<(), Failure> {
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
    fn chosen<M: FlightModel>(&self, parameters: M::Parameters) -> Result<M::Parameters, Failure> {
        M::CHOICES
            .iter()
            .try_fold(parameters, |parameters, choice| {
                let path = ["choices", choice.name];
                let option = self.word(&path)?;
                (choice.make)(parameters, option).ok_or_else(|| {
                    let problem = names::unknown(choice.name, option, &(choice.options)());
                    self.fault(&path, &problem)
                })
            })
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
        let name = if PARAMETERS.iter().any(|(own, _)| *own == section) {
            Some(key.to_lowercase())
        } else {
            coefficient(section, key)
        };
        let named = name.and_then(|name| P::index_of(&name));
        let Some(index) = named else {
            return Err(self.table.key_fault(path, &unknown::<P>(section, key)));
        };
        let (expected, factor) = scale::<P, f64>(index, self.units, self.from_si);
        let value = self.table.number(&[path, &["value"]].concat())?;
        self.table.unit(path, expected, false)?;
        let name = P::NAMES.get(index).copied().unwrap_or_default();
        if listed(&POSITIVE, name) && value <= 0.0 {
            let message = format!("`{key}` must be positive");
            return Err(self.table.fault(&[path, &["value"]].concat(), &message));
        }
        self.parameters.set(index, value * factor);
        self.uncertainty.set(index, self.table.uncertainty(path)?);
        if let Some(given) = self.given.get_mut(index) {
            *given = true;
        }
        Ok(())
    }

    /// A coefficient that is not listed is 0; a parameter that the model uses must be listed.
    fn check_complete<M: FlightModel<Parameters = P>>(&self) -> Result<(), Failure> {
        let Some((_, nominal)) = M::SETS.first() else {
            return Ok(());
        };
        let uses = |index| {
            let mut other = *nominal;
            other.set(index, nominal.get(index).unwrap_or(0.0) + 1.0);
            M::with_parameters(&other) != M::with_parameters(nominal)
        };
        for (index, name) in P::NAMES.iter().enumerate() {
            let section = PARAMETERS.iter().find(|(_, names)| listed(names, name));
            let missing = self.given.get(index) == Some(&false);
            if let Some((section, _)) = section.filter(|_| missing && uses(index)) {
                let message = format!("`{name}` is missing in `[{section}]`");
                return Err(self.table.fault(&[section], &message));
            }
        }
        Ok(())
    }
}

/// Whether `name`, or what is left of it without the number of a mode, is among `names`.
fn listed(names: &[&str], name: &str) -> bool {
    let kind = name.trim_end_matches(|c: char| c.is_ascii_digit());
    names.contains(&name)
        || kind
            .strip_suffix('_')
            .is_some_and(|kind| names.contains(&kind))
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

/// The name of the coefficient of a monomial; `None` if `key` is none.
fn coefficient(quantity: &str, key: &str) -> Option<String> {
    let quantity = quantity.to_lowercase();
    if key == "1" {
        return Some(format!("{quantity}_0"));
    }
    let mut powers: Vec<(usize, &str, u32)> = Vec::new();
    for factor in key.split('*') {
        let (name, exponent) = factor
            .trim()
            .split_once('^')
            .unwrap_or((factor.trim(), "1"));
        let exponent: u32 = exponent.parse().ok()?;
        match powers.iter_mut().find(|(_, own, _)| *own == name) {
            Some((_, _, own)) => *own = own.checked_add(exponent)?,
            None => {
                let known = VARIABLES.iter().position(|&variable| variable == name);
                let rank = match known {
                    Some(rank) => rank,
                    None => {
                        let mode: usize = name.strip_prefix("eta_")?.parse().ok()?;
                        mode.checked_add(VARIABLES.len())?
                    }
                };
                powers.push((rank, name, exponent));
            }
        }
    }
    powers.sort_unstable();
    let parts = powers
        .into_iter()
        .map(|(_, name, exponent)| match exponent {
            1 => name.to_owned(),
            _ => format!("{name}_{exponent}"),
        });
    Some(format!(
        "{quantity}_{}",
        parts.collect::<Vec<_>>().join("_")
    ))
}

/// The key of a monomial, of what its coefficient's name has after the quantity: `phi*alpha^3` of `phi_alpha_3`.
fn monomial(suffix: &str) -> String {
    if suffix == "0" {
        return "1".to_owned();
    }
    let (mut factors, mut rest) = (Vec::new(), suffix);
    while !rest.is_empty() {
        let eta = rest
            .strip_prefix("eta_")
            .and_then(|after| after.split('_').next());
        let eta = eta.map(|number| "eta_".len() + number.len());
        let known = VARIABLES.iter().find(|name| rest.starts_with(**name));
        let Some(length) = eta.or(known.map(|name| name.len())) else {
            return suffix.to_owned();
        };
        let (name, after) = rest.split_at(length);
        rest = after.trim_start_matches('_');
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (exponent, after) = rest.split_at(digits);
        rest = after.trim_start_matches('_');
        factors.push(match exponent {
            "" => name.to_owned(),
            exponent => format!("{name}^{exponent}"),
        });
    }
    factors.join("*")
}

/// What to say of an entry that the models have no parameter for.
fn unknown<P: Vector<f64>>(section: &str, key: &str) -> String {
    if let Some((_, names)) = PARAMETERS.iter().find(|(own, _)| *own == section) {
        let known: Vec<&str> = P::NAMES
            .iter()
            .copied()
            .filter(|name| listed(names, name))
            .collect();
        return names::unknown("parameter", key, &known);
    }
    let quantity = format!("{}_", section.to_lowercase());
    let suffixes = P::NAMES
        .iter()
        .filter_map(|name| name.strip_prefix(quantity.as_str()));
    let known: Vec<String> = suffixes.map(monomial).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let problem = match known.as_slice() {
        [] => format!("the models have no quantity `{section}`"),
        _ if key == "0" => format!(
            "unknown monomial `0`; the constant part has the key `1`. Known: {}",
            known.join(", ")
        ),
        known => names::unknown("monomial", key, known),
    };
    format!(
        "{problem}. The models were generated without it: a table with other monomials or modes is made into models by `ahv generate`"
    )
}
