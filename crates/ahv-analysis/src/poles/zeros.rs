//! Invariant zeros, by a staircase reduction of the system pencil.

use nalgebra::{Complex, DMatrix};

use super::balance::{balance, similar};
use super::staircase::{Quadruple, reduce};
use super::{PolesError, eigen, frequency, told_from_zero};
use crate::linearize::LinearSystem;

/// An entry up to this many roundings of the whole pencil counts as 0 in a rank.
const ROUNDINGS: f64 = 100.0;

/// Singular value, as a share of the largest, below which a rank is lost.
const RANK: f64 = 1e-9;

/// Zeros of a system, and its structure at infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Zeros {
    /// Finite zeros, by rising frequency, multiple ones several times.
    pub finite: Vec<Zero>,
    /// Rank of the transfer matrix for almost every s.
    pub normal_rank: usize,
    /// Orders of the infinite zeros, ascending: how many integrations lie between the inputs and outputs.
    pub infinite_orders: Vec<usize>,
    /// Right Kronecker indices, ascending: one for each input beyond the rank.
    pub right_indices: Vec<usize>,
    /// Left Kronecker indices, ascending: one for each output beyond the rank.
    pub left_indices: Vec<usize>,
}

impl Zeros {
    /// Infinite eigenvalues of the pencil: one more than its order for each infinite zero, and one for each direct path
    /// from an input to an output.
    pub fn infinite(&self) -> usize {
        self.normal_rank + self.infinite_orders.iter().sum::<usize>()
    }
}

/// A finite zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Where the pencil loses rank, 1/s.
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

/// Invariant zeros of `system`: the s at which [A − s I, B; C, D] has a lower rank than elsewhere. Those that do not
/// decouple are its transmission zeros. There may be any numbers of inputs and outputs.
///
/// The pencil is balanced by powers of two, so that units do not matter. Its infinite and singular parts are taken away
/// by orthogonal transformations before an eigenvalue is computed. A zero that rounding cannot tell from 0 is 0.
///
/// # Errors
///
/// [`PolesError`]
pub fn zeros(system: &LinearSystem) -> Result<Zeros, PolesError> {
    let balanced = balanced(system);
    let pencil = balanced.pencil();
    let size = pencil.nrows().max(pencil.ncols()) as f64;
    let tolerance = ROUNDINGS * f64::EPSILON * size * pencil.norm();
    let n = balanced.a.nrows();
    let reduced = reduce(balanced, tolerance).ok_or(PolesError::AmbiguousRank)?;
    let mut finite: Vec<Zero> = finite(&reduced.regular)?
        .into_iter()
        .map(|value| {
            let value = told_from_zero(value, &pencil);
            let decoupling = decoupling(&pencil, n, value);
            Zero { value, decoupling }
        })
        .collect();
    finite.sort_by(|a, b| {
        let frequencies = frequency(a.value).total_cmp(&frequency(b.value));
        frequencies.then(b.value.im.total_cmp(&a.value.im))
    });
    Ok(Zeros {
        finite,
        normal_rank: reduced.regular.d.nrows(),
        infinite_orders: reduced.infinite_orders,
        right_indices: reduced.right_indices,
        left_indices: reduced.left_indices,
    })
}

impl Quadruple {
    /// [a, b; c, d].
    fn pencil(&self) -> DMatrix<f64> {
        let (n, m, p) = (self.a.nrows(), self.b.ncols(), self.c.nrows());
        let mut pencil = DMatrix::zeros(n + p, n + m);
        pencil.view_mut((0, 0), (n, n)).copy_from(&self.a);
        pencil.view_mut((0, n), (n, m)).copy_from(&self.b);
        pencil.view_mut((n, 0), (p, n)).copy_from(&self.c);
        pencil.view_mut((n, n), (p, m)).copy_from(&self.d);
        pencil
    }
}

/// The system with the effect of each input and each output of about unit length, then with its states balanced.
fn balanced(system: &LinearSystem) -> Quadruple {
    let (n, m, p) = (system.a.nrows(), system.b.ncols(), system.c.nrows());
    let mut scaled = Quadruple {
        a: system.a.clone(),
        b: system.b.clone(),
        c: system.c.clone(),
        d: system.d.clone(),
    };
    for input in 0..m {
        let factor = unit(scaled.b.column(input).norm());
        scaled.b.column_mut(input).scale_mut(factor);
        scaled.d.column_mut(input).scale_mut(factor);
    }
    for output in 0..p {
        let factor = unit(scaled.c.row(output).norm());
        scaled.c.row_mut(output).scale_mut(factor);
        scaled.d.row_mut(output).scale_mut(factor);
    }
    // Outputs without column and inputs without row keep their scale.
    let mut square = DMatrix::zeros(n + m + p, n + m + p);
    square.view_mut((0, 0), (n, n)).copy_from(&scaled.a);
    square.view_mut((0, n), (n, m)).copy_from(&scaled.b);
    square.view_mut((n + m, 0), (p, n)).copy_from(&scaled.c);
    let square = similar(&square, &balance(&square));
    Quadruple {
        a: square.view((0, 0), (n, n)).into_owned(),
        b: square.view((0, n), (n, m)).into_owned(),
        c: square.view((n + m, 0), (p, n)).into_owned(),
        d: scaled.d,
    }
}

/// The power of two that brings `norm` near 1; 1 for 0.
fn unit(norm: f64) -> f64 {
    if norm > 0.0 {
        (-norm.log2().round()).exp2()
    } else {
        1.0
    }
}

/// Zeros of a system whose d is square and regular: eigenvalues of the pencil on the kernel of [c, d].
fn finite(system: &Quadruple) -> Result<Vec<Complex<f64>>, PolesError> {
    let (n, rank) = (system.a.nrows(), system.d.nrows());
    if n == 0 {
        return Ok(Vec::new());
    }
    let pencil = system.pencil();
    let mut kernel = DMatrix::identity(n + rank, n + rank);
    let outputs = pencil.rows_range(n..).transpose();
    outputs.qr().q_tr_mul(&mut kernel);
    let kernel = kernel.rows_range(rank..).transpose();
    let carried = pencil.rows_range(..n) * &kernel;
    let square = kernel.rows(0, n).into_owned();
    let matrix = square.lu().solve(&carried);
    matrix
        .and_then(|matrix| eigen::values(&matrix))
        .ok_or(PolesError::NoConvergence)
}

/// Whether [A − s I, B] or [A − s I; C] loses rank at the zero s.
fn decoupling(pencil: &DMatrix<f64>, n: usize, zero: Complex<f64>) -> Option<Decoupling> {
    let mut shifted = pencil.map(Complex::from);
    for i in 0..n {
        shifted[(i, i)] -= zero;
    }
    if !full_rank(shifted.rows_range(..n).into_owned()) {
        Some(Decoupling::Input)
    } else if !full_rank(shifted.columns_range(..n).into_owned()) {
        Some(Decoupling::Output)
    } else {
        None
    }
}

fn full_rank(matrix: DMatrix<Complex<f64>>) -> bool {
    let values = matrix.singular_values();
    values.min() > RANK * values.max()
}
