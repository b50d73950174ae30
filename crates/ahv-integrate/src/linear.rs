//! Linear equations between vectors whose components have names, with a matrix whose zeros are known.

use ahv_core::{Pattern, Real, Vector};

/// Greatest number of unknowns.
pub(crate) const MOST: usize = 16;

/// A set of indices below [`MOST`], a bit each.
type Indices = u16;

/// One step of the elimination: what the pivot on the diagonal meets among the rows and columns that are left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pivot {
    /// Row and column of the pivot.
    index: u8,
    /// Rows with an entry in its column.
    rows: Indices,
    /// Columns with an entry in its row.
    columns: Indices,
}

/// The order of elimination of a matrix, with the entries that fill in: from the pattern alone, at compile time.
///
/// Pivots stay on the diagonal; the next one is that with the fewest products to take (Markowitz 1957).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Elimination {
    pivots: [Pivot; MOST],
    length: usize,
}

impl Elimination {
    /// The elimination of a matrix of `length` rows with these entries, and a diagonal without zeros.
    ///
    /// # Panics
    ///
    /// If the pattern is of another size, or of more than [`MOST`] rows: at compile time.
    pub(crate) const fn of(pattern: &Pattern<2>, length: usize) -> Self {
        assert!(length <= MOST, "more than 16 states");
        let [high, wide] = pattern.shape;
        assert!(
            high == length && wide == length,
            "a pattern of another size"
        );
        let mut rows = [0; MOST];
        let mut entry = 0;
        while entry < pattern.len() {
            let [row, column] = pattern.at[entry];
            assert!(row < length && column < length, "an entry out of range");
            rows[row] |= 1 << column;
            entry += 1;
        }
        let unused = Pivot {
            index: 0,
            rows: 0,
            columns: 0,
        };
        let mut pivots = [unused; MOST];
        let mut left = ((1_u32 << length) - 1) as Indices;
        let mut step = 0;
        while step < length {
            let pivot = cheapest(&rows, left);
            left &= !(1 << pivot.index);
            let mut row = 0;
            while row < length {
                if pivot.rows >> row & 1 == 1 {
                    rows[row] |= pivot.columns;
                }
                row += 1;
            }
            pivots[step] = pivot;
            step += 1;
        }
        Self { pivots, length }
    }

    fn pivots(&self) -> impl DoubleEndedIterator<Item = &Pivot> {
        self.pivots.iter().take(self.length)
    }
}

/// The pivot with the fewest products to take, among the indices that are `left`.
const fn cheapest(rows: &[Indices; MOST], left: Indices) -> Pivot {
    let mut best: Option<Pivot> = None;
    let mut index = 0;
    while index < MOST {
        if left >> index & 1 == 1 {
            let others = left & !(1 << index);
            let mut pivot = Pivot {
                index: index as u8,
                rows: 0,
                columns: rows[index] & others,
            };
            let mut row = 0;
            while row < MOST {
                if others >> row & rows[row] >> index & 1 == 1 {
                    pivot.rows |= 1 << row;
                }
                row += 1;
            }
            let better = match best {
                Some(best) => products(&pivot) < products(&best),
                None => true,
            };
            if better {
                best = Some(pivot);
            }
        }
        index += 1;
    }
    match best {
        Some(pivot) => pivot,
        None => panic!("no index is left"),
    }
}

const fn products(pivot: &Pivot) -> u32 {
    pivot.rows.count_ones() * pivot.columns.count_ones()
}

/// The members of a set, in order.
#[inline]
fn members(mut set: Indices) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let member = (set != 0).then_some(set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        member
    })
}

/// A matrix as the product of a lower and an upper triangle.
///
/// A singular matrix shows as a solution that is infinite or NaN.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<R> {
    /// Off the diagonal the multipliers and the upper triangle, on it the reciprocal pivots.
    rows: [[R; MOST]; MOST],
    elimination: &'static Elimination,
}

impl<R: Real> Factors<R> {
    /// Factors `shift` · 1 − `matrix`, which is zero where `elimination` knows no entry.
    #[inline]
    pub(crate) fn of_shifted<X: Vector<R>, J: Vector<X>>(
        shift: R,
        matrix: &J,
        elimination: &'static Elimination,
    ) -> Self {
        let mut rows = [[R::ZERO; MOST]; MOST];
        let mut places = rows.iter_mut().enumerate();
        matrix.map(|row| {
            if let Some((index, place)) = places.next() {
                let mut entries = place.iter_mut();
                row.map(|entry| {
                    if let Some(place) = entries.next() {
                        *place = -entry;
                    }
                    entry
                });
                if let Some(diagonal) = place.get_mut(index) {
                    *diagonal = shift + *diagonal;
                }
            }
            row
        });
        for pivot in elimination.pivots() {
            eliminate(&mut rows, pivot);
        }
        Self { rows, elimination }
    }

    /// x of matrix · x = `right`.
    #[inline]
    pub(crate) fn solve<X: Vector<R>>(&self, right: &X) -> X {
        let mut x: [R; MOST] = core::array::from_fn(|index| right.get(index).unwrap_or(R::ZERO));
        for pivot in self.elimination.pivots() {
            let column = usize::from(pivot.index) % MOST;
            let known = x[column];
            for row in members(pivot.rows) {
                x[row % MOST] = x[row % MOST] - self.rows[row % MOST][column] * known;
            }
        }
        for pivot in self.elimination.pivots().rev() {
            let index = usize::from(pivot.index) % MOST;
            let row = &self.rows[index];
            let known = members(pivot.columns).fold(x[index], |sum, column| {
                sum - row[column % MOST] * x[column % MOST]
            });
            x[index] = known * row[index];
        }
        X::from_fn(|index| x.get(index).copied().unwrap_or(R::ZERO))
    }
}

/// Clears the column of the pivot in the rows that are left, and keeps the multipliers there.
#[inline]
fn eliminate<R: Real>(rows: &mut [[R; MOST]; MOST], pivot: &Pivot) {
    let index = usize::from(pivot.index) % MOST;
    let inverse = rows[index][index].recip();
    rows[index][index] = inverse;
    let pivot_row = rows[index];
    for row in members(pivot.rows) {
        let row = &mut rows[row % MOST];
        let multiplier = row[index] * inverse;
        row[index] = multiplier;
        for column in members(pivot.columns) {
            row[column % MOST] = row[column % MOST] - multiplier * pivot_row[column % MOST];
        }
    }
}

#[cfg(test)]
mod tests;
