//! The closed loop's linearisation.

use ahv_core::Vector;
use ahv_integrate::StepError;
use ahv_models::dcom;
use nalgebra::{Complex, ComplexField, DMatrix};

use super::flight::Increments;
use super::{ClosedLoop, Controller, LoopState, PERIOD};

/// Displacement of the central differences, relative to a component or to 1, whichever is larger.
const DISPLACEMENT: f64 = 1e-6;

/// Actuators, φ and δe.
const ACTUATORS: usize = 2;

impl<C: Controller> ClosedLoop<'_, C> {
    /// Poles of the closed loop about `rest`, in 1/s, rightmost first: logarithms over the period of the eigenvalues of the
    /// linearised map from one sample to the next. The loop is stable where all lie in the left half plane.
    ///
    /// The map takes in the vehicle, both actuators, sampling, and all that the controller remembers; its Jacobian is by
    /// central differences. No noise. `rest` ought to be a rest point of [`advance`](Self::advance) at time 0.
    ///
    /// # Errors
    ///
    /// [`StepError`] if a state is not finite near `rest`.
    pub fn poles(&self, rest: &LoopState<C::Memory>) -> Result<Vec<Complex<f64>>, StepError<f64>> {
        let at = flattened(rest);
        let mut map = DMatrix::zeros(at.len(), at.len());
        for (column, &value) in at.iter().enumerate() {
            let displacement = DISPLACEMENT * value.abs().max(1.0);
            let [ahead, behind] =
                [displacement, -displacement].map(|by| self.mapped(rest, &at, column, by));
            for ((entry, ahead), behind) in
                map.column_mut(column).iter_mut().zip(ahead?).zip(behind?)
            {
                *entry = (ahead - behind) / (2.0 * displacement);
            }
        }
        let mut poles: Vec<_> = map
            .complex_eigenvalues()
            .iter()
            .map(|z| ComplexField::ln(*z) / PERIOD)
            .collect();
        poles.sort_by(|a, b| b.re.total_cmp(&a.re));
        Ok(poles)
    }

    /// One period on from `at` with component `index` displaced.
    fn mapped(
        &self,
        rest: &LoopState<C::Memory>,
        at: &[f64],
        index: usize,
        by: f64,
    ) -> Result<Vec<f64>, StepError<f64>> {
        let mut moved = at.to_vec();
        if let Some(component) = moved.get_mut(index) {
            *component += by;
        }
        let mut flight = restored(rest, &moved);
        self.advance(&mut flight, 0.0, |_, _| Increments::splat(0.0))?;
        Ok(flattened(&flight))
    }
}

/// Vehicle, actuators and memory in one list.
fn flattened<M: AsRef<[f64]>>(flight: &LoopState<M>) -> Vec<f64> {
    let state = flight.state.to_array();
    let input = flight.input.to_array();
    let memory = flight.memory.as_ref();
    state
        .iter()
        .chain(input.iter().take(ACTUATORS))
        .chain(memory)
        .copied()
        .collect()
}

/// `like` with the components of a list of [`flattened`].
fn restored<M: Copy + AsMut<[f64]>>(like: &LoopState<M>, list: &[f64]) -> LoopState<M> {
    let mut flight = *like;
    let mut components = list.iter().copied();
    flight.state = dcom::State::from_fn(|_| components.next().unwrap_or(0.0));
    let input = flight.input;
    flight.input = dcom::Input::from_fn(|index| match index {
        0..ACTUATORS => components.next().unwrap_or(0.0),
        _ => input.get(index).unwrap_or(0.0),
    });
    for (own, component) in flight.memory.as_mut().iter_mut().zip(components) {
        *own = component;
    }
    flight
}
