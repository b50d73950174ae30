//! A file of gains, as `ahv lqr --out` writes it and `--feedback` reads it.

use std::path::{Path, PathBuf};

use ahv_analysis::trim::SteadyState;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use sha2::{Digest, Sha256};

use crate::named::{Named, shown_as};
use crate::number::Shown;
use crate::table::text_of;
use crate::vehicle::Vehicle;

/// The only law that there is; t counts from the start of a flight.
pub(crate) const LAW: &str = "u = input - gain (x - state - state_rate t)";

/// Relative difference up to which two numbers of a flight condition are one.
const SAME: f64 = 1e-12;

/// A linear feedback about a trim, with everything that it was designed for. No key may lack, and no other one stand
/// beside them.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gains {
    pub(crate) model: String,
    pub(crate) table: Option<PathBuf>,
    pub(crate) set: String,
    pub(crate) choices: Named<Option<String>>,
    pub(crate) unit_system: String,
    /// Of names and values of all parameters.
    pub(crate) parameters_sha256: String,
    /// What was given of the trim; its names stand beside the other keys of the file.
    #[serde(skip)]
    pub(crate) condition: Named<f64>,
    pub(crate) law: String,
    /// Columns of the gain.
    pub(crate) states: Vec<String>,
    /// Rows of the gain.
    pub(crate) inputs: Vec<String>,
    pub(crate) units: Named<String>,
    /// State of the trim.
    pub(crate) state: Named<f64>,
    /// How it moves, per second.
    pub(crate) state_rate: Named<f64>,
    /// Input of the trim.
    pub(crate) input: Named<f64>,
    /// Other quantities of the trim, for a person to read.
    #[serde(default)]
    pub(crate) outputs: Named<f64>,
    /// By rows.
    pub(crate) gain: Vec<Vec<f64>>,
    /// Diagonals of Q and R.
    pub(crate) state_weight: Named<f64>,
    pub(crate) input_weight: Named<f64>,
    /// Of the closed loop, in 1/s.
    pub(crate) poles: Vec<[f64; 2]>,
    pub(crate) residual: f64,
}

/// A file of gains: what is given of the trim, then the rest.
#[derive(Serialize)]
pub(crate) struct GainsFile<'a> {
    #[serde(flatten)]
    pub(crate) condition: &'a Named<f64>,
    #[serde(flatten)]
    pub(crate) gains: &'a Gains,
}

impl Vehicle {
    /// SHA-256 of names and values of all parameters, in hexadecimal digits.
    pub(crate) fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        for (name, value) in self.model.parameters().names.iter().zip(&self.parameters) {
            hash.update(name.as_bytes());
            hash.update(value.to_le_bytes());
        }
        let digest = hash.finalize();
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The inputs that a trim does not seek, and where they are held.
    pub(crate) fn held(&self, flight: &SteadyState) -> Vec<(&'static str, f64)> {
        let sought = self.sought_inputs(flight);
        let held = self
            .inputs
            .names
            .iter()
            .filter(|name| !sought.contains(name));
        held.map(|&name| (name, flight.input_value(name))).collect()
    }

    /// The command that writes gains for this vehicle in this flight.
    fn design(&self, flight: &SteadyState) -> String {
        let mut command = format!("ahv lqr --model {}", self.name());
        if let Some(table) = &self.table {
            command += &format!(" --table {}", quoted(&table.display().to_string()));
        }
        command += &format!(" --set {} --units {}", quoted(&self.set), self.units.name());
        for (name, option) in &self.choices {
            if let Some(option) = option {
                command += &format!(" --{name} {option}");
            }
        }
        for (name, value) in flight.given() {
            let (_, value) = shown_as(name, value, self.unit(name));
            command += &format!(" --{} {value}", name.replace('_', "-"));
        }
        for (name, value) in self.held(flight) {
            if value != 0.0 {
                let unit = self.inputs.unit(name);
                let unit = if unit == "1" { "" } else { unit };
                command += &format!(" --input {name}={value}{unit}");
            }
        }
        command + " --out FILE"
    }
}

/// Names without their order, which an object in JSON has not.
fn sorted<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let mut names = names.to_vec();
    names.sort_unstable();
    names
}

