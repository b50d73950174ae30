//! The names of a vector's components, with their units in the system of a vehicle.

use ahv_core::{Bounds, Outside};

use crate::output::Pairs;
use crate::show::show;

/// Names and units of the components of a vector.
#[derive(Clone, Copy, Debug)]
pub struct Labels {
    /// Names, in order.
    pub names: &'static [&'static str],
    /// Units; `1` where there is none.
    pub units: &'static [&'static str],
}

impl Labels {
    /// Number of components.
    pub(crate) const fn len(self) -> usize {
        self.names.len()
    }

    /// Names with their units.
    pub(crate) fn iter(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.names.iter().copied().zip(self.units.iter().copied())
    }

    /// Index of the component called `name`.
    pub(crate) fn index_of(self, name: &str) -> Option<usize> {
        self.names.iter().position(|&own| own == name)
    }

    /// Its unit; `1` if there is none of this name.
    pub(crate) fn unit(self, name: &str) -> &'static str {
        let index = self.index_of(name);
        index
            .and_then(|index| self.units.get(index))
            .copied()
            .unwrap_or("1")
    }

    /// Values by name.
    pub(crate) fn pairs<V>(self, values: impl IntoIterator<Item = V>) -> Pairs<V> {
        Pairs(self.names.iter().copied().zip(values).collect())
    }

    /// One line for each component, for a person.
    pub(crate) fn describe(self, values: &[f64]) -> String {
        let lines = self.iter().zip(values);
        let lines =
            lines.map(|((name, unit), &value)| format!("  {name:<12} {}", show(value, unit)));
        lines.collect::<Vec<_>>().join("\n")
    }

    /// The components outside their intervals.
    pub(crate) fn outside(
        self,
        values: &[f64],
        bounds: &[Bounds],
    ) -> impl Iterator<Item = Outside> {
        let components = self.names.iter().zip(values).zip(bounds);
        components.filter_map(|((&name, &value), &bounds)| {
            (!bounds.contains(value)).then_some(Outside {
                name,
                value,
                bounds,
            })
        })
    }
}
