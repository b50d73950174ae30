//! Linear covariance: stationary, and along a trajectory.
//!
//! Deviations from a solution of dx = f dt + G dW follow d(δx) = A δx dt + G dW to first order, with A = ∂f/∂x and G at the
//! solution without noise. Their covariance is that of Ṗ = A P + P Aᵀ + G Gᵀ; of a stable linear system it comes to rest
//! where the right-hand side vanishes (Lyapunov).

mod monte_carlo;

use ahv_core::{DifferentiableModel, StochasticModel, Vector};
use nalgebra::{DMatrix, DVector};

pub use monte_carlo::{Ensemble, Sampled};

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
    #[error(
        "there is no stationary covariance: the pole {real:+} {imaginary:+}i does not lie in the left half plane"
    )]
    Unstable {
        /// Real part of the rightmost pole, in 1/s.
        real: f64,
        /// Its imaginary part, in rad/s.
        imaginary: f64,
    },
    /// The Lyapunov equation is too badly conditioned.
    #[error("the Lyapunov equation is solved to {residual:?} of its terms only")]
    Inaccurate {
        /// Residual over the largest term.
        residual: f64,
    },
    /// Times that do not ascend from 0, or a step that is not positive.
    #[error("times must ascend from 0 and the step be positive and finite")]
    Times,
    /// Too few members of an ensemble are left for a standard deviation.
    #[error(
        "at {time} s {left} of {members} flights are left, too few for a standard deviation: the others are no longer finite"
    )]
    BrokenDown {
        /// Time, in s.
        time: f64,
        /// Members whose state is finite.
        left: usize,
        /// Members in all.
        members: u64,
    },
    /// State or covariance is not finite, or a variance is negative: the step is too long, or the flight diverges.
    #[error("at {time} s the {what} of {name} is {value:?}")]
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
    let g = DMatrix::from_columns(&columns.collect::<Vec<_>>());
    &g * g.transpose()
}

/// A state on a trajectory, with the covariance of the deviations from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spreading<X> {
    /// Time, in s.
    pub time: f64,
    /// The state without noise.
    pub state: X,
    /// Covariance, in the units of the states over one another.
    pub covariance: DMatrix<f64>,
}

impl<X> Spreading<X> {
    /// Standard deviation of each state, in its own unit.
    pub fn std(&self) -> Vec<f64> {
        self.covariance
            .diagonal()
            .iter()
            .map(|p| p.sqrt())
            .collect()
    }
}

/// A flight that begins at a known state, with held inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight<X, U> {
    /// State at time 0.
    pub start: X,
    /// Held input.
    pub input: U,
    /// Longest step, in s.
    pub dt: f64,
}

impl<X: Vector<f64>, U: Vector<f64>> Flight<X, U> {
    /// State without noise and covariance at `times`, in s, from a start that is known exactly.
    ///
    /// The state by ẋ = f and the covariance by Ṗ = A P + P Aᵀ + G Gᵀ, together by the classical Runge–Kutta method.
    ///
    /// # Errors
    ///
    /// [`CovarianceError::Times`] and [`CovarianceError::Diverged`].
    pub fn covariance<M>(
        &self,
        model: &M,
        times: &[f64],
    ) -> Result<Vec<Spreading<X>>, CovarianceError>
    where
        M: DifferentiableModel<Scalar = f64, State = X, Input = U> + StochasticModel,
    {
        let steps = self.steps(times)?;
        let rate = |(x, p): &(X, DMatrix<f64>)| {
            let (drift, jacobian, _) = model.drift_and_jacobians(x, &self.input);
            let rows = (0..X::LEN).filter_map(|row| Some(column(&jacobian.get(row)?).transpose()));
            let carried = DMatrix::from_rows(&rows.collect::<Vec<_>>()) * p;
            let noise = noise_intensity(model, x, &self.input);
            (drift, &carried + carried.transpose() + noise)
        };
        let moved = |(x, p): &(X, DMatrix<f64>), (dx, dp): &(X, DMatrix<f64>), h: f64| {
            (x.zip_with(*dx, |x, d| x + h * d), p + dp * h)
        };
        let mut now = (self.start, DMatrix::zeros(X::LEN, X::LEN));
        let mut trajectory = Vec::with_capacity(times.len());
        for (&time, (count, dt)) in times.iter().zip(steps) {
            for _ in 0..count {
                let first = rate(&now);
                let second = rate(&moved(&now, &first, 0.5 * dt));
                let third = rate(&moved(&now, &second, 0.5 * dt));
                let fourth = rate(&moved(&now, &third, dt));
                for (slope, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
                    now = moved(&now, &slope, weight * dt / 6.0);
                }
            }
            finite(time, &now)?;
            trajectory.push(Spreading {
                time,
                state: now.0,
                covariance: now.1.clone(),
            });
        }
        Ok(trajectory)
    }

    /// Number and length of the steps to each time from the one before.
    fn steps(&self, times: &[f64]) -> Result<Vec<(u64, f64)>, CovarianceError> {
        let mut steps = Vec::with_capacity(times.len());
        let mut before = 0.0;
        for &time in times {
            let count = ((time - before) / self.dt - 1e-9).ceil().max(0.0);
            let sound = self.dt > 0.0 && time >= before && time.is_finite() && count < 1e9;
            if !sound {
                return Err(CovarianceError::Times);
            }
            steps.push((count as u64, (time - before) / count.max(1.0)));
            before = time;
        }
        Ok(steps)
    }
}

fn finite<X: Vector<f64>>(
    time: f64,
    (x, covariance): &(X, DMatrix<f64>),
) -> Result<(), CovarianceError> {
    let wrong = |what, found: Option<(&'static str, f64)>| match found {
        Some((name, value)) => Err(CovarianceError::Diverged {
            time,
            what,
            name,
            value,
        }),
        None => Ok(()),
    };
    wrong("value", x.find(|value| !value.is_finite()))?;
    let variance = |index: usize| covariance.get((index, index)).copied().unwrap_or(f64::NAN);
    // Rounding may leave a variance of 0 a little below it.
    let bad = |value: f64| !(value.is_finite() && value >= 0.0);
    wrong("variance", X::from_fn(variance).find(bad))
}

/// A vector whose components have names, as a column.
pub(crate) fn column<V: Vector<f64>>(vector: &V) -> DVector<f64> {
    DVector::from_iterator(V::LEN, (0..V::LEN).filter_map(|index| vector.get(index)))
}
