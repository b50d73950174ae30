//! Zeros, by the generalised eigenvalue problem of the system pencil.

use faer::Mat;
use faer::linalg::solvers::GeneralizedEigen;
use nalgebra::{Complex, DMatrix};

use super::balance::{balance, similar};
use super::{PolesError, frequency, told_from_zero};
use crate::linearize::LinearSystem;

/// A zero is infinite when |β| is at most this share of |α| + |β|.
const INFINITE: f64 = 1e-10;

/// Singular value, as a share of the largest, below which a rank is lost.
const RANK: f64 = 1e-9;

/// Zeros of a square system.
#[derive(Clone, Debug, PartialEq)]
pub struct Zeros {
    /// Finite zeros, by rising frequency.
    pub finite: Vec<Zero>,
    /// Infinite eigenvalues of the pencil.
    pub infinite: usize,
    /// Whether C B is regular, with D = 0. Every output then answers to the inputs in its first derivative, and there
    /// are exactly as many finite zeros as states less outputs.
    pub regular: bool,
}

/// A finite zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// The eigenvalue of the pencil, 1/s.
    pub value: Complex<f64>,
    /// Where the zero is a pole that inputs or outputs miss: it cancels, and is no zero of the transfer matrix.
    pub decoupling: Option<Decoupling>,
}

/// What misses a pole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decoupling {
    /// No input reaches it.
    Input,
    /// No output shows it.
    Output,
}

/// Invariant zeros of `system`: the s for which [A − s I, B; C, D] is singular. Those that do not decouple are its
/// transmission zeros.
///
/// The pencil is balanced by powers of two, and nothing is divided before a zero is known to be finite. A zero that
/// rounding cannot tell from 0 is 0.
///
/// # Errors
///
/// [`PolesError`]
pub fn zeros(system: &LinearSystem) -> Result<Zeros, PolesError> {
    let (n, inputs, outputs) = (system.a.nrows(), system.b.ncols(), system.c.nrows());
    if inputs != outputs {
        return Err(PolesError::NotSquare { inputs, outputs });
    }
    let matrix = balanced(system);
    let size = n + inputs;
    let left = Mat::from_fn(size, size, |row, column| matrix[(row, column)]);
    let right = Mat::from_fn(size, size, |row, column| {
        f64::from(u8::from(row == column && row < n))
    });
    let solved = GeneralizedEigen::new_from_real(left.as_ref(), right.as_ref())
        .map_err(|_| PolesError::NoConvergence)?;
    let (alphas, betas) = (solved.S_a().column_vector(), solved.S_b().column_vector());
    let mut finite: Vec<Zero> = (0..size)
        .map(|index| (alphas[index], betas[index]))
        .filter(|&(alpha, beta)| {
            let (alpha, beta) = (frequency(alpha), frequency(beta));
            beta > INFINITE * (alpha + beta)
        })
        .map(|(alpha, beta)| {
            let value = told_from_zero(alpha / beta, &matrix);
            let decoupling = decoupling(&matrix, n, value);
            Zero { value, decoupling }
        })
        .collect();
    finite.sort_by(|a, b| {
        let frequencies = frequency(a.value).total_cmp(&frequency(b.value));
        frequencies.then(b.value.im.total_cmp(&a.value.im))
    });
    let gain = matrix.view((n, 0), (outputs, n)) * matrix.view((0, n), (n, inputs));
    Ok(Zeros {
        infinite: size - finite.len(),
        finite,
        regular: full_rank(gain.map(Complex::from)) && system.d.iter().all(|&it| it == 0.0),
    })
}

/// [A, B; C, D] with the states, inputs and outputs scaled so that E = [I, 0; 0, 0] stays what it is.
fn balanced(system: &LinearSystem) -> DMatrix<f64> {
    let (n, m) = (system.a.nrows(), system.b.ncols());
    let mut matrix = DMatrix::zeros(n + m, n + m);
    matrix.view_mut((0, 0), (n, n)).copy_from(&system.a);
    matrix.view_mut((0, n), (n, m)).copy_from(&system.b);
    matrix.view_mut((n, 0), (m, n)).copy_from(&system.c);
    matrix.view_mut((n, n), (m, m)).copy_from(&system.d);
    similar(&matrix, &balance(&matrix))
}

/// Whether [A − s I, B] or [A − s I; C] loses rank at the zero s.
fn decoupling(matrix: &DMatrix<f64>, n: usize, zero: Complex<f64>) -> Option<Decoupling> {
    let size = matrix.nrows();
    let mut shifted = matrix.map(Complex::from);
    for i in 0..n {
        shifted[(i, i)] -= zero;
    }
    if !full_rank(shifted.view((0, 0), (n, size)).into_owned()) {
        Some(Decoupling::Input)
    } else if !full_rank(shifted.view((0, 0), (size, n)).into_owned()) {
        Some(Decoupling::Output)
    } else {
        None
    }
}

fn full_rank(matrix: DMatrix<Complex<f64>>) -> bool {
    let values = matrix.singular_values();
    values.min() > RANK * values.max()
}
