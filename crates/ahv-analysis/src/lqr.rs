//! Linear-quadratic regulator: the algebraic Riccati equation and its gain.
//!
//! For dx/dt = A x + B u, u = −K x minimises ∫ xᵀQx + uᵀRu dt with K = R⁻¹BᵀX and the stabilising solution X of
//! AᵀX + XA − XBR⁻¹BᵀX + Q = 0. X spans the stable invariant subspace of the Hamiltonian matrix as [I; X]; the subspace
//! comes from the matrix sign function (Roberts 1980) with scaling by the determinant (Byers 1987), which no multiple
//! eigenvalue disturbs.

use ahv_core::{Shown, Vector};
use nalgebra::{Complex, DMatrix, DVector};

/// Iterations of the sign function; it converges quadratically, in about ten.
const MOST_ITERATIONS: usize = 60;
/// Relative change of the iterate below which the next one, quadratically closer, is exact.
const SETTLED: f64 = 1e-8;
/// Largest residual of the Riccati equation, relative to the largest of its terms.
const RESIDUAL: f64 = 1e-9;
/// Least singular value, relative to the matrix, below which a mode counts as out of reach.
const OUT_OF_REACH: f64 = 1e-10;

/// Why there is no regulator.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LqrError {
    /// Matrices that do not fit each other.
    #[error("{name} is {rows} x {columns}; it must be {expected_rows} x {expected_columns}")]
    Shape {
        /// The matrix.
        name: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Rows that fit.
        expected_rows: usize,
        /// Columns that fit.
        expected_columns: usize,
    },
    /// An entry is infinite or NaN.
    #[error("{name} holds an entry that is not finite")]
    NonFinite {
        /// The matrix.
        name: &'static str,
    },
    /// A weight is not symmetric, Q has a negative or R a non-positive eigenvalue.
    #[error("the weight {name} must be symmetric and {must}; its least eigenvalue is {}", Shown(*least))]
    Weight {
        /// The matrix.
        name: &'static str,
        /// What it must be.
        must: &'static str,
        /// Its least eigenvalue; of an unsymmetric one that of its symmetric part.
        least: f64,
    },
    /// No input moves a mode that does not decay.
    #[error("not stabilizable: no input moves the mode {:+} {:+}i, which does not decay", Shown(*real), Shown(*imaginary))]
    NotStabilizable {
        /// Real part of its eigenvalue, in 1/s.
        real: f64,
        /// Imaginary part, in rad/s.
        imaginary: f64,
    },
    /// The weight Q does not see a mode that does not decay; of states that it does not see at all, one that grows.
    #[error("not detectable: no weighted state shows the mode {:+} {:+}i, which does not decay", Shown(*real), Shown(*imaginary))]
    NotDetectable {
        /// Real part of its eigenvalue, in 1/s.
        real: f64,
        /// Imaginary part, in rad/s.
        imaginary: f64,
    },
    /// The Riccati equation is too badly conditioned.
    #[error("the Riccati equation is solved to {} of its terms only, and the rightmost pole is {}", Shown(*residual), Shown(*rightmost))]
    Inaccurate {
        /// Residual over the largest term.
        residual: f64,
        /// Real part of the rightmost pole of the closed loop, in 1/s.
        rightmost: f64,
    },
}

/// A regulator, in the units of its matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Regulator {
    /// K, inputs × states: u = −K x.
    pub gain: DMatrix<f64>,
    /// X, states × states: the cost from x is xᵀXx.
    pub cost: DMatrix<f64>,
    /// Eigenvalues of A − B K, in 1/s, rightmost first.
    pub poles: Vec<Complex<f64>>,
    /// Residual of the Riccati equation over the largest of its terms, with every state measured by its weight.
    pub residual: f64,
}

/// The deviations that cost 1 for [`bryson`] by name, as [`ahv_core::GeneratedModel::DEVIATIONS`]; infinite where a state or
/// input is not listed.
pub fn deviations<V: Vector<f64>>(listed: &[(&str, f64)]) -> V {
    V::from_fn(|index| {
        let name = V::NAMES.get(index);
        let found = listed.iter().find(|(known, _)| Some(known) == name);
        found.map_or(f64::INFINITY, |&(_, deviation)| deviation)
    })
}

/// What Q and R of a quadratic cost may be made of: for each state and input the deviation that costs 1 (Bryson's rule).
///
/// A deviation that is not finite costs nothing.
pub fn bryson(deviations: &[f64]) -> DMatrix<f64> {
    let weights = deviations
        .iter()
        .map(|deviation| 1.0 / (deviation * deviation));
    DMatrix::from_diagonal(&DVector::from_iterator(deviations.len(), weights))
}

