//! One quantity's least squares.

use nalgebra::{DMatrix, DVector};

use crate::constraint::{Constraint, Map, signed_least};
use crate::design::Design;

/// Relative size of a singular value, of columns of length 1, below which samples do not tell monomials apart.
const RANK: f64 = 1e-11;

/// Share of a null vector's largest entry from which on a monomial is named.
const NAMED: f64 = 0.1;

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A number is infinite or NaN: a monomial, or a quantity counted after the monomials.
    #[error("row {row}: column {column} of the design is not a finite number")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// Column.
        column: usize,
    },
    /// More or fewer folds than there can be.
    #[error(
        "{rows} samples cannot be cut into {folds} folds: 2 at least, and no more than samples"
    )]
    Folds {
        /// Folds asked for.
        folds: usize,
        /// Samples.
        rows: usize,
    },
    /// There are not more samples than coefficients.
    #[error("{rows} samples do not determine {coefficients} coefficients")]
    TooFew {
        /// Samples.
        rows: usize,
        /// Coefficients that are free.
        coefficients: usize,
    },
    /// The samples do not tell these monomials apart, numbered as the columns of the problem.
    #[error("the samples do not tell the monomials {0:?} apart")]
    RankDeficient(Vec<usize>),
    /// Two constraints on one coefficient, or a multiple of a multiple.
    #[error("coefficient {0} has two constraints")]
    Contradiction(usize),
    /// Rounding left no solution.
    #[error("no least squares were found")]
    NoSolution,
}

/// One quantity and the monomials that it is a sum of.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    design: &'a Design,
    response: usize,
    columns: Vec<usize>,
}

/// A fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Coefficients.
    pub values: Vec<f64>,
    /// Covariance of the coefficients if residuals are independent, of equal variance: s² (XᵀWX)⁻¹ on what the constraints leave free.
    pub covariance: DMatrix<f64>,
    /// By how much each coefficient alone must change to move the quantity by as much as the residual, as root mean squares.
    pub reach: Vec<f64>,
    /// Root of the weighted mean of the squared residuals.
    pub residual: f64,
    /// The same of samples that were left out of the fit, by folds.
    pub cross_validated: f64,
    /// Ratio of the largest to the smallest singular value of the design, of columns of length 1.
    pub condition: f64,
    /// Samples less free coefficients.
    pub degrees: usize,
    /// Which coefficients a sign constraint holds at 0.
    pub held: Vec<bool>,
}

impl Estimate {
    /// Standard errors of the coefficients.
    #[must_use]
    pub fn errors(&self) -> Vec<f64> {
        let variances = self.covariance.diagonal();
        variances.iter().map(|it| it.max(0.0).sqrt()).collect()
    }
}

/// A solution on one triangle.
struct Solved {
    values: DVector<f64>,
    held: Vec<bool>,
    /// Of the free coefficients that are not held: the map from them, and the design that they have.
    map: DMatrix<f64>,
    design: DMatrix<f64>,
}

impl<'a> Problem<'a> {
    /// Quantity `response` as a sum of the monomials `columns`, both numbered as in the design.
    #[must_use]
    pub fn new(design: &'a Design, response: usize, columns: &[usize]) -> Self {
        Self {
            design,
            response,
            columns: columns.to_vec(),
        }
    }

    /// The least squares under constraints.
    ///
    /// # Errors
    ///
    /// [`FitError`]: too few samples, monomials that they do not tell apart, constraints that contradict each other.
    pub fn solve(&self, constraints: &[Constraint]) -> Result<Estimate, FitError> {
        let design = self.design;
        let (a, z) = self.parts(&design.whole);
        let map = Map::new(self.columns.len(), constraints)?;
        let free = map.matrix.ncols();
        if design.rows <= free {
            return Err(FitError::TooFew {
                rows: design.rows,
                coefficients: free,
            });
        }
        let condition = condition(&(&a * &map.matrix)).map_err(|null| {
            let named = (0..self.columns.len())
                .filter(|&row| null.iter().any(|&it| map.matrix[(row, it)] != 0.0));
            FitError::RankDeficient(named.collect())
        })?;
        let solved = solved(&a, &z, &map)?;
        let residual = (&a * &solved.values - &z).norm_squared();
        let moving = solved.design.ncols();
        let degrees = design.rows - moving;
        let variance = residual / degrees as f64;
        let root = inverse(&solved.design)?;
        let map_root = &solved.map * root;
        let mean = |sum: f64| (sum / design.weight).sqrt();
        let reach = (0..a.ncols()).map(|it| mean(residual) / mean(a.column(it).norm_squared()));
        Ok(Estimate {
            covariance: &map_root * map_root.transpose() * variance,
            reach: reach.collect(),
            residual: mean(residual),
            cross_validated: mean(self.left_out(&map)?),
            condition,
            degrees,
            held: solved.held,
            values: solved.values.iter().copied().collect(),
        })
    }

