//! Steady level flight: the state and input at which nothing but the altitude's arc changes.
//!
//! Given are velocity, altitude and the inputs other than `phi` and `delta_e`. Flight path and pitch
//! rate are 0. Unknown are `alpha`, `phi`, `delta_e` and every flexible state. The equations are
//! all rows of the drift but two: `altitude`, which vanishes with the flight path, and `alpha`, which
//! is −γ̇ at zero pitch rate and repeats the row `gamma`. That leaves as many equations as unknowns.

use ahv_core::{DifferentiableModel, Real, Vector};
use nalgebra::{DMatrix, DVector};

/// Newton steps before the search gives up; from a cold start the models of this project need about six.
const MAX_ITERATIONS: usize = 50;

/// Halvings of a Newton step before the search gives up.
const MAX_HALVINGS: i32 = 30;

/// Largest admissible scaled residual: a trim is then known to about this fraction of [`scale`].
const TOLERANCE: f64 = 1e-12;

/// States that are given, not sought.
const GIVEN_STATES: [&str; 4] = ["velocity", "altitude", "gamma", "pitch_rate"];

/// Inputs that are sought; all others are held.
pub const SOUGHT_INPUTS: [&str; 2] = ["phi", "delta_e"];

/// Rows of the drift that hold by construction.
const REDUNDANT_ROWS: [&str; 2] = ["altitude", "alpha"];

/// Where to trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelFlight<U> {
    /// Velocity, in the model's unit.
    pub velocity: f64,
    /// Altitude, in the model's unit.
    pub altitude: f64,
    /// Inputs: `phi` and `delta_e` are where the search starts, all others are held.
    pub input: U,
}

impl<U: Vector<f64>> LevelFlight<U> {
    /// Level flight at `velocity` and `altitude`, in the model's units, all other inputs 0, with the customary cold start.
    pub fn new(velocity: f64, altitude: f64) -> Self {
        let start = |name| match name {
            "phi" => 0.25,
            "delta_e" => 0.2,
            _ => 0.0,
        };
        let input = U::from_fn(|index| U::NAMES.get(index).map_or(0.0, |name| start(name)));
        Self {
            velocity,
            altitude,
            input,
        }
    }
}

/// A converged trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim<X, U> {
    /// Trimmed state.
    pub state: X,
    /// Trimmed input.
    pub input: U,
    /// Largest component of the drift, all rows included, each in its own unit per second.
    pub residual_max: f64,
    /// Newton steps taken.
    pub iterations: usize,
}

/// Why there is no trim.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrimError {
    /// The model lacks a state or input that level flight is defined by.
    #[error("the model has no state or input called {name}")]
    MissingName {
        /// The name that was looked for.
        name: &'static str,
    },
    /// The equations and unknowns do not depend on each other.
    #[error("the trim equations are singular after {iterations} iterations")]
    Singular {
        /// Newton steps taken before.
        iterations: usize,
    },
    /// A derivative is infinite or NaN.
    #[error("the derivative of {name} became {value} after {iterations} iterations of the trim")]
    NonFinite {
        /// Row of the drift.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Newton steps taken before.
        iterations: usize,
    },
    /// No trim was found.
    #[error(
        "no trim after {iterations} iterations: the derivative of {name} is still {value} per second"
    )]
    NoConvergence {
        /// Newton steps taken.
        iterations: usize,
        /// The row of the drift that is worst after scaling.
        name: &'static str,
        /// Its value, in its own unit per second.
        value: f64,
    },
}

/// Finds steady level flight by a damped Newton method on the model's own Jacobians.
///
/// Rows and columns are scaled, and a step is halved until the scaled residual shrinks.
///
/// # Errors
///
/// [`TrimError`]; a trim is only returned with a scaled residual below 1e-12.
pub fn trim<M>(
    model: &M,
    flight: &LevelFlight<M::Input>,
) -> Result<Trim<M::State, M::Input>, TrimError>
where
    M: DifferentiableModel<Scalar = f64>,
{
    let system = System::new(model)?;
    let mut point = system.start(flight)?;
    let (mut residual, mut jacobian) = (system.residual(&point, 0)?, system.jacobian(&point));
    // Fixed by the start, so that residuals of different iterations compare.
    let row_scale = row_scale(&jacobian);
    let mut iterations = 0;
    loop {
        let scaled = residual.component_mul(&row_scale);
        if scaled.amax() <= TOLERANCE {
            return Ok(system.finish(&point, iterations));
        }
        if iterations == MAX_ITERATIONS {
            return Err(system.no_convergence(&residual, &scaled, iterations));
        }
        for (mut row, scale) in jacobian.row_iter_mut().zip(row_scale.iter()) {
            row *= *scale;
        }
        let step = jacobian
            .lu()
            .solve(&scaled)
            .filter(|step| step.iter().all(|component| component.is_finite()))
            .ok_or(TrimError::Singular { iterations })?;
        iterations += 1;
        (point, residual) = (0..=MAX_HALVINGS)
            .find_map(|halvings| {
                let next = system.moved(&point, &step, -libm::ldexp(1.0, -halvings))?;
                let next_residual = system.residual(&next, iterations).ok()?;
                let shrinks = next_residual.component_mul(&row_scale).norm() < scaled.norm();
                shrinks.then_some((next, next_residual))
            })
            .ok_or_else(|| system.no_convergence(&residual, &scaled, iterations))?;
        jacobian = system.jacobian(&point);
    }
}

/// Natural size of an unknown: a step of 1 in scaled terms.
fn scale(name: &str) -> f64 {
    match name {
        "alpha" | "delta_e" | "phi" => 0.1,
        _ => 1.0,
    }
}

