//! How a trim moves when the model changes.

use ahv_core::{GeneratedModel, Model, Vector};
use nalgebra::DVector;

use super::{Point, SteadyState, System, Trim, TrimError};

/// A change of a trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift<X, U> {
    /// Change of the state.
    pub state: X,
    /// Change of the input.
    pub input: U,
}

/// A change of the model at a state and input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelChange<X, Y> {
    /// Change of the drift.
    pub drift: X,
    /// Change of the outputs.
    pub outputs: Y,
}

/// The shifts of a trim, one for each change of the model; `None` where they are not determined.
type Shifts<M> = Option<Vec<Shift<<M as Model>::State, <M as Model>::Input>>>;

/// First-order changes of state and input at the `trim` of `flight` for each change of the model among `changes`, for
/// example its derivative by one parameter p: then they are ∂x/∂p and ∂u/∂p.
///
/// By the implicit function theorem, through the Jacobian of the trim's equations. What is given does not move.
/// `None` where that Jacobian is singular.
///
/// # Errors
///
/// [`TrimError::MissingName`] and [`TrimError::NonFinite`], as [`trim`](super::trim).
pub fn response<M>(
    model: &M,
    flight: &SteadyState,
    trim: &Trim<M::State, M::Input>,
    changes: &[ModelChange<M::State, M::OutputsOf<f64>>],
) -> Result<Shifts<M>, TrimError>
where
    M: GeneratedModel,
{
    let system = System::new(model, flight)?;
    let point = Point {
        x: trim.state,
        u: trim.input,
    };
    let factors = system.jacobian(&point).lu();
    // The unknowns move from 0, so that only the change is left.
    let origin = Point {
        x: M::State::splat(0.0),
        u: M::Input::splat(0.0),
    };
    let moved = |change: &ModelChange<M::State, M::OutputsOf<f64>>| {
        let change = system.scaled(|source| source.value(&change.drift, &change.outputs));
        let step: DVector<f64> = factors.solve(&-change)?;
        let moved: Point<M> = system.moved(&origin, &step)?;
        Some(Shift {
            state: moved.x,
            input: moved.u,
        })
    };
    Ok(changes.iter().map(moved).collect())
}
