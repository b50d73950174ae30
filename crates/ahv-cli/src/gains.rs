//! A file of gains, as `ahv lqr --out` writes it and `--feedback` reads it.

use std::fmt;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use ahv_analysis::trim::{SOUGHT_INPUTS, SteadyFlight};
use ahv_core::Vector;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use sha2::{Digest, Sha256};

use crate::condition::Vehicle;
use crate::number::Shown;
use crate::output::Pairs;
use crate::table::text_of;
use crate::vehicle::FlightModel;

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
    pub(crate) velocity: f64,
    pub(crate) altitude: f64,
    pub(crate) gamma_deg: f64,
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
    /// By rows.
    pub(crate) gain: Vec<Vec<f64>>,
    /// Diagonals of Q and R.
    pub(crate) state_weight: Named<f64>,
    pub(crate) input_weight: Named<f64>,
    /// Of the closed loop, in 1/s.
    pub(crate) poles: Vec<[f64; 2]>,
    pub(crate) residual: f64,
}

/// Values by name in their own order, each name once; an object in JSON.
pub(crate) struct Named<T>(pub(crate) Vec<(String, T)>);

impl<T> Named<T> {
    pub(crate) fn new<N: ToString>(pairs: impl IntoIterator<Item = (N, T)>) -> Self {
        let pairs = pairs.into_iter();
        Self(
            pairs
                .map(|(name, value)| (name.to_string(), value))
                .collect(),
        )
    }

    fn names(&self) -> Vec<&str> {
        self.0.iter().map(|(name, _)| name.as_str()).collect()
    }
}

impl Named<f64> {
    /// The components of a vector by name.
    pub(crate) fn of<V: Vector<f64>>(vector: &V) -> Self {
        Self::new(Pairs::of(vector).0)
    }

    /// The vector whose components these are; what has no name here is 0.
    pub(crate) fn vector<V: Vector<f64>>(&self) -> V {
        V::from_fn(|index| {
            let mut pairs = self.0.iter();
            let found = pairs.find(|(name, _)| V::NAMES.get(index) == Some(&name.as_str()));
            found.map_or(0.0, |&(_, value)| value)
        })
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Named<T>;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("values by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut pairs: Vec<(String, T)> = Vec::new();
                while let Some((name, value)) = map.next_entry::<String, T>()? {
                    if pairs.iter().any(|(known, _)| *known == name) {
                        return Err(A::Error::custom(format!("`{name}` stands there twice")));
                    }
                    pairs.push((name, value));
                }
                Ok(Named(pairs))
            }
        }

        deserializer.deserialize_map(Entries(PhantomData))
    }
}

