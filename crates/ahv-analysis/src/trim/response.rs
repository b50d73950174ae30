//! How a trim moves when the drift changes.

use ahv_core::{DifferentiableModel, Model, Vector};
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

/// The shifts of a trim, one for each change of the drift; `None` where they are not determined.
type Shifts<M> = Option<Vec<Shift<<M as Model>::State, <M as Model>::Input>>>;

/// First-order changes of state and input at the `trim` of `flight` for each change of the drift among `changes`, for
/// example ∂f/∂p for one parameter p: then they are ∂x/∂p and ∂u/∂p.
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
    changes: &[M::State],
) -> Result<Shifts<M>, TrimError>
where
    M: DifferentiableModel<Scalar = f64>,
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
    let moved = |change: &M::State| {
        let step: DVector<f64> = factors.solve(&-system.scaled(change))?;
        let moved: Point<M> = system.moved(&origin, &step)?;
        Some(Shift {
            state: moved.x,
            input: moved.u,
        })
    };
    Ok(changes.iter().map(moved).collect())
}
