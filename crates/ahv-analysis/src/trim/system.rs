//! The equations of a trim, and their unknowns.

use ahv_core::{Bounds, Equation, GeneratedModel, Real, Sought, Vector};
use nalgebra::{DMatrix, DVector};

use super::{Blocking, Nearest, SteadyState, Trim, TrimError};
use crate::dual::output_slopes;

/// A state with its input.
pub(super) struct Point<M: GeneratedModel> {
    pub(super) x: M::State,
    pub(super) u: M::Input,
}

impl<M: GeneratedModel> Clone for Point<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: GeneratedModel> Copy for Point<M> {}

/// Where an equation stands: in a row of the drift, or in an output.
#[derive(Clone, Copy)]
pub(super) enum Source {
    Rate(usize),
    Output(usize),
}

impl Source {
    fn of<M: GeneratedModel>(name: &'static str) -> Result<Self, TrimError> {
        let rate = M::State::index_of(name).map(Self::Rate);
        rate.or_else(|| M::OutputsOf::<f64>::index_of(name).map(Self::Output))
            .ok_or(TrimError::MissingName { name })
    }

    const fn is_output(self) -> bool {
        matches!(self, Self::Output(_))
    }

    /// Its component of the drift and the outputs.
    pub(super) fn value<X: Vector<f64>, Y: Vector<f64>>(self, drift: &X, outputs: &Y) -> f64 {
        let value = match self {
            Self::Rate(index) => drift.get(index),
            Self::Output(index) => outputs.get(index),
        };
        value.unwrap_or(0.0)
    }
}

/// An equation: what has a value, which value that is, and how it is measured.
struct Row {
    source: Source,
    value: f64,
    equation: Equation,
}

/// Which components are unknowns, which rows and outputs are equations.
///
/// Unknowns and residuals are scaled throughout. The scale of the rows is that of the start, so that residuals of
/// different steps compare.
pub(super) struct System<'a, M> {
    model: &'a M,
    moving: &'static [&'static str],
    /// Unknowns.
    sought: Vec<Sought>,
    states: Vec<usize>,
    inputs: Vec<usize>,
    /// Names of the inputs.
    input_names: Vec<&'static str>,
    bounds: Vec<Bounds>,
    rows: Vec<Row>,
    column_scale: DVector<f64>,
    row_scale: DVector<f64>,
}