impl Regulator {
    /// The regulator of A (states × states) and B (states × inputs) for the weights Q (states × states, positive
    /// semidefinite) and R (inputs × inputs, positive definite).
    ///
    /// States that neither have a weight nor act on one that has, such as the position of a vehicle, change no cost: they have no
    /// gain, keep their poles, and move as they are driven.
    ///
    /// # Errors
    ///
    /// [`LqrError`]; a regulator is only returned with a residual below 10⁻⁹ and all poles that the weight sees in the left half
    /// plane.
    pub fn new(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
    ) -> Result<Self, LqrError> {
        check(a, b, q, r)?;
        let seen = seen(a, q);
        if !seen.is_empty() && seen.len() < a.nrows() {
            return Self::of_seen((a, b, q, r), &seen);
        }
        // Units of states differ by orders of magnitude: each state is measured by its weight.
        let d = scales(q);
        let inverse = d.map(f64::recip);
        let (to, from) = (DMatrix::from_diagonal(&d), DMatrix::from_diagonal(&inverse));
        let (a, b, q) = (&from * a * &to, &from * b, &to * q * &to);
        if let Some(Complex { re, im }) = out_of_reach(&a, &b) {
            return Err(LqrError::NotStabilizable {
                real: re,
                imaginary: im,
            });
        }
        if let Some(Complex { re, im }) = out_of_reach(&a.transpose(), &q) {
            return Err(LqrError::NotDetectable {
                real: re,
                imaginary: im,
            });
        }
        let unsolved = LqrError::Inaccurate {
            residual: 1.0,
            rightmost: f64::INFINITY,
        };
        let r_inverse = r.clone().try_inverse().ok_or_else(|| unsolved.clone())?;
        let s = &b * &r_inverse * b.transpose();
        let cost = stabilising(&a, &s, &q).ok_or(unsolved)?;
        let terms = [a.transpose() * &cost, &cost * &a, -(&cost * &s * &cost), q];
        let largest = terms.iter().map(DMatrix::amax).fold(0.0, f64::max);
        let residual = terms.iter().sum::<DMatrix<f64>>().amax() / largest;
        let gain = r_inverse * b.transpose() * &cost;
        let poles = eigenvalues(&(a - b * &gain));
        let rightmost = poles.first().map_or(f64::NEG_INFINITY, |pole| pole.re);
        if !(residual <= RESIDUAL && rightmost < 0.0) {
            return Err(LqrError::Inaccurate {
                residual,
                rightmost,
            });
        }
        Ok(Self {
            gain: gain * &from,
            cost: &from * cost * &from,
            poles,
            residual,
        })
    }
}

impl Regulator {
    /// The regulator where the weight sees these states alone: no other acts on them.
    fn of_seen(
        (a, b, q, r): (&DMatrix<f64>, &DMatrix<f64>, &DMatrix<f64>, &DMatrix<f64>),
        seen: &[usize],
    ) -> Result<Self, LqrError> {
        let hidden = (0..a.nrows()).filter(|state| !seen.contains(state));
        let hidden: Vec<usize> = hidden.collect();
        let hidden = a.select_rows(&hidden).select_columns(&hidden);
        let modes = eigenvalues(&hidden);
        let rightmost = modes.first().copied().unwrap_or_default();
        if rightmost.re > OUT_OF_REACH * hidden.norm() {
            return Err(LqrError::NotDetectable {
                real: rightmost.re,
                imaginary: rightmost.im,
            });
        }
        let square = |matrix: &DMatrix<f64>| matrix.select_rows(seen).select_columns(seen);
        let part = Self::new(&square(a), &b.select_rows(seen), &square(q), r)?;
        let mut gain = DMatrix::zeros(b.ncols(), a.nrows());
        let mut cost = DMatrix::zeros(a.nrows(), a.nrows());
        for (column, &state) in seen.iter().enumerate() {
            gain.set_column(state, &part.gain.column(column));
            for (row, &other) in seen.iter().enumerate() {
                cost[(other, state)] = part.cost[(row, column)];
            }
        }
        let poles = [modes, part.poles].concat();
        Ok(Self {
            gain,
            cost,
            poles: rightmost_first(poles),
            residual: part.residual,
        })
    }
}

/// The states with a weight, and those that act on them, through however many states.
fn seen(a: &DMatrix<f64>, q: &DMatrix<f64>) -> Vec<usize> {
    let n = a.nrows();
    let weighted = |state: usize| q.column(state).iter().any(|&entry| entry != 0.0);
    let mut open: Vec<usize> = (0..n).filter(|&state| weighted(state)).collect();
    let mut seen = vec![false; n];
    while let Some(state) = open.pop() {
        if !std::mem::replace(&mut seen[state], true) {
            open.extend((0..n).filter(|&other| a[(state, other)] != 0.0));
        }
    }
    (0..n).filter(|&state| seen[state]).collect()
}