/// Reciprocals of the rows' largest entries.
fn row_scale(jacobian: &DMatrix<f64>) -> DVector<f64> {
    DVector::from_iterator(
        jacobian.nrows(),
        jacobian.row_iter().map(|row| {
            let largest = row.amax();
            // A row without entries is singular; LU says so.
            if largest > 0.0 { 1.0 / largest } else { 1.0 }
        }),
    )
}

/// A state with its input.
struct Point<M: DifferentiableModel<Scalar = f64>> {
    x: M::State,
    u: M::Input,
}

/// Which components are unknowns, which rows are equations.
struct System<'a, M> {
    model: &'a M,
    states: Vec<usize>,
    inputs: Vec<usize>,
    rows: Vec<usize>,
    column_scale: DVector<f64>,
}

impl<'a, M: DifferentiableModel<Scalar = f64>> System<'a, M> {
    fn new(model: &'a M) -> Result<Self, TrimError> {
        let names = M::State::NAMES;
        let without = |excluded: &[&str]| -> Vec<usize> {
            (0..names.len())
                .filter(|&i| !excluded.contains(&names[i]))
                .collect()
        };
        for name in GIVEN_STATES.into_iter().chain(REDUNDANT_ROWS) {
            M::State::index_of(name).ok_or(TrimError::MissingName { name })?;
        }
        let inputs = SOUGHT_INPUTS
            .into_iter()
            .map(|name| M::Input::index_of(name).ok_or(TrimError::MissingName { name }))
            .collect::<Result<Vec<_>, _>>()?;
        let states = without(&GIVEN_STATES);
        let sought = states.iter().map(|&i| names[i]).chain(SOUGHT_INPUTS);
        let column_scale = DVector::from_iterator(states.len() + inputs.len(), sought.map(scale));
        Ok(Self {
            model,
            states,
            inputs,
            rows: without(&REDUNDANT_ROWS),
            column_scale,
        })
    }

    fn start(&self, flight: &LevelFlight<M::Input>) -> Result<Point<M>, TrimError> {
        let mut x = M::State::splat(0.0);
        for (name, value) in [("velocity", flight.velocity), ("altitude", flight.altitude)] {
            M::State::index_of(name)
                .and_then(|index| x.set(index, value))
                .ok_or(TrimError::MissingName { name })?;
        }
        Ok(Point { x, u: flight.input })
    }

    fn residual(&self, point: &Point<M>, iterations: usize) -> Result<DVector<f64>, TrimError> {
        let drift = self.model.drift(&point.x, &point.u);
        match drift.find(|component| !Real::is_finite(component)) {
            Some((name, value)) => Err(TrimError::NonFinite {
                name,
                value,
                iterations,
            }),
            None => Ok(self.equations(&drift)),
        }
    }

    fn equations(&self, drift: &M::State) -> DVector<f64> {
        let row = |&index: &usize| drift.get(index).unwrap_or(0.0);
        DVector::from_iterator(self.rows.len(), self.rows.iter().map(row))
    }

    /// Columns are scaled, rows are not.
    fn jacobian(&self, point: &Point<M>) -> DMatrix<f64> {
        let (by_state, by_input) = self.model.jacobians(&point.x, &point.u);
        let mut jacobian = DMatrix::zeros(self.rows.len(), self.column_scale.len());
        for (&index, mut row) in self.rows.iter().zip(jacobian.row_iter_mut()) {
            let states = by_state.get(index);
            let inputs = by_input.get(index);
            let by_state = self
                .states
                .iter()
                .map(|&i| states.and_then(|row| row.get(i)));
            let by_input = self
                .inputs
                .iter()
                .map(|&i| inputs.and_then(|row| row.get(i)));
            for ((entry, scale), value) in row
                .iter_mut()
                .zip(&self.column_scale)
                .zip(by_state.chain(by_input))
            {
                *entry = value.unwrap_or(0.0) * scale;
            }
        }
        jacobian
    }

    /// `point` moved by `length` along the scaled direction `step`.
    fn moved(&self, point: &Point<M>, step: &DVector<f64>, length: f64) -> Option<Point<M>> {
        let (mut x, mut u) = (point.x, point.u);
        let step = step.component_mul(&self.column_scale) * length;
        let (by_state, by_input) = step.as_slice().split_at_checked(self.states.len())?;
        for (&index, change) in self.states.iter().zip(by_state) {
            x.set(index, x.get(index)? + change)?;
        }
        for (&index, change) in self.inputs.iter().zip(by_input) {
            u.set(index, u.get(index)? + change)?;
        }
        Some(Point { x, u })
    }

    fn finish(&self, point: &Point<M>, iterations: usize) -> Trim<M::State, M::Input> {
        let drift = self.model.drift(&point.x, &point.u);
        let residuals = (0..M::State::LEN).filter_map(|index| drift.get(index));
        let residual_max = residuals.fold(0.0, |worst: f64, residual| worst.max(residual.abs()));
        Trim {
            state: point.x,
            input: point.u,
            residual_max,
            iterations,
        }
    }

    fn no_convergence(
        &self,
        residual: &DVector<f64>,
        scaled: &DVector<f64>,
        iterations: usize,
    ) -> TrimError {
        let worst = scaled.iamax();
        let row = self
            .rows
            .get(worst)
            .and_then(|&row| M::State::NAMES.get(row));
        TrimError::NoConvergence {
            iterations,
            name: row.copied().unwrap_or_default(),
            value: residual.get(worst).copied().unwrap_or_default(),
        }
    }
}
