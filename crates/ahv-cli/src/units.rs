//! The systems of units in which a model can be run.

use ahv_analysis::erased::Components;
use ahv_core::Bounds;
use clap::ValueEnum;

use crate::labels::Labels;

/// A system of units, for inputs, results, and the model itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Units {
    /// Foot, slug, second, radian
    #[value(name = "ft-slug-s-rad")]
    FootSlug,
    /// Metre, kilogram, second, radian
    #[value(name = "si")]
    Si,
}

impl Units {
    /// The name, as command lines have it and tables say it of themselves.
    pub const fn name(self) -> &'static str {
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

    /// Names and units of these components.
    pub const fn labels(self, components: Components) -> Labels {
        Labels {
            names: components.names,
            units: match self {
                Self::FootSlug => components.units,
                Self::Si => components.si_units,
            },
        }
    }

    /// The factor of a number in the units of `own` to this system, `si` being that of its unit to the International System.
    pub(crate) fn factor_from(self, own: Self, si: f64) -> f64 {
        if self == own { 1.0 } else { si }
    }

    /// Values of a table, in this system.
    pub(crate) fn convert(self, components: Components, values: &mut [f64]) {
        for (value, factor) in values.iter_mut().zip(self.factors(components)) {
            *value *= factor;
        }
    }

    /// The intervals of a table, in this system.
    pub(crate) fn convert_bounds(self, components: Components, bounds: &mut [Bounds]) {
        for (bounds, factor) in bounds.iter_mut().zip(self.factors(components)) {
            *bounds = Bounds::new(bounds.min * factor, bounds.max * factor);
        }
    }

    fn factors(self, components: Components) -> impl Iterator<Item = f64> {
        components.si_factors.iter().map(move |&factor| match self {
            Self::FootSlug => 1.0,
            Self::Si => factor,
        })
    }
}
