//! Samples, read once: a triangle for each fold in the place of a million rows.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::FitError;
use crate::draw::mixed;

/// Folds of the cross-validation, unless others are asked for.
pub const FOLDS: usize = 10;

/// Rows that are reflected at a time.
const BLOCK: usize = 256;

/// The exponents of a monomial, in the order of the variables.
pub type Monomial = Vec<u32>;

/// Samples by columns. All columns have one length.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    /// Values of each variable.
    pub variables: &'a [Vec<f64>],
    /// Values of each quantity.
    pub responses: &'a [Vec<f64>],
    /// Weights of the squares; all equal without it.
    pub weights: Option<&'a [f64]>,
}

/// The value of a monomial at the values of its variables.
pub fn value(monomial: &[u32], point: impl IntoIterator<Item = f64>) -> f64 {
    let powers = monomial.iter().zip(point);
    // An exponent of a table is at most 9.
    powers.fold(1.0, |product, (&exponent, base)| {
        (0..exponent).fold(product, |product, _| product * base)
    })
}

/// What least squares need of samples: for each fold the triangle R of its rows (monomials, then quantities), X = Q R.
#[derive(Clone, Debug)]
pub struct Design {
    pub(crate) monomials: usize,
    pub(crate) rows: usize,
    /// Sum of the weights.
    pub(crate) weight: f64,
    pub(crate) folds: Vec<DMatrix<f64>>,
    /// For each fold the triangle of all other folds.
    pub(crate) others: Vec<DMatrix<f64>>,
    /// That of all rows.
    pub(crate) whole: DMatrix<f64>,
}

impl Design {
    /// Reads samples for quantities that are sums of some of these monomials, with so many folds, 2 at least.
    ///
    /// The rows of a fold depend on the rows' numbers alone, and a fold is read in order: the same bits whatever the threads.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] for a monomial that is infinite or NaN somewhere, or a quantity that is; [`FitError::Folds`] for fewer than 2
    /// folds, or more than rows.
    pub fn of(
        samples: &Samples<'_>,
        monomials: &[Monomial],
        folds: usize,
    ) -> Result<Self, FitError> {
        let rows = samples.responses.first().map_or(0, Vec::len);
        if !(2..=rows).contains(&folds) {
            return Err(FitError::Folds { folds, rows });
        }
        let triangles: Result<Vec<_>, FitError> = (0..folds)
            .into_par_iter()
            .map(|fold| triangle(samples, monomials, |row| fold_of(row, folds) == fold))
            .collect();
        let triangles = triangles?;
        let others = (0..folds).into_par_iter().map(|fold| {
            let rest = triangles.iter().enumerate();
            stacked(rest.filter(|(index, _)| *index != fold).map(|(_, it)| it))
        });
        let weights = samples.weights.map(|it| it.iter().sum());
        Ok(Self {
            monomials: monomials.len(),
            rows,
            weight: weights.unwrap_or(rows as f64),
            others: others.collect(),
            whole: stacked(&triangles),
            folds: triangles,
        })
    }
}

/// The fold of a row: neighbours of a grid are apart.
fn fold_of(row: usize, folds: usize) -> usize {
    (mixed(row as u64) % folds as u64) as usize
}

/// The triangle of the rows that are `wanted`.
fn triangle(
    samples: &Samples<'_>,
    monomials: &[Monomial],
    wanted: impl Fn(usize) -> bool,
) -> Result<DMatrix<f64>, FitError> {
    let width = monomials.len() + samples.responses.len();
    let mut sum = DMatrix::zeros(width, width);
    let mut block = DMatrix::zeros(width + BLOCK, width);
    let mut filled = 0;
    let rows = samples.responses.first().map_or(0, Vec::len);
    for row in (0..rows).filter(|&row| wanted(row)) {
        let root = samples.weights.map_or(1.0, |it| it[row].sqrt());
        let to = width + filled;
        for (column, monomial) in monomials.iter().enumerate() {
            let point = samples.variables.iter().map(|it| it[row]);
            block[(to, column)] = root * value(monomial, point);
        }
        for (response, values) in samples.responses.iter().enumerate() {
            block[(to, monomials.len() + response)] = root * values[row];
        }
        if let Some(column) = (0..width).find(|&it| !block[(to, it)].is_finite()) {
            return Err(FitError::NotFinite { row, column });
        }
        filled += 1;
        if filled == BLOCK {
            sum = reflected(&mut block, &sum);
            filled = 0;
        }
    }
    if filled > 0 {
        block.rows_mut(width + filled, BLOCK - filled).fill(0.0);
        sum = reflected(&mut block, &sum);
    }
    Ok(sum)
}

/// The triangle of a block whose first rows are those of `sum`.
fn reflected(block: &mut DMatrix<f64>, sum: &DMatrix<f64>) -> DMatrix<f64> {
    block.rows_mut(0, sum.nrows()).copy_from(sum);
    block.clone().qr().r()
}

/// The triangle of the rows of triangles.
fn stacked<'a>(triangles: impl IntoIterator<Item = &'a DMatrix<f64>>) -> DMatrix<f64> {
    let all: Vec<_> = triangles.into_iter().collect();
    let width = all.first().map_or(0, |it| it.ncols());
    let mut block = DMatrix::zeros(width * all.len(), width);
    for (index, triangle) in all.iter().enumerate() {
        block.rows_mut(index * width, width).copy_from(triangle);
    }
    block.qr().r()
}