/// The text of a file of gains without what is given of the trim, and that.
///
/// # Errors
///
/// What is wrong with the file.
fn split(text: &str, given: &[String]) -> Result<(String, Named<f64>), String> {
    let fault = |error: serde_json::Error| error.to_string();
    let keys: Named<Box<RawValue>> = serde_json::from_str(text).map_err(fault)?;
    let condition = given.iter().map(|name| {
        let found = keys.0.iter().find(|(known, _)| known == name);
        let (_, value) = found.ok_or_else(|| format!("missing field `{name}`"))?;
        let value: f64 = serde_json::from_str(value.get()).map_err(fault)?;
        Ok((name, value))
    });
    let condition = condition.collect::<Result<Vec<_>, String>>()?;
    let rest = keys.0.iter().filter(|(name, _)| !given.contains(name));
    let rest: Vec<String> = rest
        .map(|(name, value)| {
            format!(
                "{}: {}",
                serde_json::Value::from(name.as_str()),
                value.get()
            )
        })
        .collect();
    Ok((format!("{{{}}}", rest.join(", ")), Named::new(condition)))
}

/// The model of a file of gains, whatever else is wrong with it.
fn model_of(text: &str) -> Option<String> {
    let keys: serde_json::Value = serde_json::from_str(text).ok()?;
    Some(keys.get("model")?.as_str()?.to_owned())
}

/// An argument as a shell takes it for one word.
fn quoted(argument: &str) -> String {
    let plain = |it: char| it.is_alphanumeric() || "._-/+=:,@%".contains(it);
    if !argument.is_empty() && argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', r"'\''"))
    }
}

impl Gains {
    /// Reads the gains at `path` for a vehicle: their differences from what it flies are in [`Self::differences`].
    ///
    /// # Errors
    ///
    /// What is wrong with the file, and the command that writes a right one.
    pub(crate) fn read(
        path: &Path,
        vehicle: &Vehicle,
        flight: &SteadyState,
    ) -> Result<Self, String> {
        let text = text_of(path).map_err(|error| error.to_string())?;
        let given: Vec<String> = Named::given(vehicle, flight)
            .0
            .into_iter()
            .map(|it| it.0)
            .collect();
        let gains = split(&text, &given).and_then(|(rest, condition)| {
            let gains: Self = serde_json::from_str(&rest).map_err(|error| error.to_string())?;
            Ok(Self { condition, ..gains })
        });
        let checked = gains.and_then(|gains: Self| gains.check(vehicle, flight).map(|()| gains));
        checked.map_err(|what| {
            let what = match model_of(&text).filter(|model| model != vehicle.name()) {
                Some(model) => format!(
                    "its gains are of the model {model}, the flights of {}: {what}",
                    vehicle.name()
                ),
                None => what,
            };
            let command = vehicle.design(flight);
            format!("{what}; this command writes gains for these flights: {command}")
        })
    }

    /// What cannot be gains for this model.
    fn check(&self, vehicle: &Vehicle, flight: &SteadyState) -> Result<(), String> {
        if self.law != LAW {
            return Err(format!("its law is `{}`; known: `{LAW}`", self.law));
        }
        if self.unit_system != vehicle.units.name() {
            return Err(format!(
                "its gains are in {}, the flights in {}; see --units",
                self.unit_system,
                vehicle.units.name()
            ));
        }
        let (states, inputs) = (vehicle.states.names, vehicle.inputs.names);
        if self.states != states {
            return Err(format!(
                "its gains of {} are for the states {}; {} has {}, in this order",
                self.model,
                self.states.join(", "),
                vehicle.name(),
                states.join(", ")
            ));
        }
        let index = |name: &String| inputs.iter().position(|input| input == name);
        let places: Vec<_> = self.inputs.iter().map(index).collect();
        let ascend = places.windows(2).all(|pair| pair[0] < pair[1]);
        if places.is_empty() || places.contains(&None) || !ascend {
            return Err(format!(
                "its inputs are {}; {} has {}, each once and in this order",
                self.inputs.join(", "),
                vehicle.name(),
                inputs.join(", ")
            ));
        }
        self.check_sizes(vehicle)?;
        self.check_condition(vehicle, flight)
    }

