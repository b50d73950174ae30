//! The equations of a trim, and their unknowns.

use ahv_core::{Bounds, DifferentiableModel, Real, Vector};
use nalgebra::{DMatrix, DVector};

use super::{Blocking, Nearest, SOUGHT_INPUTS, SteadyFlight, Trim, TrimError};

/// States that are given, not sought.
const GIVEN_STATES: [&str; 4] = ["velocity", "altitude", "gamma", "pitch_rate"];

/// Rows of the drift that hold by construction.
const REDUNDANT_ROWS: [&str; 2] = ["altitude", "alpha"];

/// Weight of the flexible rows: where there is no trim, the rigid body is off balance, not the modes.
const FLEXIBLE: f64 = 1e2;

/// A state with its input.
pub(super) struct Point<M: DifferentiableModel<Scalar = f64>> {
    pub(super) x: M::State,
    pub(super) u: M::Input,
}

impl<M: DifferentiableModel<Scalar = f64>> Clone for Point<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: DifferentiableModel<Scalar = f64>> Copy for Point<M> {}

/// Which components are unknowns, which rows are equations.
///
/// Unknowns and residuals are scaled throughout. The scale of the rows is that of the start, so that residuals of
/// different steps compare.
pub(super) struct System<'a, M> {
    model: &'a M,
    states: Vec<usize>,
    inputs: Vec<usize>,
    bounds: [Bounds; 2],
    rows: Vec<usize>,
    column_scale: DVector<f64>,
    row_scale: DVector<f64>,
}

impl<'a, M: DifferentiableModel<Scalar = f64>> System<'a, M> {
    pub(super) fn new(model: &'a M, flight: &SteadyFlight<M::Input>) -> Result<Self, TrimError> {
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
        let rows = without(&REDUNDANT_ROWS);
        let mut system = Self {
            model,
            states,
            inputs,
            bounds: flight.bounds,
            row_scale: DVector::from_element(rows.len(), 1.0),
            rows,
            column_scale,
        };
        system.row_scale = row_scale(&system.jacobian(&system.start(flight)?));
        let row = |name| system.rows.iter().position(|&row| names[row] == name);
        let rigid = ["velocity", "gamma", "pitch_rate"].map(row);
        for (index, scale) in system.row_scale.iter_mut().enumerate() {
            if !rigid.contains(&Some(index)) {
                *scale *= FLEXIBLE;
            }
        }
        // Accelerations along and across the path weigh alike: V̇ as V γ̇.
        if let [Some(along), Some(across), _] = rigid {
            system.row_scale[along] = system.row_scale[across] / flight.velocity;
        }
        Ok(system)
    }

    /// Where the search starts, if the drift is finite there.
    pub(super) fn start(&self, flight: &SteadyFlight<M::Input>) -> Result<Point<M>, TrimError> {
        let mut x = M::State::splat(0.0);
        for (name, value) in [
            ("velocity", flight.velocity),
            ("altitude", flight.altitude),
            ("gamma", flight.gamma),
        ] {
            M::State::index_of(name)
                .and_then(|index| x.set(index, value))
                .ok_or(TrimError::MissingName { name })?;
        }
        let u = flight.input;
        match self.model.drift(&x, &u).find(|it| !Real::is_finite(it)) {
            Some((name, value)) => Err(TrimError::NonFinite { name, value }),
            None => Ok(Point { x, u }),
        }
    }

    /// Scaled residuals; `None` where one is not finite.
    pub(super) fn residual(&self, point: &Point<M>) -> Option<DVector<f64>> {
        let residual = self.scaled(&self.model.drift(&point.x, &point.u));
        residual.iter().all(|it| it.is_finite()).then_some(residual)
    }

    /// The rows of a drift that are equations, scaled.
    pub(super) fn scaled(&self, drift: &M::State) -> DVector<f64> {
        let row = |(&index, scale): (&usize, &f64)| drift.get(index).unwrap_or(0.0) * scale;
        let rows = self.rows.iter().zip(&self.row_scale).map(row);
        DVector::from_iterator(self.rows.len(), rows)
    }

    /// Scaled residuals by scaled unknowns.
    pub(super) fn jacobian(&self, point: &Point<M>) -> DMatrix<f64> {
        let (by_state, by_input) = self.model.jacobians(&point.x, &point.u);
        DMatrix::from_fn(self.rows.len(), self.column_scale.len(), |row, column| {
            let index = self.rows[row];
            let entry = match self.states.get(column) {
                Some(&state) => by_state.get(index).and_then(|it: M::State| it.get(state)),
                None => by_input
                    .get(index)
                    .and_then(|it| it.get(self.inputs[column - self.states.len()])),
            };
            entry.unwrap_or(0.0) * self.row_scale[row] * self.column_scale[column]
        })
    }

    /// `point` moved by the scaled `step`.
    pub(super) fn moved(&self, point: &Point<M>, step: &DVector<f64>) -> Option<Point<M>> {
        let Point { mut x, mut u } = *point;
        let step = step.component_mul(&self.column_scale);
        let (by_state, by_input) = step.as_slice().split_at_checked(self.states.len())?;
        for (&index, change) in self.states.iter().zip(by_state) {
            x.set(index, x.get(index)? + change)?;
        }
        for (&index, change) in self.inputs.iter().zip(by_input) {
            u.set(index, u.get(index)? + change)?;
        }
        Some(Point { x, u })
    }

