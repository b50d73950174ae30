//! Linear equations between vectors whose components have names.

use ahv_core::{Real, Vector};

/// Greatest number of unknowns.
pub(crate) const MOST: usize = 16;

/// A matrix as the product of a lower and an upper triangle, with its rows exchanged (partial pivoting).
///
/// Entries that are 0 are skipped, so that the structural zeros of a Jacobian cost a comparison, not a row operation.
/// A singular matrix shows as a solution that is infinite or NaN.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<R> {
    /// Below the diagonal the multipliers, on it the reciprocal pivots.
    rows: [[R; MOST]; MOST],
    /// Which row of the matrix stands in each place.
    order: [usize; MOST],
    length: usize,
}

impl<R: Real + Into<f64>> Factors<R> {
    /// Factors `shift` · 1 − `matrix`.
    #[inline]
    pub(crate) fn of_shifted<X: Vector<R>, J: Vector<X>>(shift: R, matrix: &J) -> Self {
        const { assert!(X::LEN <= MOST && J::LEN == X::LEN) };
        let mut factors = Self {
            rows: [[R::ZERO; MOST]; MOST],
            order: core::array::from_fn(|place| place),
            length: X::LEN,
        };
        let mut places = factors.rows.iter_mut().enumerate();
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
        for column in 0..X::LEN {
            factors.exchange(column);
            factors.eliminate(column);
        }
        factors
    }

    /// Brings the row with the greatest entry in `column`, on or below the diagonal, up to the diagonal.
    #[inline]
    fn exchange(&mut self, column: usize) {
        let (mut best, mut greatest) = (column, -1.0);
        for (place, row) in self.rows.iter().enumerate().take(self.length).skip(column) {
            let size = row.get(column).map_or(0.0, |entry| entry.abs().into());
            if size > greatest {
                (best, greatest) = (place, size);
            }
        }
        if best != column {
            exchange(&mut self.rows, column, best);
            exchange(&mut self.order, column, best);
        }
    }

    /// Clears `column` below the diagonal, and keeps the multipliers there.
    #[inline]
    fn eliminate(&mut self, column: usize) {
        let mut below = self.rows.iter_mut().take(self.length).skip(column);
        let Some(pivot_row) = below.next() else {
            return;
        };
        let Some(pivot) = pivot_row.get_mut(column) else {
            return;
        };
        let inverse = pivot.recip();
        *pivot = inverse;
        for row in below {
            let Some(first) = row.get_mut(column) else {
                continue;
            };
            let multiplier = *first * inverse;
            let value: f64 = multiplier.into();
            if value == 0.0 {
                continue;
            }
            *first = multiplier;
            let above = pivot_row.iter().take(self.length).skip(column + 1);
            for (own, &above) in row.iter_mut().skip(column + 1).zip(above) {
                *own = *own - multiplier * above;
            }
        }
    }

    /// x of matrix · x = `right`.
    #[inline]
    pub(crate) fn solve<X: Vector<R>>(&self, right: &X) -> X {
        let mut x = [R::ZERO; MOST];
        let rows = || self.rows.iter().enumerate().take(X::LEN);
        for ((index, row), &place) in rows().zip(&self.order) {
            let known = product(row.iter().zip(&x).take(index));
            if let (Some(x), Some(right)) = (x.get_mut(index), right.get(place)) {
                *x = right - known;
            }
        }
        for (index, row) in rows().rev() {
            let known = product(row.iter().zip(&x).take(X::LEN).skip(index + 1));
            if let (Some(x), Some(&inverse)) = (x.get_mut(index), row.get(index)) {
                *x = (*x - known) * inverse;
            }
        }
        X::from_fn(|index| x.get(index).copied().unwrap_or(R::ZERO))
    }
}

/// Σ a b.
#[inline]
fn product<'a, R: Real>(pairs: impl Iterator<Item = (&'a R, &'a R)>) -> R {
    pairs.fold(R::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// `slice::swap` that does nothing out of range.
#[inline]
fn exchange<T: Copy, const N: usize>(items: &mut [T; N], one: usize, other: usize) {
    let (Some(&a), Some(&b)) = (items.get(one), items.get(other)) else {
        return;
    };
    if let Some(place) = items.get_mut(one) {
        *place = b;
    }
    if let Some(place) = items.get_mut(other) {
        *place = a;
    }
}

#[cfg(test)]
mod tests {
    use super::Factors;

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Four<T> {
        a: T,
        b: T,
        c: T,
        d: T,
    }

    ahv_core::impl_vector! {
        Four { a: ["1", "1", 1.0], b: ["1", "1", 1.0], c: ["1", "1", 1.0], d: ["1", "1", 1.0] }
    }

    #[test]
    fn a_matrix_that_needs_exchanges_is_solved() {
        let rows = [
            [0.0, 2.0, 0.0, 1.0],
            [1e-3, 0.0, 3.0, 0.0],
            [4.0, 0.0, 0.0, -2.0],
            [0.0, 1.0, 5.0, 0.0],
        ];
        let matrix = Four::<Four<f64>>::from_matrix(rows.map(|row| row.map(|a: f64| -a)));
        let exact = [1.0, -2.0, 3.0, 0.5];
        let right = rows.map(|row| row.iter().zip(exact).map(|(a, x)| a * x).sum::<f64>());
        let factors = Factors::of_shifted(0.0, &matrix);
        let solved: [f64; 4] = factors.solve(&Four::from(right)).into();
        for (x, exact) in solved.iter().zip(exact) {
            assert!((x - exact).abs() < 1e-14, "{x} is not {exact}");
        }
    }

    #[test]
    fn a_singular_matrix_has_no_finite_solution() {
        let matrix = Four::<Four<f64>>::from_matrix([[1.0; 4]; 4]);
        let factors = Factors::of_shifted(0.0, &matrix);
        let solved: [f64; 4] = factors.solve(&Four::from([1.0, 2.0, 3.0, 4.0])).into();
        assert!(solved.iter().any(|x| !x.is_finite()));
    }
}
