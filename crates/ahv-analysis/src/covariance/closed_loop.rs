//! A flight and its linear closed loop: state and inputs together, with the root of their covariance.

use ahv_core::{DifferentiableModel, GeneratedModel, ModeOfMotion, StochasticModel, Vector};
use ahv_integrate::LinearTransition;
use nalgebra::{DMatrix, DVector};

use super::{CovarianceError, check, column, lyapunov, noise_intensity};
use crate::linearize::LinearSystem;
use crate::poles::poles;
use crate::values::{matrix, vector};

/// States and inputs that most models have at most: the smaller transition is for them.
const FEW: usize = 16;
/// States and inputs that a transition is made for.
const MOST: usize = 32;
/// Change in 1 s, relative to 1 or the value, from which a flight is not at rest.
const REST: f64 = 1e-6;
/// Least eigenvalue of a matrix of correlations that rounding explains.
const ROUNDING: f64 = -1e-10;

/// A state feedback through actuators without limits: u̇ = b (input − K (x − state − rate t) − u).
#[derive(Clone, Debug, PartialEq)]
pub struct Regulation {
    /// State that it leads to at time 0.
    pub state: Vec<f64>,
    /// Rate at which that state moves, in its unit per s.
    pub rate: Vec<f64>,
    /// Input at that state.
    pub input: Vec<f64>,
    /// K, inputs by states.
    pub gain: DMatrix<f64>,
    /// b, bandwidths of the actuators in rad/s; an input of bandwidth 0 is held.
    pub bandwidth: Vec<f64>,
}

/// A flight with held or regulated inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// State at time 0.
    pub start: Vec<f64>,
    /// Input at time 0.
    pub input: Vec<f64>,
    /// Covariance of states and inputs at time 0, states first.
    pub initial: DMatrix<f64>,
    /// What moves the inputs; without it they are held.
    pub feedback: Option<Regulation>,
    /// Longest step, in s.
    pub dt: f64,
}

/// A state on a flight, with the covariance of the deviations from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spreading {
    /// Time, in s.
    pub time: f64,
    /// The state without noise.
    pub state: Vec<f64>,
    /// Covariance of the states, in the units of the states over one another.
    pub covariance: DMatrix<f64>,
}

impl Spreading {
    /// Standard deviation of each state, in its own unit.
    pub fn std(&self) -> Vec<f64> {
        let variances = self.covariance.diagonal();
        variances.iter().map(|variance| variance.sqrt()).collect()
    }
}

/// State and input, as one column.
type Joint = DVector<f64>;

/// A model at a point, with the names of its states and inputs. What is written over it is compiled once for all models.
trait Point {
    fn states(&self) -> &'static [&'static str];

    fn inputs(&self) -> &'static [&'static str];

    /// Drift, its derivatives by state and input, and the intensity of the noise.
    fn at(&self, x: &[f64], u: &[f64]) -> (Joint, [DMatrix<f64>; 2], DMatrix<f64>);
}

impl<M: DifferentiableModel<Scalar = f64> + StochasticModel> Point for M {
    fn states(&self) -> &'static [&'static str] {
        M::State::NAMES
    }

    fn inputs(&self) -> &'static [&'static str] {
        M::Input::NAMES
    }

    fn at(&self, x: &[f64], u: &[f64]) -> (Joint, [DMatrix<f64>; 2], DMatrix<f64>) {
        let (x, u): (M::State, M::Input) = (vector(x), vector(u));
        let (drift, by_state, by_input) = self.drift_and_jacobians(&x, &u);
        let slopes = [
            matrix::<M::State, _>(&by_state),
            matrix::<M::Input, _>(&by_input),
        ];
        (column(&drift), slopes, noise_intensity(self, &x, &u))
    }
}

/// Rate, its derivatives and the intensity of the noise, of state and input together.
struct Linear {
    rate: Joint,
    a: DMatrix<f64>,
    intensity: DMatrix<f64>,
}

impl Flight {
    /// A flight from a state that is known exactly, with held inputs.
    pub fn new(start: Vec<f64>, input: Vec<f64>, dt: f64) -> Self {
        let size = start.len() + input.len();
        Self {
            start,
            input,
            initial: DMatrix::zeros(size, size),
            feedback: None,
            dt,
        }
    }

