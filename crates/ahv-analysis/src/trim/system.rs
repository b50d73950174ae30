//! The equations of a trim, and their unknowns.

use ahv_core::{Bounds, DifferentiableModel, Equation, Real, Sought, Vector};
use nalgebra::{DMatrix, DVector};

use super::{Blocking, Nearest, SteadyState, Trim, TrimError};

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
    equations: &'static [Equation],
    moving: &'static [&'static str],
    /// Unknowns.
    sought: Vec<Sought>,
    states: Vec<usize>,
    inputs: Vec<usize>,
    /// Names of the inputs.
    input_names: Vec<&'static str>,
    bounds: Vec<Bounds>,
    rows: Vec<usize>,
    column_scale: DVector<f64>,
    row_scale: DVector<f64>,
}

impl<'a, M: DifferentiableModel<Scalar = f64>> System<'a, M> {
    pub(super) fn new(model: &'a M, flight: &SteadyState) -> Result<Self, TrimError> {
        let (mut states, mut inputs) = (Vec::new(), Vec::new());
        for name in flight.sought.iter().map(|it| it.name) {
            match (M::State::index_of(name), M::Input::index_of(name)) {
                (Some(state), _) => states.push(state),
                (None, Some(input)) => inputs.push(input),
                (None, None) => return Err(TrimError::MissingName { name }),
            }
        }
        let row = |name| M::State::index_of(name).ok_or(TrimError::MissingName { name });
        let rows = flight.equations.iter().map(|it| row(it.name));
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        let is_input = |name: &&str| M::State::index_of(name).is_none();
        let input_names: Vec<_> = flight.sought().filter(is_input).collect();
        let scales = flight.sought.iter().map(|it| it.scale);
        let mut system = Self {
            model,
            states,
            inputs,
            bounds: input_names.iter().map(|name| flight.bounds(name)).collect(),
            input_names,
            row_scale: DVector::from_element(rows.len(), 1.0),
            rows,
            column_scale: DVector::from_iterator(flight.sought.len(), scales),
            equations: flight.equations,
            moving: flight.moving,
            sought: flight.sought.clone(),
        };
        let start = system.start(flight)?;
        system.row_scale = row_scale(&system.jacobian(&start));
        system.weigh(&start);
        Ok(system)
    }

    /// Gives the rows their weights: first those that have a scale of their own.
    fn weigh(&mut self, start: &Point<M>) {
        let equations = self.equations;
        for (scale, equation) in self.row_scale.iter_mut().zip(equations) {
            *scale *= equation.weight;
        }
        for (index, equation) in equations.iter().enumerate() {
            let Some((row, state)) = equation.like else {
                continue;
            };
            let other = equations.iter().position(|it| it.name == row);
            let value = M::State::index_of(state).and_then(|index| start.x.get(index));
            if let (Some(other), Some(value)) = (other, value) {
                self.row_scale[index] = equation.weight * self.row_scale[other] / value;
            }
        }
    }

    /// Where the search starts, if the drift is finite there.
    pub(super) fn start(&self, flight: &SteadyState) -> Result<Point<M>, TrimError> {
        let mut x = M::State::splat(0.0);
        let sought = self.sought.iter().map(|it| (it.name, it.start));
        let is_state = |(name, _): &(&str, f64)| M::State::index_of(name).is_some();
        for (name, value) in sought.filter(is_state).chain(flight.given()) {
            M::State::index_of(name)
                .and_then(|index| x.set(index, value))
                .ok_or(TrimError::MissingName { name })?;
        }
        let u = flight.input();
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

    /// Values of the sought inputs.
    pub(super) fn sought_inputs(&self, point: &Point<M>) -> Vec<f64> {
        let value = |&index: &usize| point.u.get(index).unwrap_or(0.0);
        self.inputs.iter().map(value).collect()
    }

    /// The sought inputs by name.
    pub(super) fn named_inputs(&self, point: &Point<M>) -> Vec<(&'static str, f64)> {
        let names = self.input_names.iter().copied();
        names.zip(self.sought_inputs(point)).collect()
    }

    /// Whether the sought inputs lie inside their bounds.
    pub(super) fn inside(&self, point: &Point<M>) -> bool {
        let mut pairs = self.bounds.iter().zip(self.sought_inputs(point));
        pairs.all(|(bounds, value)| bounds.contains(value))
    }

    /// The bounds outside which the sought inputs lie.
    pub(super) fn violated(&self, point: &Point<M>) -> Vec<Blocking> {
        let values = self.sought_inputs(point);
        let inputs = self.input_names.iter().zip(values).zip(&self.bounds);
        let violated = inputs.filter_map(|((&input, value), bounds)| {
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
        let inputs = self.input_names.iter().zip(values).zip(&self.bounds);
        let of_inputs = inputs.enumerate().map(|(i, ((&input, value), bounds))| {
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

    /// The drift, 0 for the states that move.
    fn residuals(&self, point: &Point<M>) -> M::State {
        let drift = self.model.drift(&point.x, &point.u);
        let moves = |index: usize| {
            let name = M::State::NAMES.get(index);
            name.is_some_and(|name| self.moving.contains(name))
        };
        M::State::from_fn(|index| match drift.get(index) {
            Some(rate) if !moves(index) => rate,
            _ => 0.0,
        })
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
