//! The table with the estimates.

use std::path::Path;

use ahv_table::{Edit, Text};

use super::Outcome;
use crate::failure::Failure;
use crate::names;
use crate::table::text_of;

/// Key of the source of the estimates.
const SOURCE: &str = "identify";

impl Outcome<'_> {
    /// The text of the table at `path` with the estimates in the set that was flown. Its other text stays as it is.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a parameter that the table has no number of, or 0.
    pub(super) fn table(&self, path: &Path, record: &Path) -> Result<String, Failure> {
        let shown = names::printable(&path.display().to_string());
        let failed = |why: &str| Failure::Request(format!("{shown}: {why}"));
        let text = text_of(path).map_err(|error| failed(&error.to_string()))?;
        let text = Text::parse(text).map_err(|error| failed(&error.to_string()))?;
        let mut edit = text.edit();
        let times = &self.problem.record.times;
        let file = record.file_name().map(|it| it.to_string_lossy());
        let source = format!(
            "ahv identify: {} of {} samples of {}, {} to {} s, in {} segments; uncertainties are standard errors",
            self.method.name(),
            times.len(),
            names::printable(&file.unwrap_or_default()),
            times.first().copied().unwrap_or_default(),
            times.last().copied().unwrap_or_default(),
            self.estimate.segments,
        );
        edit.text(&["sources", SOURCE], &source);
        for it in &self.estimate.parameters {
            let entry = &self.vehicle.model.table().entries[it.index];
            let own = [entry.section, entry.key];
            let of_set = ["sets", &self.vehicle.set, entry.section, entry.key];
            let in_set = text.item(&of_set).is_some();
            let place: &[&str] = if in_set { &of_set } else { &own };
            let old = text.item(&[place, &["value"]].concat());
            let old = old.and_then(|it| it.as_float().or(it.as_integer().map(|it| it as f64)));
            let before = self.vehicle.parameters[it.index];
            let old = old.filter(|old| *old != 0.0 && before != 0.0).ok_or_else(|| {
                failed(&format!(
                    "[{}] \"{}\" has no number other than 0, whose unit the estimate could be written in; start from another value",
                    entry.section, entry.key
                ))
            })?;
            // The ratio has no unit, whatever that of the table and that of the flight.
            let estimate = Entry {
                value: digits(old * (it.value / before), 9),
                uncertainty: digits(it.standard_error / it.value.abs(), 2),
            };
            estimate.write(&mut edit, place);
        }
        Ok(edit.into_text())
    }
}

struct Entry {
    value: f64,
    uncertainty: f64,
}

impl Entry {
    fn write(&self, edit: &mut Edit, place: &[&str]) {
        let at = |field| [place, &[field]].concat();
        edit.number(&at("value"), self.value);
        edit.text(&at("source"), SOURCE);
        edit.text(&at("status"), "derived");
        edit.number(&at("uncertainty"), self.uncertainty);
    }
}

/// So many significant digits of a value.
fn digits(value: f64, count: usize) -> f64 {
    let places = count.saturating_sub(1);
    format!("{value:.places$e}").parse().unwrap_or(value)
}
