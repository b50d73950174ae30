//! Values by name, as JSON objects have them.

use std::fmt;
use std::marker::PhantomData;

use ahv_analysis::trim::SteadyState;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::vehicle::Vehicle;

/// Values by name in their own order, each name once; an object in JSON.
pub(crate) struct Named<T>(pub(crate) Vec<(String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Named<T> {
    pub(crate) fn new<N: ToString>(pairs: impl IntoIterator<Item = (N, T)>) -> Self {
        let pairs = pairs.into_iter();
        Self(
            pairs
                .map(|(name, value)| (name.to_string(), value))
                .collect(),
        )
    }

    pub(crate) fn names(&self) -> Vec<&str> {
        self.0.iter().map(|(name, _)| name.as_str()).collect()
    }
}

impl Named<f64> {
    /// What is given of a steady state, in the units of the vehicle; angles in deg, as their names say.
    pub(crate) fn given(vehicle: &Vehicle, flight: &SteadyState) -> Self {
        let given = flight.given();
        Self::new(given.map(|(name, value)| shown_as(name, value, vehicle.unit(name))))
    }

    /// The components with these names; 0 for one that has no name here.
    pub(crate) fn values(&self, names: &[&str]) -> Vec<f64> {
        let value = |name: &&str| {
            let found = self.0.iter().find(|(own, _)| own == name);
            found.map_or(0.0, |&(_, value)| value)
        };
        names.iter().map(value).collect()
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

/// A value by its name for a program: an angle is in deg, and its name says so.
pub(crate) fn shown_as(name: &str, value: f64, unit: &str) -> (String, f64) {
    match unit {
        "rad" => (format!("{name}_deg"), value.to_degrees()),
        _ => (name.to_owned(), value),
    }
}
