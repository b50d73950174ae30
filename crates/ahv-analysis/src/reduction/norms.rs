//! The norms of a stable system.

use nalgebra::{Complex, DMatrix};

use super::{Part, ReductionError};
use crate::covariance::CovarianceError;
use crate::poles::{PolesError, eigen};

/// Relative accuracy of the largest gain.
const ACCURACY: f64 = 1e-9;
/// Real part relative to the eigenvalue below which it may lie on the imaginary axis; the gain at its frequency decides.
const ON_AXIS: f64 = 1e-4;
/// Rounds of the search, each of which at least doubles the digits.
const ROUNDS: usize = 60;

/// The H₂ norm: root of the sum of the output variances under white noise of unit intensity.
///
/// # Errors
///
/// [`CovarianceError`] for a system that is not stable.
pub fn h2(part: &Part) -> Result<f64, CovarianceError> {
    let reach = part.controllability()?;
    Ok((&part.c * reach * part.c.transpose())
        .trace()
        .max(0.0)
        .sqrt())
}

/// The H∞ norm: the largest gain over all frequencies, to nine digits.
///
/// The frequencies at which the gain passes a level are eigenvalues of a Hamiltonian matrix on the imaginary axis; between
/// them it is larger (Bruinsma and Steinbuch 1990).
///
/// # Errors
///
/// [`PolesError`] where the eigenvalues do not converge.
pub fn h_infinity(part: &Part) -> Result<f64, ReductionError> {
    let poles = eigen::values(&part.a).ok_or(PolesError::NoConvergence)?;
    let starts = poles
        .iter()
        .flat_map(|it| [it.re.hypot(it.im), it.im.abs()]);
    let mut level = starts
        .chain([0.0])
        .map(|it| gain(part, it))
        .fold(0.0, f64::max);
    if level == 0.0 {
        return Ok(0.0);
    }
    for _ in 0..ROUNDS {
        let above = level * (1.0 + ACCURACY);
        let crossings = crossings(part, above)?;
        let between = crossings.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let all: Vec<f64> = crossings.iter().copied().chain(between).collect();
        let largest = all.iter().map(|&it| gain(part, it)).fold(0.0, f64::max);
        if largest <= above {
            break;
        }
        level = largest;
    }
    Ok(level)
}

/// Frequencies in rad/s, ascending, at which the gain may pass `level`.
fn crossings(part: &Part, level: f64) -> Result<Vec<f64>, PolesError> {
    let n = part.order();
    let mut hamiltonian = DMatrix::zeros(2 * n, 2 * n);
    hamiltonian.view_mut((0, 0), (n, n)).copy_from(&part.a);
    let driven = &part.b * part.b.transpose() / level;
    hamiltonian.view_mut((0, n), (n, n)).copy_from(&driven);
    let seen = part.c.tr_mul(&part.c) / -level;
    hamiltonian.view_mut((n, 0), (n, n)).copy_from(&seen);
    let back = -part.a.transpose();
    hamiltonian.view_mut((n, n), (n, n)).copy_from(&back);
    let scale = crate::poles::balance(&hamiltonian);
    let balanced = crate::poles::similar(&hamiltonian, &scale);
    let values = eigen::values(&balanced).ok_or(PolesError::NoConvergence)?;
    let near = values
        .iter()
        .filter(|it| it.re.abs() <= ON_AXIS * it.im.abs());
    let mut frequencies: Vec<f64> = near.map(|it| it.im.abs()).chain([0.0]).collect();
    frequencies.sort_by(f64::total_cmp);
    Ok(frequencies)
}

/// Largest singular value of C (jω − A)⁻¹ B, by its real form: complex singular vectors are not needed.
pub(super) fn gain(part: &Part, frequency: f64) -> f64 {
    let n = part.order();
    let j = Complex::new(0.0, frequency);
    let matrix = DMatrix::from_fn(n, n, |row, column| {
        let own = if row == column {
            j
        } else {
            Complex::new(0.0, 0.0)
        };
        own - part.a[(row, column)]
    });
    let Some(states) = matrix.lu().solve(&part.b.map(Complex::from)) else {
        return f64::INFINITY;
    };
    let response = part.c.map(Complex::from) * states;
    let (rows, columns) = response.shape();
    let real = DMatrix::from_fn(2 * rows, 2 * columns, |row, column| {
        let entry = response[(row % rows, column % columns)];
        match (row < rows, column < columns) {
            (true, true) | (false, false) => entry.re,
            (true, false) => -entry.im,
            (false, true) => entry.im,
        }
    });
    real.singular_values().max()
}
