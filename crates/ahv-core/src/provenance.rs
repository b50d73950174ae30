//! Where a number comes from.

/// How far a number can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Stands in a publication, and was checked.
    Published,
    /// Was computed from published numbers.
    Derived,
    /// Is quoted, but could not be checked.
    Unverified,
    /// Was chosen for want of a published number.
    Assumed,
}

/// Source, status and uncertainty of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Provenance {
    /// Key of the source in the table.
    pub source: &'static str,
    /// How far the number can be trusted.
    pub status: Status,
    /// Relative uncertainty: 0.4 stands for 40 %.
    pub uncertainty: f64,
}

impl Provenance {
    /// Source, status and relative uncertainty of a parameter.
    pub const fn new(source: &'static str, status: Status, uncertainty: f64) -> Self {
        Self {
            source,
            status,
            uncertainty,
        }
    }
}
