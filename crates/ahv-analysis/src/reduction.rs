//! Smaller linear systems in the place of large ones: balanced truncation and moment matching, with their errors.
//!
//! A system splits into a part whose poles lie in the left half plane and a rest, which is kept exactly. The stable part is
//! projected to fewer states. So the error is that of the stable part, and has norms though the system has none.

mod norms;

use nalgebra::{DMatrix, DVector, SVD, SymmetricEigen};

use crate::covariance::{CovarianceError, lyapunov};
use crate::poles::{PolesError, balance, eigen, similar};

pub use norms::{h_infinity, h2};

/// Real part, relative to the largest pole, from which a pole decays.
const DECAYS: f64 = 1e-9;
/// Steps of the iteration for the sign of a matrix; it converges quadratically.
const SIGN_STEPS: usize = 100;
/// Relative size of a direction or a Hankel singular value that rounding does not explain.
const RANK: f64 = 1e-12;

/// Part of the H∞ norm of a system below which rounding hides that of an error.
pub const H_INFINITY_RESOLUTION: f64 = 1e-8;
/// The same of H₂, whose square is computed.
pub const H2_RESOLUTION: f64 = 1e-5;

/// How a system is projected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReductionMethod {
    /// Balanced truncation (Moore 1981), by square roots of the Gramians (Tombs and Postlethwaite 1987).
    Balanced,
    /// The moments at zero frequency, from the Krylov space of A⁻¹ and A⁻¹ B. The other side of the projection is weighted by the
    /// observability Gramian, so that the result is stable (de Villemagne and Skelton 1987).
    Krylov,
}

impl ReductionMethod {
    /// All methods.
    pub const ALL: [Self; 2] = [Self::Balanced, Self::Krylov];

    /// Its name on command lines.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Balanced => "balanced",
            Self::Krylov => "krylov",
        }
    }
}

/// Why a system cannot be reduced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// As many states as there are stable ones, or none.
    #[error("the order must be from 1 to {most}, less than the {stable} states whose poles decay; it is {order}", most = stable.saturating_sub(1))]
    Order {
        /// The order that was asked for.
        order: usize,
        /// Number of stable states.
        stable: usize,
    },
    /// Fewer states do it all.
    #[error(
        "order {rank} reproduces the system to rounding: {order} states are not reached and seen from these inputs and outputs"
    )]
    Rank {
        /// The order that was asked for.
        order: usize,
        /// The largest with a meaning.
        rank: usize,
    },
    /// Poles much slower than others lose their sign.
    #[error(
        "with order {order} rounding makes a slow pole unstable: leave the slow states out, or choose another order or method"
    )]
    Rounding {
        /// The order that was asked for.
        order: usize,
    },
    /// The stable part cannot be told from the rest.
    #[error("the stable part cannot be split off: a pole lies too near the imaginary axis")]
    Split,
    /// A Gramian could not be computed.
    #[error(transparent)]
    Gramian(#[from] CovarianceError),
    /// The eigenvalues did not converge.
    #[error(transparent)]
    Poles(#[from] PolesError),
}

/// dx/dt = A x + B u, y = C x: what of a system its poles belong to.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// States by states, in 1/s.
    pub a: DMatrix<f64>,
    /// States by inputs.
    pub b: DMatrix<f64>,
    /// Outputs by states.
    pub c: DMatrix<f64>,
}

/// A system and its smaller one.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// What is kept exactly: the part whose poles do not decay. It may have no states.
    pub kept: Part,
    /// The part whose poles decay, before.
    pub stable: Part,
    /// The same, reduced.
    pub reduced: Part,
    /// Hankel singular values of the stable part, largest first, in the unit of an output over that of an input.
    pub hankel: Vec<f64>,
    /// Largest singular value of the error over all frequencies; `None` below [`H_INFINITY_RESOLUTION`].
    pub h_infinity_error: Option<f64>,
    /// The same of the stable part itself.
    pub h_infinity: f64,
    /// Root of the sum of the output variances of the error under unit white noise; `None` below [`H2_RESOLUTION`].
    pub h2_error: Option<f64>,
    /// The same of the stable part itself.
    pub h2: f64,
}

impl Part {
    /// Number of states.
    pub fn order(&self) -> usize {
        self.a.nrows()
    }

    /// Both side by side, whose outputs are the differences.
    fn minus(&self, other: &Self) -> Self {
        let (n, r) = (self.order(), other.order());
        let mut a = DMatrix::zeros(n + r, n + r);
        a.view_mut((0, 0), (n, n)).copy_from(&self.a);
        a.view_mut((n, n), (r, r)).copy_from(&other.a);
        let mut b = DMatrix::zeros(n + r, self.b.ncols());
        b.rows_mut(0, n).copy_from(&self.b);
        b.rows_mut(n, r).copy_from(&other.b);
        let mut c = DMatrix::zeros(self.c.nrows(), n + r);
        c.columns_mut(0, n).copy_from(&self.c);
        c.columns_mut(n, r).copy_from(&-&other.c);
        Self { a, b, c }
    }