/// Refuses what is no linear-quadratic problem.
fn check(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<(), LqrError> {
    let (n, m) = (a.nrows(), b.ncols());
    let shapes = [
        ("A", a, n, n),
        ("B", b, n, m),
        ("Q", q, n, n),
        ("R", r, m, m),
    ];
    for (name, matrix, expected_rows, expected_columns) in shapes {
        let (rows, columns) = matrix.shape();
        if (rows, columns) != (expected_rows, expected_columns) {
            return Err(LqrError::Shape {
                name,
                rows,
                columns,
                expected_rows,
                expected_columns,
            });
        }
        if matrix.iter().any(|entry| !entry.is_finite()) {
            return Err(LqrError::NonFinite { name });
        }
    }
    for (name, matrix, must, definite) in [
        ("Q", q, "positive semidefinite", false),
        ("R", r, "positive definite", true),
    ] {
        let symmetric = 0.5 * (matrix + matrix.transpose());
        let least = symmetric.symmetric_eigenvalues().min();
        let rounding = f64::EPSILON * n as f64 * matrix.amax();
        let fits = if definite {
            least > rounding
        } else {
            least >= -rounding
        };
        if symmetric != *matrix || !fits {
            return Err(LqrError::Weight { name, must, least });
        }
    }
    Ok(())
}

/// For each state what its weight makes 1; 1 where there is none.
fn scales(weight: &DMatrix<f64>) -> DVector<f64> {
    weight.diagonal().map(|weight| {
        if weight > 0.0 {
            weight.sqrt().recip()
        } else {
            1.0
        }
    })
}

/// Eigenvalues, rightmost first.
fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    rightmost_first(matrix.complex_eigenvalues().as_slice().to_vec())
}

fn rightmost_first(mut poles: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    poles.sort_by(|a, b| b.re.total_cmp(&a.re));
    poles
}

/// An eigenvalue of `a` that does not decay and for which [A − λI, B] loses rank (Popov, Belevitch and Hautus).
fn out_of_reach(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Option<Complex<f64>> {
    let n = a.nrows();
    let norm = a.norm() + b.norm();
    eigenvalues(a).into_iter().find(|&mode| {
        let mut pencil = DMatrix::zeros(n, n + b.ncols());
        pencil.columns_mut(0, n).copy_from(&a.map(Complex::from));
        pencil
            .columns_mut(n, b.ncols())
            .copy_from(&b.map(Complex::from));
        for index in 0..n {
            pencil[(index, index)] -= mode;
        }
        mode.re >= -OUT_OF_REACH * norm && pencil.singular_values().min() <= OUT_OF_REACH * norm
    })
}

/// X of AᵀX + XA − XSX + Q = 0 with A − SX stable; `None` if the sign function does not settle.
fn stabilising(a: &DMatrix<f64>, s: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let mut hamiltonian = DMatrix::zeros(2 * n, 2 * n);
    hamiltonian.view_mut((0, 0), (n, n)).copy_from(a);
    hamiltonian.view_mut((0, n), (n, n)).copy_from(&-s);
    hamiltonian.view_mut((n, 0), (n, n)).copy_from(&-q);
    hamiltonian
        .view_mut((n, n), (n, n))
        .copy_from(&-a.transpose());
    let sign = sign(hamiltonian)?;
    // The stable subspace is the kernel of sign + I: [W12; W22 + I] X = −[W11 + I; W21].
    let plus = sign + DMatrix::identity(2 * n, 2 * n);
    let solution = plus
        .columns(n, n)
        .svd(true, true)
        .solve(&-plus.columns(0, n), 0.0)
        .ok()?;
    Some(0.5 * (&solution + solution.transpose()))
}

/// Matrix sign by Newton's iteration; `None` if it does not settle, as with an eigenvalue on the imaginary axis.
fn sign(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.nrows();
    let mut current = matrix;
    for _ in 0..MOST_ITERATIONS {
        let lu = current.clone().lu();
        let inverse = lu.try_inverse()?;
        // The geometric mean of the eigenvalues' sizes, from the factors: a determinant may overflow.
        let logarithm: f64 = lu.u().diagonal().iter().map(|pivot| pivot.abs().ln()).sum();
        let scale = (-logarithm / size as f64).exp();
        let next = 0.5 * (scale * &current + inverse / scale);
        let change = (&next - &current).norm();
        current = next;
        if !change.is_finite() {
            return None;
        }
        if change <= SETTLED * current.norm() {
            return Some(current);
        }
    }
    None
}
