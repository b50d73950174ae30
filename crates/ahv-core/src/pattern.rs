//! Where the entries of compressed matrices stand.

/// The structurally non-zero entries of a matrix (`D` = 2) or of an array of more indices, in the order in which its
/// compressed form holds them: row by row.
///
/// [`entries!`](crate::entries) makes one, with a struct whose fields are the entries. A symmetric array (second derivatives) lists an entry once, the greater of the last two indices first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pattern<const D: usize> {
    /// Number of indices in each direction.
    pub shape: [usize; D],
    /// Indices of each entry.
    pub at: &'static [[usize; D]],
}

impl<const D: usize> Pattern<D> {
    /// A pattern.
    pub const fn new(shape: [usize; D], at: &'static [[usize; D]]) -> Self {
        Self { shape, at }
    }

    /// Number of entries.
    pub const fn len(&self) -> usize {
        self.at.len()
    }

    /// Whether there is no entry.
    pub const fn is_empty(&self) -> bool {
        self.at.is_empty()
    }
}
