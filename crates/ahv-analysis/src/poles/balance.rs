//! Balancing: Parlett and Reinsch 1969, with powers of two, so that nothing is rounded.

use nalgebra::{DMatrix, DVector};

/// Share by which a scaling must lessen the norms of a row and its column to be made.
const GAIN: f64 = 0.95;

/// Rounds of scaling; a handful suffices.
const MAX_ROUNDS: usize = 100;

/// The diagonal of D in D⁻¹ `matrix` D whose rows and columns are about equally long.
pub(crate) fn balance(matrix: &DMatrix<f64>) -> DVector<f64> {
    let n = matrix.nrows();
    let mut scale = DVector::from_element(n, 1.0);
    let mut balanced = matrix.clone();
    for _ in 0..MAX_ROUNDS {
        let mut changed = false;
        for i in 0..n {
            // The diagonal stays as it is, and does not count. It is left out, not subtracted: rounding must not take the
            // place of a row of zeros.
            let others = || (0..n).filter(|&j| j != i);
            let column: f64 = others().map(|j| balanced[(j, i)].powi(2)).sum();
            let row: f64 = others().map(|j| balanced[(i, j)].powi(2)).sum();
            let (column, row) = (column.sqrt(), row.sqrt());
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let factor = (row / column).sqrt().log2().round().exp2();
            if column * factor + row / factor < GAIN * (column + row) {
                scale[i] *= factor;
                balanced.column_mut(i).scale_mut(factor);
                balanced.row_mut(i).unscale_mut(factor);
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    scale
}

/// D⁻¹ `matrix` D.
pub(crate) fn similar(matrix: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        matrix[(row, column)] * scale[column] / scale[row]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix whose rows and columns are equally long, in other units, comes back, but for a unit common to all.
    #[test]
    fn units_are_taken_out() {
        let n = 6;
        let plain = DMatrix::from_fn(n, n, |row, column| if row == column { 50.0 } else { 3.0 });
        let units = DVector::from_fn(n, |index, _| {
            f64::exp2([-20, 3, 11, 0, 35, -7][index].into())
        });
        let found = balance(&similar(&plain, &units));
        let common = found[0] * units[0];
        assert_eq!(
            found.component_mul(&units),
            DVector::from_element(n, common)
        );
    }

    /// At a ratio of 2.1 a factor of 2 lessens the norms by 2 %, at 2.9 by 11 %; one way and the other.
    #[test]
    fn a_scaling_must_gain_a_twentieth() {
        for (ratio, factor) in [(2.1, 1.0), (2.9, 2.0), (1.0 / 2.1, 1.0), (1.0 / 2.9, 0.5)] {
            let matrix = DMatrix::from_row_slice(2, 2, &[0.0, ratio, 1.0, 0.0]);
            assert_eq!(balance(&matrix).as_slice(), [factor, 1.0], "{ratio}");
        }
    }
}