impl<M: FlightModel> Vehicle<M> {
    /// SHA-256 of names and values of all parameters, in hexadecimal digits.
    pub(crate) fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        for (name, value) in Pairs::of(&self.parameters).0 {
            hash.update(name.as_bytes());
            hash.update(value.to_le_bytes());
        }
        let digest = hash.finalize();
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The command that writes gains for this vehicle in this flight.
    fn design(&self, flight: &SteadyFlight<M::Input>) -> String {
        let mut command = format!("ahv lqr --model {}", M::NAME);
        if let Some(table) = &self.table {
            command += &format!(" --table {}", table.display());
        }
        command += &format!(" --set {} --units {}", self.set, self.units.name());
        for (name, option) in &self.choices {
            if let Some(option) = option {
                command += &format!(" --{name} {option}");
            }
        }
        let gamma = flight.gamma.to_degrees();
        command += &format!(
            " --velocity {} --altitude {} --gamma {gamma}",
            flight.velocity, flight.altitude
        );
        for (name, value) in held(&flight.input) {
            if value != 0.0 {
                let unit = self.units.label::<M::Input>(name);
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

/// The inputs that a trim does not seek.
fn held<U: Vector<f64>>(input: &U) -> Vec<(&'static str, f64)> {
    let mut pairs = Pairs::of(input).0;
    pairs.retain(|(name, _)| !SOUGHT_INPUTS.contains(name));
    pairs
}

impl Gains {
    /// Reads the gains at `path` for a vehicle: their differences from what it flies are in [`Self::differences`].
    ///
    /// # Errors
    ///
    /// What is wrong with the file, and the command that writes a right one.
    pub(crate) fn read<M: FlightModel>(
        path: &Path,
        vehicle: &Vehicle<M>,
        flight: &SteadyFlight<M::Input>,
    ) -> Result<Self, String> {
        let text = text_of(path).map_err(|error| error.to_string())?;
        let gains = serde_json::from_str(&text).map_err(|error| error.to_string());
        let checked = gains.and_then(|gains: Self| gains.check(vehicle).map(|()| gains));
        checked.map_err(|what| {
            let command = vehicle.design(flight);
            format!("{what}; this command writes gains for these flights: {command}")
        })
    }

    /// What cannot be gains for this model.
    fn check<M: FlightModel>(&self, vehicle: &Vehicle<M>) -> Result<(), String> {
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
        let (states, inputs) = (M::State::NAMES, M::Input::NAMES);
        if self.states != states {
            return Err(format!(
                "its gains of {} are for the states {}; {} has {}, in this order",
                self.model,
                self.states.join(", "),
                M::NAME,
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
                M::NAME,
                inputs.join(", ")
            ));
        }
        self.check_sizes::<M>(vehicle)
    }

    /// Lists that do not fit the names, and units of other quantities.
    fn check_sizes<M: FlightModel>(&self, vehicle: &Vehicle<M>) -> Result<(), String> {
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
        let (states, inputs) = (M::State::NAMES, M::Input::NAMES);
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
        // The trim that the gains are about is of this condition: these states are given, not sought.
        let condition = [self.velocity, self.altitude, self.gamma_deg.to_radians()];
        let given = ["velocity", "altitude", "gamma"].into_iter().zip(condition);
        for (name, value) in given {
            let own = self.state.0.iter().find(|(own, _)| own == name);
            if own.is_some_and(|&(_, own)| (own - value).abs() > SAME * value.abs().max(1.0)) {
                return Err(format!(
                    "its `state` is not of its flight condition: {name}"
                ));
            }
        }
        let right = Pairs::units_of_both::<M::State, M::Input>(vehicle.units).0;
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

    /// How these gains were designed for another vehicle or flight than this one; empty if they were not.
    pub(crate) fn differences<M: FlightModel>(
        &self,
        vehicle: &Vehicle<M>,
        flight: &SteadyFlight<M::Input>,
    ) -> Vec<String> {
        let mut differences = Vec::new();
        let mut text = |what: &str, own: &str, flown: &str| {
            if own != flown {
                differences.push(format!("{what} {own}, the flights {flown}"));
            }
        };
        text("model", &self.model, M::NAME);
        text("set", &self.set, &vehicle.set);
        let option = |option: Option<&str>| option.unwrap_or("of the table").to_owned();
        for (name, chosen) in &vehicle.choices {
            let mut own = self.choices.0.iter();
            let own = own.find(|(own, _)| own == name);
            let own = own.and_then(|(_, chosen)| chosen.as_deref());
            text(name, &option(own), &option(*chosen));
        }
        let flown = [flight.velocity, flight.altitude, flight.gamma.to_degrees()];
        let own = [self.velocity, self.altitude, self.gamma_deg];
        let mut pairs: Vec<_> = ["velocity", "altitude", "gamma in deg"]
            .into_iter()
            .zip(own.into_iter().zip(flown))
            .collect();
        let input: M::Input = self.input.vector();
        let both = held(&input).into_iter().zip(held(&flight.input));
        pairs.extend(both.map(|((name, own), (_, flown))| (name, (own, flown))));
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
    pub(crate) fn remedy<M: FlightModel>(
        vehicle: &Vehicle<M>,
        flight: &SteadyFlight<M::Input>,
    ) -> String {
        format!(
            "choose the same for both, or let `{}` write new gains; --feedback-mismatch allow flies them all the same",
            vehicle.design(flight)
        )
    }
}