    /// The projection of the system on the columns of `right` along `left`, whose product with them is the unit matrix.
    fn projected(&self, left: &DMatrix<f64>, right: &DMatrix<f64>) -> Self {
        Self {
            a: left.tr_mul(&self.a) * right,
            b: left.tr_mul(&self.b),
            c: &self.c * right,
        }
    }

    fn controllability(&self) -> Result<DMatrix<f64>, CovarianceError> {
        lyapunov(&self.a, &(&self.b * self.b.transpose()))
    }

    fn observability(&self) -> Result<DMatrix<f64>, CovarianceError> {
        lyapunov(&self.a.transpose(), &self.c.tr_mul(&self.c))
    }
}

impl Reduced {
    /// Reduces the stable part of a system to `order` states.
    ///
    /// # Errors
    ///
    /// [`ReductionError`]
    pub fn new(
        system: &Part,
        method: ReductionMethod,
        order: usize,
    ) -> Result<Self, ReductionError> {
        let [stable, kept] = split(system)?;
        if order == 0 || order >= stable.order() {
            return Err(ReductionError::Order {
                order,
                stable: stable.order(),
            });
        }
        let reach = root(&stable.controllability()?);
        let seen = stable.observability()?;
        let hankel = SVD::new(root(&seen).tr_mul(&reach), true, true);
        let (left, right) = match method {
            ReductionMethod::Balanced => balanced(&hankel, &root(&seen), &reach, order)?,
            ReductionMethod::Krylov => krylov(&stable, &seen, order)?,
        };
        let reduced = stable.projected(&left, &right);
        let poles = eigen::values(&reduced.a).ok_or(PolesError::NoConvergence)?;
        if poles.iter().any(|pole| pole.re >= 0.0) {
            return Err(ReductionError::Rounding { order });
        }
        let error = stable.minus(&reduced);
        let (largest, whole) = (h_infinity(&stable)?, h2(&stable)?);
        let shown = |error: f64, least: f64| (error > least).then_some(error);
        Ok(Self {
            hankel: hankel.singular_values.as_slice().to_vec(),
            h_infinity_error: shown(h_infinity(&error)?, H_INFINITY_RESOLUTION * largest),
            h_infinity: largest,
            h2_error: shown(h2(&error)?, H2_RESOLUTION * whole),
            h2: whole,
            kept,
            stable,
            reduced,
        })
    }

    /// Twice the sum of the Hankel singular values that balanced truncation leaves out: its error is at most that (Enns 1984).
    pub fn bound(&self) -> f64 {
        2.0 * self.hankel.iter().skip(self.reduced.order()).sum::<f64>()
    }
}

/// The part whose poles decay, and the rest, each in coordinates of its own.
fn split(system: &Part) -> Result<[Part; 2], ReductionError> {
    let n = system.order();
    let scale = balance(&system.a);
    let system = Part {
        a: similar(&system.a, &scale),
        b: DMatrix::from_fn(n, system.b.ncols(), |row, column| {
            system.b[(row, column)] / scale[row]
        }),
        c: DMatrix::from_fn(system.c.nrows(), n, |row, column| {
            system.c[(row, column)] * scale[column]
        }),
    };
    let poles = eigen::values(&system.a).ok_or(PolesError::NoConvergence)?;
    let fastest = poles
        .iter()
        .map(|it| it.re.hypot(it.im))
        .fold(0.0, f64::max);
    let decays = |real: &f64| *real < -DECAYS * fastest;
    let reals = || poles.iter().map(|it| it.re);
    let count = reals().filter(decays).count();
    let least = reals().filter(decays).fold(f64::NEG_INFINITY, f64::max);
    let rest = reals()
        .filter(|it| !decays(it))
        .fold(f64::INFINITY, f64::min);
    let empty = || Part {
        a: DMatrix::zeros(0, 0),
        b: DMatrix::zeros(0, system.b.ncols()),
        c: DMatrix::zeros(system.c.nrows(), 0),
    };
    if count == n {
        return Ok([system.clone(), empty()]);
    }
    if count == 0 {
        return Ok([empty(), system]);
    }
    let one = DMatrix::identity(n, n);
    let sign = sign(&system.a - &one * (0.5 * (least + rest)))?;
    let stable = range(&(&one - &sign), count);
    let rest = range(&(&one + &sign), n - count);
    let right = DMatrix::from_fn(n, n, |row, column| match column.checked_sub(count) {
        None => stable[(row, column)],
        Some(column) => rest[(row, column)],
    });
    let left = right
        .try_inverse()
        .ok_or(ReductionError::Split)?
        .transpose();
    let part = |columns: std::ops::Range<usize>, right: &DMatrix<f64>| {
        let (first, many) = (columns.start, columns.len());
        system.projected(&left.columns(first, many).into_owned(), right)
    };
    Ok([part(0..count, &stable), part(count..n, &rest)])
}

