//! Normal equations: solved in units in which their diagonal is 1, with what they leave open named.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Least eigenvalue of the scaled matrix below which rounding decides.
const SINGULAR: f64 = 1e-11;
/// Share of a direction from which an unknown is named.
const SHARE: f64 = 0.3;

/// The inverse of a symmetric positive matrix.
///
/// # Errors
///
/// The indices of the unknowns that cannot be told apart, or that have no effect.
pub(crate) fn inverse(matrix: &DMatrix<f64>) -> Result<DMatrix<f64>, Vec<usize>> {
    let n = matrix.nrows();
    let idle: Vec<usize> = (0..n)
        .filter(|&it| matrix[(it, it)] <= 0.0 || matrix[(it, it)].is_nan())
        .collect();
    if !idle.is_empty() {
        return Err(idle);
    }
    let scale = matrix.diagonal().map(|it| 1.0 / it.sqrt());
    let scaled = DMatrix::from_fn(n, n, |row, column| {
        matrix[(row, column)] * scale[row] * scale[column]
    });
    if scaled.iter().any(|it| !it.is_finite()) {
        return Err((0..n).collect());
    }
    let SymmetricEigen {
        eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(scaled);
    if n > 0 {
        let (least, value) = eigenvalues.argmin();
        if value < SINGULAR {
            let direction = eigenvectors.column(least);
            let named = (0..n).filter(|&it| direction[it].abs() > SHARE);
            return Err(named.collect());
        }
    }
    let inner = DMatrix::from_diagonal(&eigenvalues.map(|it| 1.0 / it));
    let inverse = &eigenvectors * inner * eigenvectors.transpose();
    Ok(DMatrix::from_fn(n, n, |row, column| {
        inverse[(row, column)] * scale[row] * scale[column]
    }))
}

/// The matrix with a diagonal that is larger by this part (Marquardt 1963).
pub(crate) fn damped(matrix: &DMatrix<f64>, part: f64) -> DMatrix<f64> {
    let mut damped = matrix.clone();
    for index in 0..matrix.nrows() {
        damped[(index, index)] *= 1.0 + part;
    }
    damped
}

/// The largest component of a step, in standard errors.
pub(crate) fn size(step: &DVector<f64>, inverse: &DMatrix<f64>) -> f64 {
    let sizes = step
        .iter()
        .zip(inverse.diagonal().iter().copied().collect::<Vec<_>>());
    sizes
        .map(|(step, variance)| step.abs() / variance.sqrt())
        .fold(0.0, f64::max)
}
