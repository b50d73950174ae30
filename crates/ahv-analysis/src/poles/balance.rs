//! Balancing: Parlett and Reinsch 1969, with powers of two, so that nothing is rounded.

use nalgebra::{DMatrix, DVector};

/// Share by which a scaling must lessen the norms of a row and its column to be made.
const GAIN: f64 = 0.95;

/// Rounds of scaling; a handful suffices.
const MAX_ROUNDS: usize = 100;

/// The diagonal of D in D⁻¹ `matrix` D whose rows and columns are about equally long.
pub(super) fn balance(matrix: &DMatrix<f64>) -> DVector<f64> {
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
pub(super) fn similar(matrix: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        matrix[(row, column)] * scale[column] / scale[row]
    })
}
