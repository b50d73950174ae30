//! Linear covariance: along a flight, and stationary.
//!
//! Deviations from a solution of dx = f dt + G dW follow d(δx) = A δx dt + G dW to first order, with A = ∂f/∂x and G at the
//! solution without noise. Over a step with constant A and G the covariance goes from P to Φ P Φᵀ + Q, with Φ = exp(A h) and Q
//! the covariance that the noise adds (Van Loan 1978). Of a stable linear system it comes to rest where
//! A P + P Aᵀ + G Gᵀ vanishes (Lyapunov).

mod closed_loop;

use ahv_core::{Shown, StochasticModel, Vector};
use nalgebra::{DMatrix, DVector};

use crate::poles::PolesError;

pub use closed_loop::{Flight, Regulation, Spreading};

/// Largest residual of a stationary covariance, relative to the intensity of the noise and what it is balanced with.
const RESIDUAL: f64 = 1e-9;

/// Why there is no covariance.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CovarianceError {
    /// Matrices that do not fit each other.
    #[error("{name} is {rows} x {columns}; it must be {expected} x {expected}")]
    Shape {
        /// The matrix.
        name: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Number of states.
        expected: usize,
    },
    /// An entry is infinite or NaN.
    #[error("{name} holds an entry that is not finite")]
    NonFinite {
        /// The matrix.
        name: &'static str,
    },
    /// The system has no stationary covariance.
    #[error("there is no stationary covariance: the pole {:+} {:+}i does not lie in the left half plane", Shown(*real), Shown(*imaginary))]
    Unstable {
        /// Real part of the rightmost pole, in 1/s.
        real: f64,
        /// Its imaginary part, in rad/s.
        imaginary: f64,
    },
    /// The Lyapunov equation is too badly conditioned.
    #[error("the Lyapunov equation is solved to {} of its terms only", Shown(*residual))]
    Inaccurate {
        /// Residual over the largest term.
        residual: f64,
    },
    /// Times that do not ascend from 0, or a step that is not positive.
    #[error("times must ascend from 0 and the step be positive and finite")]
    Times,
    /// More states and inputs than transitions are made for.
    #[error("the model has {found} states and inputs; {most} at most are propagated")]
    TooLarge {
        /// States and inputs of the model.
        found: usize,
        /// The largest number of them.
        most: usize,
    },
    /// A covariance that no random numbers have.
    #[error("the initial covariance has the eigenvalue {} of its correlations; it must be 0 or more", Shown(*least))]
    Indefinite {
        /// Least eigenvalue of the correlations.
        least: f64,
    },
    /// The flight does not stay where it starts.
    #[error("there is no stationary covariance: the flight is not at rest, {name} changes by {} per s", Shown(*rate))]
    NotAtRest {
        /// Name of the state or input.
        name: &'static str,
        /// Its rate, in its unit per s.
        rate: f64,
    },
    /// A mode of the flight does not decay.
    #[error("there is no stationary covariance: the {mode} mode has the pole {:+.6} {:+.6}i 1/s, which does not decay", Shown(*real), Shown(*imaginary))]
    UndampedMode {
        /// The mode.
        mode: &'static str,
        /// Real part of its pole, in 1/s.
        real: f64,
        /// Imaginary part, in rad/s.
        imaginary: f64,
    },
    /// The poles could not be found.
    #[error(transparent)]
    Poles(#[from] PolesError),
    /// A mode grows by a factor within the step.
    #[error("before {} s a mode grows too fast for the step of {} s: shorten it, or end before the flight diverges", Shown(*time), Shown(*dt))]
    StepTooLong {
        /// In s.
        time: f64,
        /// The step, in s.
        dt: f64,
    },
    /// State or covariance is not finite: the step is too long, or the flight diverges.
    #[error("at {} s the {what} of {name} is {}", Shown(*time), Shown(*value))]
    Diverged {
        /// In s.
        time: f64,
        /// `value` or `variance`.
        what: &'static str,
        /// Name of the state.
        name: &'static str,
        /// Its value or variance.
        value: f64,
    },
}

/// P of A P + P Aᵀ + Q = 0: the stationary covariance of dx = A x dt + dβ with a noise β of intensity Q = G Gᵀ.
///
/// `a` in 1/s, `intensity` in the unit of x squared per s. Solved as one linear system of n² equations (Kronecker
/// sum): meant for n up to about 30.
///
/// # Errors
///
/// [`CovarianceError`] for shapes that do not fit, entries that are not finite, a system that is not stable, and an equation that
/// rounding spoils.
pub fn lyapunov(
    a: &DMatrix<f64>,
    intensity: &DMatrix<f64>,
) -> Result<DMatrix<f64>, CovarianceError> {
    let n = a.nrows();
    check("A", a, n)?;
    check("Q", intensity, n)?;
    let poles = a.clone().complex_eigenvalues();
    if let Some(pole) = poles.iter().max_by(|p, q| p.re.total_cmp(&q.re))
        && pole.re >= 0.0
    {
        return Err(CovarianceError::Unstable {
            real: pole.re,
            imaginary: pole.im,
        });
    }
    let one = DMatrix::identity(n, n);
    let sum = one.kronecker(a) + a.kronecker(&one);
    let right = DVector::from_column_slice((-intensity).as_slice());
    let solution = sum
        .full_piv_lu()
        .solve(&right)
        .unwrap_or_else(|| DVector::from_element(n * n, f64::NAN));
    let p = DMatrix::from_column_slice(n, n, solution.as_slice());
    let p = (&p + p.transpose()) * 0.5;
    let carried = a * &p;
    let largest = carried.amax().max(intensity.amax());
    let residual = (&carried + carried.transpose() + intensity).amax() / largest;
    // A residual of NaN is none that is small.
    if largest == 0.0 || residual <= RESIDUAL {
        Ok(p)
    } else {
        Err(CovarianceError::Inaccurate { residual })
    }
}

fn check(name: &'static str, matrix: &DMatrix<f64>, n: usize) -> Result<(), CovarianceError> {
    if matrix.shape() != (n, n) {
        return Err(CovarianceError::Shape {
            name,
            rows: matrix.nrows(),
            columns: matrix.ncols(),
            expected: n,
        });
    }
    if matrix.iter().all(|entry| entry.is_finite()) {
        Ok(())
    } else {
        Err(CovarianceError::NonFinite { name })
    }
}

/// G Gᵀ at (x, u): the intensity of the noise, in the units of the states over one another, per s.
pub fn noise_intensity<M: StochasticModel<Scalar = f64>>(
    model: &M,
    x: &M::State,
    u: &M::Input,
) -> DMatrix<f64> {
    let columns = (0..M::Noise::LEN).map(|channel| {
        let unit = M::Noise::from_fn(|other| if other == channel { 1.0 } else { 0.0 });
        column(&model.noise_increment(x, u, &unit))
    });
    // A model may have no channel.
    let none = DMatrix::zeros(M::State::LEN, M::State::LEN);
    columns.fold(none, |sum, g| sum + &g * g.transpose())
}

/// A vector whose components have names, as a column.
pub(crate) fn column<V: Vector<f64>>(vector: &V) -> DVector<f64> {
    DVector::from_iterator(V::LEN, (0..V::LEN).filter_map(|index| vector.get(index)))
}
