//! Where samples can be drawn from in the place of a file.

/// A variable that samples are drawn over.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
    /// Its unit, angles in rad.
    pub unit: &'static str,
    /// The interval that it is drawn from, unless another is asked for.
    pub interval: (f64, f64),
}

/// What a table asks of a source.
pub struct Ask<'a> {
    /// Its fitted quantities, by their sections.
    pub quantities: &'a [&'a str],
    /// The variables of their monomials.
    pub variables: &'a [&'a str],
    /// The value of a parameter of the table, in foot and slug, by the name that models have for it.
    pub parameter: &'a dyn Fn(&str) -> Option<f64>,
}

/// Computes a table's quantities at points.
pub trait Source: Sync {
    /// The name that a person types.
    fn name(&self) -> &'static str;

    /// What computes the quantities that are asked for.
    ///
    /// # Errors
    ///
    /// Which quantity or variable it does not have, in words.
    fn sampler(&self, ask: &Ask<'_>) -> Result<Box<dyn Sampler>, String>;
}

/// Computes quantities at points.
pub trait Sampler: Sync {
    /// The variables of a point, in order: those that were asked for, and others that the quantities depend on.
    fn variables(&self) -> &[Variable];

    /// The quantities at a point, in the order in which they were asked for, in foot and slug.
    ///
    /// # Errors
    ///
    /// Why there are none at this point, in words.
    fn at(&self, point: &[f64]) -> Result<Vec<f64>, String>;
}