    /// Values of [`SOUGHT_INPUTS`].
    pub(super) fn sought_inputs(&self, point: &Point<M>) -> [f64; 2] {
        std::array::from_fn(|i| point.u.get(self.inputs[i]).unwrap_or(0.0))
    }

    /// Whether the sought inputs lie inside their bounds.
    pub(super) fn inside(&self, point: &Point<M>) -> bool {
        let mut pairs = self.bounds.iter().zip(self.sought_inputs(point));
        pairs.all(|(bounds, value)| bounds.contains(value))
    }

    /// The bounds outside which the sought inputs lie.
    pub(super) fn violated(&self, point: &Point<M>) -> Vec<Blocking> {
        let values = self.sought_inputs(point);
        let inputs = SOUGHT_INPUTS.into_iter().zip(values).zip(&self.bounds);
        let violated = inputs.filter_map(|((input, value), bounds)| {
            let upper = value > bounds.max;
            let bound = if upper { bounds.max } else { bounds.min };
            (upper || value < bounds.min).then_some(Blocking {
                input,
                bound,
                upper,
            })
        });
        violated.collect()
    }

    /// `point` with the sought inputs moved into their bounds.
    pub(super) fn clamped(&self, point: &Point<M>) -> Point<M> {
        let Point { x, mut u } = *point;
        let values = self.sought_inputs(point);
        for ((&index, value), bounds) in self.inputs.iter().zip(values).zip(&self.bounds) {
            // Unlike `clamp`, no panic where a caller's bounds are upside down.
            u.set(index, value.max(bounds.min).min(bounds.max));
        }
        Point { x, u }
    }

    /// For each unknown the bound that stops a descent along minus `gradient`.
    pub(super) fn stops(&self, point: &Point<M>, gradient: &DVector<f64>) -> Vec<Option<Blocking>> {
        let values = self.sought_inputs(point);
        let inputs = SOUGHT_INPUTS.into_iter().zip(values).zip(&self.bounds);
        let of_inputs = inputs.enumerate().map(|(i, ((input, value), bounds))| {
            let slope = gradient[self.states.len() + i];
            let (bound, upper) = match slope {
                _ if slope < 0.0 && value >= bounds.max => (bounds.max, true),
                _ if slope > 0.0 && value <= bounds.min => (bounds.min, false),
                _ => return None,
            };
            Some(Blocking {
                input,
                bound,
                upper,
            })
        });
        self.states.iter().map(|_| None).chain(of_inputs).collect()
    }

    pub(super) fn finish(&self, point: &Point<M>, iterations: usize) -> Trim<M::State, M::Input> {
        let residuals = self.residuals(point);
        Trim {
            state: point.x,
            input: point.u,
            residuals,
            residual_max: largest(&residuals),
            iterations,
        }
    }

    pub(super) fn describe(&self, point: &Point<M>, iterations: usize) -> Nearest {
        let residuals = self.residuals(point);
        let scaled = self.scaled(&self.model.drift(&point.x, &point.u));
        let size = |index: usize| residuals.get(self.rows[index]).map_or(0.0, f64::abs);
        // Where scaled ones are no numbers, the largest of those before scaling.
        let beyond = (0..self.rows.len()).filter(|&index| !scaled[index].is_finite());
        let beyond = beyond.max_by(|&a, &b| size(a).total_cmp(&size(b)));
        let worst = self.rows.get(beyond.unwrap_or_else(|| scaled.iamax()));
        Nearest {
            state: named(&point.x),
            input: named(&point.u),
            residuals: named(&residuals),
            residual_max: largest(&residuals),
            worst: worst
                .and_then(|&row| M::State::NAMES.get(row).copied())
                .unwrap_or_default(),
            iterations,
        }
    }

    /// The drift, of `altitude` less V sin γ.
    fn residuals(&self, point: &Point<M>) -> M::State {
        let mut drift = self.model.drift(&point.x, &point.u);
        let state = |name| M::State::index_of(name).and_then(|index| point.x.get(index));
        if let (Some(index), Some(velocity), Some(gamma)) = (
            M::State::index_of("altitude"),
            state("velocity"),
            state("gamma"),
        ) {
            let climb = velocity * Real::sin(gamma);
            drift.set(index, drift.get(index).unwrap_or(0.0) - climb);
        }
        drift
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
            // A row without entries has no scale of its own.
            if largest > 0.0 { 1.0 / largest } else { 1.0 }
        }),
    )
}

fn largest<X: Vector<f64>>(residuals: &X) -> f64 {
    let components = (0..X::LEN).filter_map(|index| residuals.get(index));
    components.fold(0.0, |worst: f64, it| worst.max(it.abs()))
}

fn named<V: Vector<f64>>(vector: &V) -> Vec<(&'static str, f64)> {
    let component = |(index, &name)| Some((name, vector.get(index)?));
    V::NAMES.iter().enumerate().filter_map(component).collect()
}