    /// State without noise and covariance at `times`, in s.
    ///
    /// Over a step A and G are those in the middle of it: the state moves by the exponential midpoint rule, the covariance by
    /// P ← Φ P Φᵀ + Q. Exact where A and G are constant, as at a trim, however fast a mode is; else of order 2 in the step.
    /// A root of P is propagated, so that P is positive semidefinite.
    ///
    /// # Errors
    ///
    /// [`CovarianceError::Times`], [`CovarianceError::StepTooLong`], [`CovarianceError::Diverged`], [`CovarianceError::Indefinite`],
    /// [`CovarianceError::TooLarge`].
    pub fn covariance<M>(&self, model: &M, times: &[f64]) -> Result<Vec<Spreading>, CovarianceError>
    where
        M: DifferentiableModel<Scalar = f64> + StochasticModel,
    {
        self.spread(model, times)
    }

    fn spread(&self, model: &dyn Point, times: &[f64]) -> Result<Vec<Spreading>, CovarianceError> {
        let states = model.states().len();
        let steps = self.steps(times)?;
        let mut root = self.root(states + model.inputs().len())?;
        let mut z = self.joint(model);
        let mut trajectory = Vec::with_capacity(times.len());
        let mut before = 0.0;
        for (&time, (count, dt)) in times.iter().zip(steps) {
            for step in 0..count {
                let at = before + step as f64 * dt;
                (z, root) = self.step(model, [at, dt], &z, &root, time)?;
            }
            before = time;
            let covariance = &root * root.transpose();
            let spreading = Spreading {
                time,
                state: z.iter().take(states).copied().collect(),
                covariance: of_states(&covariance, states),
            };
            spreading.check(model.states())?;
            trajectory.push(spreading);
        }
        Ok(trajectory)
    }

    /// The covariance of the states at which the linear closed loop about the start comes to rest. Held inputs do not spread.
    ///
    /// # Errors
    ///
    /// [`CovarianceError::NotAtRest`], [`CovarianceError::UndampedMode`] for a mode that does not decay, those of [`lyapunov`].
    pub fn stationary<M>(&self, model: &M) -> Result<DMatrix<f64>, CovarianceError>
    where
        M: GeneratedModel,
    {
        self.stationary_among(model, M::MODES)
    }

    /// As [`Self::stationary`], of a model with these modes.
    ///
    /// # Errors
    ///
    /// As [`Self::stationary`].
    pub fn stationary_among<M>(
        &self,
        model: &M,
        modes: &[ModeOfMotion],
    ) -> Result<DMatrix<f64>, CovarianceError>
    where
        M: DifferentiableModel<Scalar = f64> + StochasticModel,
    {
        self.rest(model, modes)
    }

