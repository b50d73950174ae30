//! How the trim and the roots of a vehicle move with its parameters, to first order.
//!
//! The trim moves by the implicit function theorem, from the generated ∂f/∂p. The matrices of the linearisation change
//! with the parameter and with the trim: central differences of the exact Jacobians along both. A root of
//! det(S − λM) = 0 moves by wᴴ dS v / wᴴ M v with its left and right null vectors w and v.

use nalgebra::{Complex, DMatrix, DVector, FullPivLU};

/// Passes of the scaling of rows and columns.
const PASSES: usize = 6;

/// A difference of up to so many roundings of its terms counts as 0.
const ROUNDINGS: f64 = 100.0;

/// Smallest |wᴴ M v| / (|w| |M v|) of a root that is told apart from others.
const DISTINCT: f64 = 1e-10;

/// A vector of complex numbers.
type ComplexVector = DVector<Complex<f64>>;

/// A root λ of det(S − λM) = 0 with its null vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct RootVectors {
    left: ComplexVector,
    right: ComplexVector,
    weight: Complex<f64>,
}

impl RootVectors {
    /// The null vectors of S − λM for the root λ = `root` of S = `matrix` and M = `mass`, square and of one size: poles have
    /// M = 1, transmission zeros the pencil of the system and M = diag(1, 0).
    ///
    /// `None` for a root that is not simple, or not finite.
    pub fn new(matrix: &DMatrix<f64>, mass: &DMatrix<f64>, root: Complex<f64>) -> Option<Self> {
        let complex = |entry: f64| Complex::new(entry, 0.0);
        // What rounding leaves of a difference would grow when rows and columns are scaled.
        let mut shifted = matrix.zip_map(mass, |entry, mass| {
            let (entry, subtracted) = (complex(entry), root * mass);
            let (difference, size) = (entry - subtracted, entry.l1_norm() + subtracted.l1_norm());
            if difference.l1_norm() <= ROUNDINGS * f64::EPSILON * size {
                return Complex::ZERO;
            }
            difference
        });
        if shifted
            .iter()
            .any(|z| !(z.re.is_finite() && z.im.is_finite()))
        {
            return None;
        }
        let (rows, columns) = balance(&mut shifted);
        let (left, right) = null_vectors(shifted)?;
        let left = left.component_mul(&rows.map(complex));
        let right = right.component_mul(&columns.map(complex));
        let carried = mass.map(complex) * &right;
        let weight = left.dotc(&carried);
        let distinct = weight.re.hypot(weight.im) > DISTINCT * left.norm() * carried.norm();
        distinct.then_some(Self {
            left,
            right,
            weight,
        })
    }

    /// How the root moves when S changes by `change`.
    pub fn slope(&self, change: &DMatrix<f64>) -> Complex<f64> {
        let moved = change.map(|entry| Complex::new(entry, 0.0)) * &self.right;
        self.left.dotc(&moved) / self.weight
    }
}

/// Left and right null vector of a square matrix that is singular but for rounding: with complete pivoting the last pivot is
/// the one that counts as 0. `None` where another one is 0, too.
fn null_vectors(matrix: DMatrix<Complex<f64>>) -> Option<(ComplexVector, ComplexVector)> {
    let rest = matrix.nrows().checked_sub(1)?;
    let factors = FullPivLU::new(matrix);
    let (lower, upper) = (factors.l(), factors.u());
    let known = -upper.view((0, rest), (rest, 1));
    let right = upper
        .view((0, 0), (rest, rest))
        .solve_upper_triangular(&known)?;
    let mut right = right.column(0).push(Complex::ONE);
    factors.q().inv_permute_rows(&mut right);
    let mut left = DVector::zeros(rest + 1);
    left[rest] = Complex::ONE;
    let mut left = lower.adjoint().solve_upper_triangular(&left)?;
    factors.p().inv_permute_rows(&mut left);
    Some((left, right))
}

/// Scales rows and columns until their largest entries are near 1, and gives the factors (Ruiz 2001).
fn balance(matrix: &mut DMatrix<Complex<f64>>) -> (DVector<f64>, DVector<f64>) {
    let (mut rows, mut columns) = (
        DVector::from_element(matrix.nrows(), 1.0),
        DVector::from_element(matrix.ncols(), 1.0),
    );
    let factor = |largest: f64| {
        if largest > 0.0 {
            1.0 / largest.sqrt()
        } else {
            1.0
        }
    };
    let largest = |entries: &mut dyn Iterator<Item = &Complex<f64>>| {
        entries.map(|z| z.re.hypot(z.im)).fold(0.0, f64::max)
    };
    for _ in 0..PASSES {
        let of_rows: Vec<f64> = matrix
            .row_iter()
            .map(|row| factor(largest(&mut row.iter())))
            .collect();
        let of_columns: Vec<f64> = matrix
            .column_iter()
            .map(|column| factor(largest(&mut column.iter())))
            .collect();
        for (index, by) in of_rows.into_iter().enumerate() {
            matrix.row_mut(index).scale_mut(by);
            rows[index] *= by;
        }
        for (index, by) in of_columns.into_iter().enumerate() {
            matrix.column_mut(index).scale_mut(by);
            columns[index] *= by;
        }
    }
    (rows, columns)
}