impl<'a, M: GeneratedModel> System<'a, M> {
    pub(super) fn new(model: &'a M, flight: &SteadyState) -> Result<Self, TrimError> {
        let (mut states, mut inputs) = (Vec::new(), Vec::new());
        for name in flight.sought.iter().map(|it| it.name) {
            match (M::State::index_of(name), M::Input::index_of(name)) {
                (Some(state), _) => states.push(state),
                (None, Some(input)) => inputs.push(input),
                (None, None) => return Err(TrimError::MissingName { name }),
            }
        }
        let rows = rows::<M>(flight)?;
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
        for (scale, row) in self.row_scale.iter_mut().zip(&self.rows) {
            *scale *= row.equation.weight;
        }
        for (index, Row { equation, .. }) in self.rows.iter().enumerate() {
            let Some((row, state)) = equation.like else {
                continue;
            };
            let other = self.rows.iter().position(|it| it.equation.name == row);
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
        for (name, value) in sought.chain(flight.given()) {
            // Other names are those of inputs and outputs.
            M::State::index_of(name).and_then(|index| x.set(index, value));
        }
        let point = Point {
            x,
            u: flight.input(),
        };
        let drift = self.model.drift(&x, &point.u);
        let equations = self.rows.iter().map(|row| row.equation.name);
        let mut left = equations.zip(self.left(&point));
        let rate = drift.find(|it| !Real::is_finite(it));
        match rate.or_else(|| left.find(|(_, value)| !value.is_finite())) {
            Some((name, value)) => Err(TrimError::NonFinite { name, value }),
            None => Ok(point),
        }
    }

    /// Scaled residuals; `None` where one is not finite.
    pub(super) fn residual(&self, point: &Point<M>) -> Option<DVector<f64>> {
        let residual = DVector::from_vec(self.left(point)).component_mul(&self.row_scale);
        residual.iter().all(|it| it.is_finite()).then_some(residual)
    }

    /// What is left of each equation.
    fn left(&self, point: &Point<M>) -> Vec<f64> {
        let drift = self.model.drift(&point.x, &point.u);
        let outputs = if self.has_outputs() {
            M::outputs(&self.model.with_scalar(), &point.x, &point.u)
        } else {
            Vector::splat(0.0)
        };
        let left = |row: &Row| row.source.value(&drift, &outputs) - row.value;
        self.rows.iter().map(left).collect()
    }

    fn has_outputs(&self) -> bool {
        self.rows.iter().any(|row| row.source.is_output())
    }

    /// What `value` gives of each equation, scaled.
    pub(super) fn scaled(&self, value: impl Fn(Source) -> f64) -> DVector<f64> {
        let rows = self.rows.iter().zip(&self.row_scale);
        let scaled = rows.map(|(row, scale)| value(row.source) * scale);
        DVector::from_iterator(self.rows.len(), scaled)
    }

    /// Scaled residuals by scaled unknowns.
    pub(super) fn jacobian(&self, point: &Point<M>) -> DMatrix<f64> {
        let (by_state, by_input) = self.model.jacobians(&point.x, &point.u);
        let outputs = self.has_outputs();
        let outputs = outputs.then(|| output_slopes(self.model, &point.x, &point.u));
        let of_output = |output: usize, variable: usize| {
            let slopes: &M::OutputsOf<f64> = outputs.as_ref()?.get(variable)?;
            slopes.get(output)
        };
        DMatrix::from_fn(self.rows.len(), self.column_scale.len(), |row, column| {
            let input = || self.inputs[column - self.states.len()];
            let entry = match (self.rows[row].source, self.states.get(column)) {
                (Source::Rate(rate), Some(&state)) => {
                    by_state.get(rate).and_then(|it: M::State| it.get(state))
                }
                (Source::Rate(rate), None) => by_input.get(rate).and_then(|it| it.get(input())),
                (Source::Output(output), Some(&state)) => of_output(output, state),
                (Source::Output(output), None) => of_output(output, states::<M>() + input()),
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
            residual_max: self.largest(&residuals, point),
            iterations,
        }
    }

    pub(super) fn describe(&self, point: &Point<M>, iterations: usize) -> Nearest {
        let residuals = self.residuals(point);
        let left = DVector::from_vec(self.left(point));
        let scaled = left.component_mul(&self.row_scale);
        // Where scaled ones are no numbers, the largest of those before scaling.
        let beyond = (0..self.rows.len()).filter(|&index| !scaled[index].is_finite());
        let beyond = beyond.max_by(|&a, &b| left[a].abs().total_cmp(&left[b].abs()));
        let worst = beyond.unwrap_or_else(|| scaled.iamax());
        Nearest {
            state: named(&point.x),
            input: named(&point.u),
            residuals: named(&residuals),
            residual_max: self.largest(&residuals, point),
            worst: self.rows[worst].equation.name,
            worst_residual: left[worst],
            iterations,
        }
    }

    /// The largest absolute value of `residuals` and of what outputs are off by.
    fn largest(&self, residuals: &M::State, point: &Point<M>) -> f64 {
        let rates = (0..states::<M>()).filter_map(|index| residuals.get(index));
        let left = self.rows.iter().zip(self.left(point));
        let outputs = left.filter(|(row, _)| row.source.is_output());
        let all = rates.chain(outputs.map(|(_, value)| value));
        all.fold(0.0, |worst: f64, it| worst.max(it.abs()))
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

/// Number of states.
const fn states<M: GeneratedModel>() -> usize {
    <M::State as Vector<f64>>::LEN
}

/// The equations of a problem: what vanishes, then the outputs that are given.
fn rows<M: GeneratedModel>(flight: &SteadyState) -> Result<Vec<Row>, TrimError> {
    let vanishing = flight.equations.iter().map(|&equation| (equation, 0.0));
    let outputs = flight
        .given()
        .filter(|(name, _)| M::State::index_of(name).is_none());
    let outputs = outputs.map(|(name, value)| (Equation::new(name, 1.0, None), value));
    let row = |(equation, value): (Equation, f64)| {
        Ok(Row {
            source: Source::of::<M>(equation.name)?,
            value,
            equation,
        })
    };
    vanishing.chain(outputs).map(row).collect()
}

fn named<V: Vector<f64>>(vector: &V) -> Vec<(&'static str, f64)> {
    let component = |(index, &name)| Some((name, vector.get(index)?));
    V::NAMES.iter().enumerate().filter_map(component).collect()
}