    fn rest(
        &self,
        model: &dyn Point,
        modes: &[ModeOfMotion],
    ) -> Result<DMatrix<f64>, CovarianceError> {
        let states = model.states().len();
        let z = self.joint(model);
        let linear = self.linear(model, &z, 0.0);
        let names = names(model);
        for ((&name, &rate), &value) in names.iter().zip(linear.rate.iter()).zip(z.iter()) {
            let rests = rate.abs() <= REST * f64::max(1.0, value.abs());
            if !rests {
                return Err(CovarianceError::NotAtRest { name, rate });
            }
        }
        let moves = |&index: &usize| index < states || self.bandwidth(index - states) > 0.0;
        let moved: Vec<usize> = (0..names.len()).filter(moves).collect();
        let among = |matrix: &DMatrix<f64>| matrix.select_rows(&moved).select_columns(&moved);
        let system = LinearSystem {
            states: moved
                .iter()
                .filter_map(|&it| names.get(it).copied())
                .collect(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            a: among(&linear.a),
            b: DMatrix::zeros(moved.len(), 0),
            c: DMatrix::zeros(0, moved.len()),
            d: DMatrix::zeros(0, 0),
        };
        check("A", &system.a, moved.len())?;
        let poles = poles(&system, modes)?;
        let rightmost = poles
            .iter()
            .max_by(|p, q| p.value.re.total_cmp(&q.value.re));
        if let Some(pole) = rightmost.filter(|pole| pole.value.re >= 0.0) {
            return Err(CovarianceError::UndampedMode {
                mode: pole.mode.unwrap_or("actuator"),
                real: pole.value.re,
                imaginary: pole.value.im,
            });
        }
        let covariance = lyapunov(&system.a, &among(&linear.intensity))?;
        Ok(of_states(&covariance, states))
    }

    fn joint(&self, model: &dyn Point) -> Joint {
        let lengths = [model.states().len(), model.inputs().len()];
        let x = filled(&self.start, lengths[0]);
        let u = filled(&self.input, lengths[1]);
        Joint::from_iterator(lengths[0] + lengths[1], x.chain(u))
    }

    /// Bandwidth of an input's actuator; 0 where it is held.
    fn bandwidth(&self, input: usize) -> f64 {
        let feedback = self.feedback.as_ref();
        let bandwidth = feedback.and_then(|feedback| feedback.bandwidth.get(input));
        bandwidth.copied().unwrap_or(0.0)
    }

    fn linear(&self, model: &dyn Point, z: &Joint, time: f64) -> Linear {
        let (n, inputs, size) = (model.states().len(), model.inputs().len(), z.len());
        let (x, u) = z.as_slice().split_at(n);
        let (drift, [by_state, by_input], noise) = model.at(x, u);
        let mut a = DMatrix::zeros(size, size);
        a.view_mut((0, 0), (n, n)).copy_from(&by_state);
        a.view_mut((0, n), (n, inputs)).copy_from(&by_input);
        let mut rate = Joint::zeros(size);
        rate.rows_mut(0, n).copy_from(&drift);
        if let Some(feedback) = &self.feedback {
            let part =
                |values: &[f64], length| Joint::from_iterator(length, filled(values, length));
            let reference = part(&feedback.state, n) + part(&feedback.rate, n) * time;
            let command =
                part(&feedback.input, inputs) - &feedback.gain * (z.rows(0, n) - reference);
            for input in 0..inputs {
                let (row, bandwidth) = (n + input, self.bandwidth(input));
                rate[row] = bandwidth * (command[input] - z[row]);
                a[(row, row)] = -bandwidth;
                let gains = feedback.gain.row(input) * -bandwidth;
                a.view_mut((row, 0), (1, n)).copy_from(&gains);
            }
        }
        let mut intensity = DMatrix::zeros(size, size);
        intensity.view_mut((0, 0), (n, n)).copy_from(&noise);
        Linear { rate, a, intensity }
    }

    /// State and input, and the root of their covariance, after a step of `dt` from `at`, which ends at `time` at the latest.
    fn step(
        &self,
        model: &dyn Point,
        [at, dt]: [f64; 2],
        z: &Joint,
        root: &DMatrix<f64>,
        time: f64,
    ) -> Result<(Joint, DMatrix<f64>), CovarianceError> {
        let size = z.len();
        let start = self.linear(model, z, at);
        let half = 0.5 * dt;
        // Where a mode grows by a factor within half a step, an implicit step leads to the wrong side.
        let implicit = |a: &DMatrix<f64>| {
            let factors = (DMatrix::identity(size, size) - a * half).lu();
            let sound = factors.determinant() > 0.0;
            Some(factors)
                .filter(|_| sound)
                .ok_or(CovarianceError::StepTooLong { time, dt })
        };
        // Half a step by the implicit Euler method: no mode decays too fast for it.
        let slope = implicit(&start.a)?.solve(&start.rate);
        let middle = z + slope.ok_or(CovarianceError::StepTooLong { time, dt })? * half;
        finite(model, time, &middle)?;
        let linear = self.linear(model, &middle, at + half);
        implicit(&linear.a)?;
        let moved = match size {
            0..=FEW => transition::<FEW>(&linear.a, &linear.intensity, dt),
            _ => transition::<MOST>(&linear.a, &linear.intensity, dt),
        };
        let [transition, forced, added] = moved.ok_or(CovarianceError::StepTooLong { time, dt })?;
        let constant = linear.rate + linear.a * (z - &middle);
        let next = z + forced * constant;
        finite(model, time, &next)?;
        // [Φ L, L_Q] times its transpose is Φ P Φᵀ + Q; the triangle of its QR decomposition is a root of that.
        let mut roots = DMatrix::zeros(2 * size, size);
        let carried = transition * root;
        for (first, part) in [(0, carried), (size, added)] {
            roots
                .view_mut((first, 0), (size, size))
                .copy_from(&part.transpose());
        }
        Ok((next, roots.qr().unpack_r().transpose()))
    }

    /// A root of the initial covariance. Its correlations are factored, for units differ.
    fn root(&self, size: usize) -> Result<DMatrix<f64>, CovarianceError> {
        if size > MOST {
            return Err(CovarianceError::TooLarge {
                found: size,
                most: MOST,
            });
        }
        check("the initial covariance", &self.initial, size)?;
        let scale = self.initial.diagonal().map(
            |variance| {
                if variance > 0.0 { variance.sqrt() } else { 1.0 }
            },
        );
        let correlation = DMatrix::from_fn(size, size, |row, column| {
            self.initial[(row, column)] / (scale[row] * scale[column])
        });
        let eigen = correlation.symmetric_eigen();
        let least = eigen.eigenvalues.min();
        if least < ROUNDING {
            return Err(CovarianceError::Indefinite { least });
        }
        let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
        Ok(DMatrix::from_diagonal(&scale) * eigen.eigenvectors * DMatrix::from_diagonal(&roots))
    }

    /// Number and length of the steps to each time from the one before.
    fn steps(&self, times: &[f64]) -> Result<Vec<(u64, f64)>, CovarianceError> {
        let mut steps = Vec::with_capacity(times.len());
        let mut before = 0.0;
        for &time in times {
            let least = if time > before { 1.0 } else { 0.0 };
            let count = ((time - before) / self.dt - 1e-9).ceil().max(least);
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

impl Spreading {
    fn check(&self, names: &[&'static str]) -> Result<(), CovarianceError> {
        let variances = self.covariance.diagonal();
        let mut named = names.iter().zip(variances.iter());
        match named.find(|(_, value)| !value.is_finite()) {
            None => Ok(()),
            Some((&name, &value)) => Err(CovarianceError::Diverged {
                time: self.time,
                what: "variance",
                name,
                value,
            }),
        }
    }
}

/// Names of states and inputs.
fn names(model: &dyn Point) -> Vec<&'static str> {
    let names = model.states().iter().chain(model.inputs());
    names.copied().collect()
}

/// So many values; 0 for those that are missing.
fn filled(values: &[f64], length: usize) -> impl Iterator<Item = f64> {
    let missing = std::iter::repeat(0.0);
    values.iter().copied().chain(missing).take(length)
}

/// The part of the states of a matrix.
fn of_states(matrix: &DMatrix<f64>, states: usize) -> DMatrix<f64> {
    matrix.view((0, 0), (states, states)).into_owned()
}

fn finite(model: &dyn Point, time: f64, z: &Joint) -> Result<(), CovarianceError> {
    let mut named = names(model).into_iter().zip(z.iter());
    match named.find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((name, &value)) => Err(CovarianceError::Diverged {
            time,
            what: "value",
            name,
            value,
        }),
    }
}

/// Φ, what a constant becomes over a step, and a root of what the noise adds; `None` if the step is too long for them.
fn transition<const N: usize>(
    a: &DMatrix<f64>,
    intensity: &DMatrix<f64>,
    dt: f64,
) -> Option<[DMatrix<f64>; 3]> {
    let padded = |matrix: &DMatrix<f64>| -> [[f64; N]; N] {
        let entry = |row: usize, column: usize| matrix.get((row, column)).copied().unwrap_or(0.0);
        std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column)))
    };
    let found = LinearTransition::<f64, N>::new(padded(a), padded(intensity), dt).ok()?;
    let size = a.nrows();
    let trimmed =
        |matrix: &[[f64; N]; N]| DMatrix::from_fn(size, size, |row, column| matrix[row][column]);
    Some([found.transition(), found.forced(), found.root()].map(trimmed))
}
