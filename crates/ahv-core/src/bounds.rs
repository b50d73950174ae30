//! The box in which a model is valid.

use crate::{Real, Vector};

/// A closed interval, in the unit of the quantity that it bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least valid value.
    pub min: f64,
    /// Greatest valid value.
    pub max: f64,
}

impl Bounds {
    /// The interval from `min` to `max`, both included.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// Whether `value` lies inside; NaN never does.
    pub const fn contains(&self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }
}

/// A component that lies outside its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// Name of the component.
    pub name: &'static str,
    /// Its value, in its own unit.
    pub value: f64,
    /// The interval that it left.
    pub bounds: Bounds,
}

/// The first component of `x` outside `bounds`, in the order of the components.
pub fn first_outside<R, X, B>(x: &X, bounds: &B) -> Option<Outside>
where
    R: Real,
    X: Vector<R>,
    B: Vector<Bounds>,
{
    X::NAMES.iter().enumerate().find_map(|(index, &name)| {
        let value = x.get(index)?.to_f64();
        let bounds = bounds.get(index)?;
        (!bounds.contains(value)).then_some(Outside {
            name,
            value,
            bounds,
        })
    })
}