/// The sign of a matrix without eigenvalues on the imaginary axis: Newton's iteration, scaled by determinants.
fn sign(mut matrix: DMatrix<f64>) -> Result<DMatrix<f64>, ReductionError> {
    let n = matrix.nrows() as f64;
    for _ in 0..SIGN_STEPS {
        let lu = matrix.clone().lu();
        let size = lu.determinant().abs().powf(-1.0 / n);
        let inverse = lu.try_inverse().ok_or(ReductionError::Split)?;
        let size = if size.is_finite() && size > 0.0 {
            size
        } else {
            1.0
        };
        let next = (&matrix * size + inverse * (1.0 / size)) * 0.5;
        let change = (&next - &matrix).norm() / next.norm();
        matrix = next;
        if change <= f64::EPSILON.sqrt() {
            // One step more has all digits.
            let inverse = matrix.clone().try_inverse().ok_or(ReductionError::Split)?;
            return Ok((matrix + inverse) * 0.5);
        }
    }
    Err(ReductionError::Split)
}

/// An orthonormal basis of the `rank` largest directions of a matrix.
fn range(matrix: &DMatrix<f64>, rank: usize) -> DMatrix<f64> {
    let svd = SVD::new(matrix.clone(), true, false);
    let basis = svd.u.unwrap_or_else(|| matrix.clone());
    basis.columns(0, rank).into_owned()
}

/// L with L Lᵀ = the matrix, which is symmetric and has no negative eigenvalues but for rounding.
fn root(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let SymmetricEigen {
        eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(matrix.clone());
    eigenvectors * DMatrix::from_diagonal(&eigenvalues.map(|it| it.max(0.0).sqrt()))
}

/// Left and right side of a projection.
type Sides = (DMatrix<f64>, DMatrix<f64>);

/// The sides of balanced truncation, from the product of the Gramians' roots.
fn balanced(
    hankel: &SVD<f64, nalgebra::Dyn, nalgebra::Dyn>,
    seen: &DMatrix<f64>,
    reach: &DMatrix<f64>,
    order: usize,
) -> Result<Sides, ReductionError> {
    let values = &hankel.singular_values;
    let rank = values.iter().filter(|it| **it > RANK * values[0]).count();
    if order > rank {
        return Err(ReductionError::Rank { order, rank });
    }
    let scale: DVector<f64> = values.rows(0, order).map(|it| 1.0 / it.sqrt());
    let scale = DMatrix::from_diagonal(&scale);
    let (Some(u), Some(v)) = (&hankel.u, &hankel.v_t) else {
        return Err(ReductionError::Rank { order, rank: 0 });
    };
    let left = seen * u.columns(0, order) * &scale;
    let right = reach * v.rows(0, order).transpose() * &scale;
    Ok((left, right))
}

/// The sides of moment matching at zero frequency.
fn krylov(stable: &Part, seen: &DMatrix<f64>, order: usize) -> Result<Sides, ReductionError> {
    let lu = stable.a.clone().lu();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut block: Vec<DVector<f64>> = stable.b.column_iter().map(Into::into).collect();
    while basis.len() < order && !block.is_empty() {
        let mut next = Vec::new();
        for column in &block {
            let column = lu.solve(column).ok_or(ReductionError::Split)?;
            let size = column.norm();
            let mut rest = column;
            // Twice is enough (Kahan and Parlett).
            for _ in 0..2 {
                for known in basis.iter() {
                    rest -= known * known.dot(&rest);
                }
            }
            if rest.norm() > RANK * size && basis.len() < order {
                let direction = rest.normalize();
                basis.push(direction.clone());
                next.push(direction);
            }
        }
        block = next;
    }
    let rank = basis.len();
    if rank < order {
        return Err(ReductionError::Rank { order, rank });
    }
    let right = DMatrix::from_columns(&basis);
    let weighted = seen * &right;
    let inner = right.tr_mul(&weighted);
    let inverse = inner.try_inverse();
    let inverse = inverse.ok_or(ReductionError::Rank {
        order,
        rank: order - 1,
    })?;
    Ok((weighted * inverse, right))
}