    /// Lists that do not fit the names, and units of other quantities.
    fn check_sizes(&self, vehicle: &Vehicle) -> Result<(), String> {
        let (rows, columns) = (self.inputs.len(), self.states.len());
        let count = |what: &str, found: usize, expected: usize| match found == expected {
            true => Ok(()),
            false => Err(format!("{what}: {found}; there must be {expected}")),
        };
        count("rows of its gain", self.gain.len(), rows)?;
        for (input, row) in self.inputs.iter().zip(&self.gain) {
            count(&format!("gains of its row {input}"), row.len(), columns)?;
        }
        count("its poles", self.poles.len(), columns)?;
        let own: Vec<&str> = self.inputs.iter().map(String::as_str).collect();
        let (states, inputs) = (vehicle.states.names, vehicle.inputs.names);
        let all = [states, inputs].concat();
        for (key, found, expected) in [
            ("state", self.state.names(), states),
            ("state_rate", self.state_rate.names(), states),
            ("input", self.input.names(), inputs),
            ("state_weight", self.state_weight.names(), states),
            ("input_weight", self.input_weight.names(), own.as_slice()),
            ("units", self.units.names(), all.as_slice()),
        ] {
            if sorted(&found) != sorted(expected) {
                return Err(format!(
                    "its `{key}` has the names {}; right are {}",
                    found.join(", "),
                    expected.join(", ")
                ));
            }
        }
        let right = vehicle.point_units().0;
        let mut units = self.units.0.iter();
        let other = units.find(|(name, unit)| right.iter().any(|it| it.0 == name && it.1 != unit));
        match other {
            Some((name, unit)) => Err(format!(
                "its unit of {name} is `{unit}`; the flights have the units of {}",
                vehicle.units.name()
            )),
            None => Ok(()),
        }
    }

    /// The trim that the gains are about is of their condition: these states and outputs are given, not sought.
    fn check_condition(&self, vehicle: &Vehicle, flight: &SteadyState) -> Result<(), String> {
        for ((name, _), (_, value)) in flight.given().zip(&self.condition.0) {
            let mut known = self.state.0.iter().chain(&self.outputs.0);
            let Some((_, own)) = known.find(|(own, _)| own == name) else {
                continue;
            };
            let (_, own) = shown_as(name, *own, vehicle.unit(name));
            if (own - value).abs() > SAME * value.abs().max(1.0) {
                return Err(format!(
                    "its `state` is not of its flight condition: {name}"
                ));
            }
        }
        Ok(())
    }

    /// How these gains were designed for another vehicle or flight than this one; empty if they were not.
    pub(crate) fn differences(&self, vehicle: &Vehicle, flight: &SteadyState) -> Vec<String> {
        let mut differences = Vec::new();
        let mut text = |what: &str, own: &str, flown: &str| {
            if own != flown {
                differences.push(format!("{what} {own}, the flights {flown}"));
            }
        };
        text("model", &self.model, vehicle.name());
        text("set", &self.set, &vehicle.set);
        let option = |option: Option<&str>| option.unwrap_or("of the table").to_owned();
        for (name, chosen) in &vehicle.choices {
            let mut own = self.choices.0.iter();
            let own = own.find(|(own, _)| own == name);
            let own = own.and_then(|(_, chosen)| chosen.as_deref());
            text(name, &option(own), &option(*chosen));
        }
        let flown = Named::given(vehicle, flight);
        let mut pairs: Vec<(String, (f64, f64))> = Vec::new();
        for ((name, own), (_, flown)) in self.condition.0.iter().zip(&flown.0) {
            pairs.push((name.replace("_deg", " in deg"), (*own, *flown)));
        }
        for (name, flown) in vehicle.held(flight) {
            let own = self.input.values(&[name]).first().copied();
            pairs.push((name.to_owned(), (own.unwrap_or(0.0), flown)));
        }
        for (name, (own, flown)) in pairs {
            if (own - flown).abs() > SAME * own.abs().max(flown.abs()) {
                let [own, flown] = [own, flown].map(Shown);
                differences.push(format!("{name} {own}, the flights {flown}"));
            }
        }
        // The same words may stand for other values.
        let path = |table: Option<&Path>| match table {
            Some(path) => format!("of table {}", path.display()),
            None => "that the models were generated with".to_owned(),
        };
        let fingerprint = vehicle.fingerprint();
        if differences.is_empty() && self.parameters_sha256 != fingerprint {
            differences.push(format!(
                "parameters {} (SHA-256 {}), the flights those {} ({fingerprint})",
                path(self.table.as_deref()),
                self.parameters_sha256,
                path(vehicle.table.as_deref())
            ));
        }
        differences
    }

    /// What to do about such differences.
    pub(crate) fn remedy(vehicle: &Vehicle, flight: &SteadyState) -> String {
        format!(
            "choose the same for both, or let `{}` write new gains; --feedback-mismatch allow flies them all the same",
            vehicle.design(flight)
        )
    }
}
