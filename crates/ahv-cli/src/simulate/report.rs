//! What a simulation tells when it is done.

use std::fmt::Write;
use std::path::Path;

use ahv_core::{Outside, Vector};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::grid::Grid;
use crate::assignment::show;
use crate::failure::{Failure, complain, print};

/// The first departure from the validity box.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    pub(super) time: f64,
    pub(super) outside: Outside,
}

/// A finished simulation.
pub(super) struct Report<'a, X, U> {
    pub(super) model: &'static str,
    pub(super) grid: &'a Grid,
    pub(super) seed: Option<u64>,
    pub(super) final_state: X,
    pub(super) input: U,
    pub(super) out: &'a Path,
    pub(super) departure: Option<Departure>,
    pub(super) input_outside: Option<Outside>,
}

#[derive(Serialize)]
struct Json<S: Serialize, I: Serialize, N: Serialize> {
    model: &'static str,
    steps: u64,
    t_end: f64,
    dt: f64,
    seed: Option<u64>,
    final_state: S,
    input: I,
    units: N,
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
struct Pairs<V>(Vec<(&'static str, V)>);

impl<V: Serialize> Serialize for Pairs<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
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
            let place = describe_outside::<U>(outside);
            complain(&format!(
                "warning: the input {place}; the model is not valid there"
            ));
        }
        if let Some(Departure { time, outside }) = &self.departure {
            let place = describe_outside::<X>(outside);
            complain(&format!(
                "warning: at {time} s {place}; the model is not valid from there on"
            ));
        }
        print(&if json { self.json()? } else { self.text() })
    }

    fn json(&self) -> Result<String, Failure> {
        let units = units::<X>().chain(units::<U>()).collect();
        let json = Json {
            model: self.model,
            steps: self.grid.steps,
            t_end: self.grid.t_end,
            dt: self.grid.dt,
            seed: self.seed,
            final_state: Pairs(components(&self.final_state)),
            input: Pairs(components(&self.input)),
            units: Pairs(units),
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
            "{}: {steps} {plural} of {dt} s to {t_end} s{seed}, written to {}\n{}",
            self.model,
            self.out.display(),
            describe(&self.final_state)
        )
    }
}

/// One line for each component, in units for a person.
pub(super) fn describe<V: Vector<f64>>(vector: &V) -> String {
    let mut text = String::new();
    for ((name, value), unit) in components(vector).into_iter().zip(V::UNITS) {
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
) -> String {
    let unit = V::index_of(name)
        .and_then(|index| V::UNITS.get(index))
        .copied()
        .unwrap_or("1");
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

fn units<V: Vector<f64>>() -> impl Iterator<Item = (&'static str, &'static str)> {
    V::NAMES.iter().copied().zip(V::UNITS.iter().copied())
}
