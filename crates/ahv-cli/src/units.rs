//! The systems of units in which a model can be run.

use ahv_core::{Bounds, Vector};
use clap::ValueEnum;

/// A system of units, for inputs, results, and the model itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Units {
    /// Foot, slug, second, radian
    #[value(name = "ft-slug-s-rad")]
    FootSlug,
    /// Metre, kilogram, second, radian
    #[value(name = "si")]
    Si,
}

impl Units {
    /// The name, as command lines have it and tables say it of themselves.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::FootSlug => "ft-slug-s-rad",
            Self::Si => "si",
        }
    }

    /// The system of a table that calls it `name`.
    pub(crate) fn of_table(name: &str) -> Self {
        if name == Self::Si.name() {
            Self::Si
        } else {
            Self::FootSlug
        }
    }

    /// Units of the components of a `V`, in order.
    pub(crate) fn labels<V: Vector<f64>>(self) -> &'static [&'static str] {
        match self {
            Self::FootSlug => V::UNITS,
            Self::Si => V::SI_UNITS,
        }
    }

    /// The unit of the component of a `V` called `name`; `1` if there is none.
    pub(crate) fn label<V: Vector<f64>>(self, name: &str) -> &'static str {
        V::index_of(name)
            .and_then(|index| self.labels::<V>().get(index))
            .copied()
            .unwrap_or("1")
    }

    /// The factor of a number in the units of `own` to this system, `si` being that of its unit to the International System.
    pub(crate) fn factor_from(self, own: Self, si: f64) -> f64 {
        if self == own { 1.0 } else { si }
    }

    /// A vector of a table, in this system.
    pub(crate) fn convert<V: Vector<f64>>(self, vector: V) -> V {
        let mut factors = self.factors(V::SI_FACTORS);
        vector.map(|component| component * factors.next().unwrap_or(1.0))
    }

    /// The intervals of a table, in this system.
    pub(crate) fn convert_bounds<B: Vector<Bounds>>(self, bounds: B) -> B {
        let mut factors = self.factors(B::SI_FACTORS);
        bounds.map(|Bounds { min, max }| {
            let factor = factors.next().unwrap_or(1.0);
            Bounds::new(min * factor, max * factor)
        })
    }

    fn factors(self, si: &'static [f64]) -> impl Iterator<Item = f64> {
        si.iter().map(move |&factor| match self {
            Self::FootSlug => 1.0,
            Self::Si => factor,
        })
    }
}
