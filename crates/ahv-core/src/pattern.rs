//! Where the entries of compressed matrices stand.

use crate::{Real, Vector};

/// The structurally non-zero entries of a matrix (`D` = 2) or of an array of more indices, in the order in which its
/// compressed form holds them: row by row.
///
/// A symmetric array (second derivatives) lists an entry once, the greater of the last two indices first.
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

impl Pattern<2> {
    /// The matrix, a vector of rows, whose structurally non-zero entries are `values`.
    pub fn dense<R: Real, C: Vector<R>, M: Vector<C>>(&self, values: &[R]) -> M {
        let mut entries = self.at.iter().zip(values).peekable();
        M::from_fn(|i| {
            C::from_fn(|j| {
                let here = entries.next_if(|(at, _)| **at == [i, j]);
                here.map_or(R::ZERO, |(_, value)| *value)
            })
        })
    }
}

impl Pattern<3> {
    /// The array, a vector of matrices, whose structurally non-zero entries are `values`.
    pub fn dense<R: Real, D: Vector<R>, C: Vector<D>, M: Vector<C>>(&self, values: &[R]) -> M {
        let mut entries = self.at.iter().zip(values).peekable();
        M::from_fn(|i| {
            C::from_fn(|j| {
                D::from_fn(|k| {
                    let here = entries.next_if(|(at, _)| **at == [i, j, k]);
                    here.map_or(R::ZERO, |(_, value)| *value)
                })
            })
        })
    }

    /// The same where entries stand for their mirror images in the last two indices too.
    pub fn symmetric<R: Real, D: Vector<R>, C: Vector<D>, M: Vector<C>>(&self, values: &[R]) -> M {
        let entry = |i, j: usize, k: usize| {
            let position = self.at.binary_search(&[i, j.max(k), j.min(k)]).ok()?;
            values.get(position).copied()
        };
        M::from_fn(|i| C::from_fn(|j| D::from_fn(|k| entry(i, j, k).unwrap_or(R::ZERO))))
    }
}

/// The indices of an entry by the names of its components: `at!(State.velocity, Input.phi)`.
///
/// The vectors are those of [`impl_vector!`](crate::impl_vector), `repr(C)`: a field of bytes lies where its index says.
#[macro_export]
macro_rules! at {
    ($($vector:ident.$field:ident),+) => {
        [$(::core::mem::offset_of!($vector<u8>, $field)),+]
    };
}
