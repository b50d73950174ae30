//! What a simulation tells when it is done.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

use ahv_core::{Outside, Vector};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::grid::Grid;
use crate::assignment::show;
use crate::failure::{Failure, complain, print};
use crate::units::Units;

/// The first departure from the validity box.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    pub(super) time: f64,
    pub(super) outside: Outside,
}

/// A finished simulation.
pub(super) struct Report<'a, X, U> {
    pub(super) model: &'static str,
    pub(super) set: &'static str,
    pub(super) choices: &'a [(&'static str, Option<&'static str>)],
    pub(super) units: Units,
    pub(super) grid: &'a Grid,
    pub(super) seed: Option<u64>,
    pub(super) initial_state: X,
    pub(super) final_state: X,
    pub(super) input: U,
    pub(super) out: &'a Path,
    pub(super) departure: Option<Departure>,
    pub(super) input_outside: Option<Outside>,
}

#[derive(Serialize)]
struct Json<'a> {
    model: &'static str,
    set: &'static str,
    choices: Pairs<'a, Option<&'static str>>,
    unit_system: &'static str,
    steps: u64,
    t_end: f64,
    dt: f64,
    seed: Option<u64>,
    initial_state: Pairs<'a, f64>,
    final_state: Pairs<'a, f64>,
    input: Pairs<'a, f64>,
    units: Pairs<'a, &'static str>,
    out: String,
    left_validity_box: Option<JsonDeparture>,
    input_outside_validity_box: Option<JsonInput>,
}

#[derive(Serialize)]
struct JsonDeparture {
    time: f64,
    state: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct JsonInput {
    input: &'static str,
    value: f64,
}

/// Pairs in their own order, as a JSON object.
struct Pairs<'a, V: Clone>(Cow<'a, [(&'static str, V)]>);

impl<V: Serialize + Clone> Serialize for Pairs<'_, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in self.0.iter() {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<X: Vector<f64>, U: Vector<f64>> Report<'_, X, U> {
    /// Warns of departures from the validity box, then tells the outcome on stdout.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if stdout cannot be written.
    pub(super) fn tell(&self, json: bool) -> Result<(), Failure> {
        if let Some(outside) = &self.input_outside {
            let place = describe_outside::<U>(outside, self.units);
            complain(&format!(
                "warning: the input {place}; the model is not valid there"
            ));
        }
        if let Some(Departure { time, outside }) = &self.departure {
            let place = describe_outside::<X>(outside, self.units);
            complain(&format!(
                "warning: at {time} s {place}; the model is not valid from there on"
            ));
        }
        print(&if json { self.json()? } else { self.text() })
    }

    fn json(&self) -> Result<String, Failure> {
        let units = [units::<X>(self.units), units::<U>(self.units)].concat();
        let pairs = |components: Vec<_>| Pairs(Cow::Owned(components));
        let json = Json {
            model: self.model,
            set: self.set,
            choices: Pairs(Cow::Borrowed(self.choices)),
            unit_system: self.units.name(),
            steps: self.grid.steps,
            t_end: self.grid.t_end,
            dt: self.grid.dt,
            seed: self.seed,
            initial_state: pairs(components(&self.initial_state)),
            final_state: pairs(components(&self.final_state)),
            input: pairs(components(&self.input)),
            units: Pairs(Cow::Owned(units)),
            out: self.out.display().to_string(),
            left_validity_box: self
                .departure
                .map(|Departure { time, outside }| JsonDeparture {
                    time,
                    state: outside.name,
                    value: outside.value,
                }),
            input_outside_validity_box: self
                .input_outside
                .map(|Outside { name, value, .. }| JsonInput { input: name, value }),
        };
        serde_json::to_string_pretty(&json)
            .map_err(|error| Failure::Numeric(format!("cannot write the outcome as JSON: {error}")))
    }

    fn text(&self) -> String {
        let Grid {
            steps, t_end, dt, ..
        } = self.grid;
        let seed = self
            .seed
            .map_or_else(String::new, |seed| format!(", seed {seed}"));
        let plural = if *steps == 1 { "step" } else { "steps" };
        format!(
            "{}: {steps} {plural} of {dt} s to {t_end} s{seed}, written to {}\n{}\nheld:\n{}\nat the end:\n{}",
            self.model,
            self.out.display(),
            self.condition(),
            describe(&self.input, self.units),
            describe(&self.final_state, self.units)
        )
    }

    /// What flew: parameters and choices.
    fn condition(&self) -> String {
        let mut text = format!("set {}", self.set);
        for (name, chosen) in self.choices {
            // Writing into a String cannot fail.
            let _ = write!(text, ", {name} {}", chosen.unwrap_or("of the table"));
        }
        text
    }
}

/// One line for each component, in units for a person.
pub(super) fn describe<V: Vector<f64>>(vector: &V, units: Units) -> String {
    let mut text = String::new();
    for ((name, value), unit) in components(vector).into_iter().zip(units.labels::<V>()) {
        let separator = if text.is_empty() { "" } else { "\n" };
        // Writing into a String cannot fail.
        let _ = write!(text, "{separator}  {name:<12} {}", show(value, unit));
    }
    text
}

fn describe_outside<V: Vector<f64>>(
    Outside {
        name,
        value,
        bounds,
    }: &Outside,
    units: Units,
) -> String {
    let unit = units.label::<V>(name);
    let [value, min, max] = [*value, bounds.min, bounds.max].map(|number| show(number, unit));
    format!("{name} is {value}, outside its validity box of {min} to {max}")
}

fn components<V: Vector<f64>>(vector: &V) -> Vec<(&'static str, f64)> {
    V::NAMES
        .iter()
        .enumerate()
        .filter_map(|(index, &name)| Some((name, vector.get(index)?)))
        .collect()
}

fn units<V: Vector<f64>>(units: Units) -> Vec<(&'static str, &'static str)> {
    let labels = units.labels::<V>().iter().copied();
    V::NAMES.iter().copied().zip(labels).collect()
}