    /// Sum of the squared residuals of samples that were left out, fold by fold.
    fn left_out(&self, map: &Map) -> Result<f64, FitError> {
        let pairs = self.design.others.iter().zip(&self.design.folds);
        let square = pairs.map(|(others, fold)| {
            let (a, z) = self.parts(others);
            let values = solved(&a, &z, map)?.values;
            let (a, z) = self.parts(fold);
            Ok((a * values - z).norm_squared())
        });
        square.sum()
    }

    /// The cross-validated residual without constraints; infinite where a fold's rest does not determine the coefficients.
    pub(crate) fn cross_validated(&self) -> f64 {
        let free = Map::new(self.columns.len(), &[]);
        let sum = free.and_then(|free| self.left_out(&free));
        sum.map_or(f64::INFINITY, |sum| (sum / self.design.weight).sqrt())
    }

    /// The columns of the monomials and of the quantity.
    fn parts(&self, triangle: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
        let response = self.design.monomials + self.response;
        (
            triangle.select_columns(&self.columns),
            triangle.column(response).into_owned(),
        )
    }
}

fn solved(a: &DMatrix<f64>, z: &DVector<f64>, map: &Map) -> Result<Solved, FitError> {
    let design = a * &map.matrix;
    let aim = z - a * &map.offset;
    let (t, held) = signed_least(&design, &aim, &map.signed).ok_or(FitError::NoSolution)?;
    let moving: Vec<usize> = (0..t.len()).filter(|&it| !held[it]).collect();
    let of_held = |row: usize| (0..t.len()).any(|it| held[it] && map.matrix[(row, it)] != 0.0);
    Ok(Solved {
        values: &map.matrix * &t + &map.offset,
        held: (0..a.ncols()).map(of_held).collect(),
        map: map.matrix.select_columns(&moving),
        design: design.select_columns(&moving),
    })
}

/// The inverse of the triangle of a design.
fn inverse(design: &DMatrix<f64>) -> Result<DMatrix<f64>, FitError> {
    let count = design.ncols();
    if count == 0 {
        return Ok(DMatrix::zeros(0, 0));
    }
    let triangle = design.clone().qr().r();
    let whole = DMatrix::identity(count, count);
    let found = triangle.solve_upper_triangular(&whole);
    found.ok_or(FitError::NoSolution)
}

/// The condition of a design of columns of length 1; the columns that it does not tell apart if there are some.
fn condition(design: &DMatrix<f64>) -> Result<f64, Vec<usize>> {
    let mut unit = design.clone();
    let mut none = Vec::new();
    for (index, mut column) in unit.column_iter_mut().enumerate() {
        let norm = column.norm();
        if norm > 0.0 {
            column /= norm;
        } else {
            none.push(index);
        }
    }
    if !none.is_empty() {
        return Err(none);
    }
    if unit.ncols() == 0 {
        return Ok(1.0);
    }
    let svd = unit.svd(false, true);
    let (least, greatest) = (svd.singular_values.argmin(), svd.singular_values.max());
    if least.1 > RANK * greatest {
        return Ok(greatest / least.1);
    }
    let null = svd.v_t.map(|it| it.row(least.0).into_owned());
    let null: Vec<f64> = null
        .into_iter()
        .flat_map(|it| it.iter().copied().collect::<Vec<_>>())
        .collect();
    let largest = null.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let named = null.iter().enumerate();
    let named = named.filter(|(_, it)| it.abs() > NAMED * largest);
    Err(named.map(|(index, _)| index).collect())
}
