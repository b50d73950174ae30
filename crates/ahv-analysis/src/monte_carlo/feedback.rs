//! State feedback through actuators, for all members of a batch at once.

use ahv_core::{GeneratedModel, Real, Vector};
use nalgebra::DMatrix;

use super::lanes::{LANES, Packed};
use crate::actuator::{Actuator, ActuatorStep};
use crate::covariance::Regulation;
use crate::values::vector;

/// Largest rate of a state that stays, as a share of the terms of its drift, to first order.
const STEADY: f64 = 1e-9;

/// u = input − gain (x − state − rate t), through actuators; t counts from the start of the flight.
///
/// Inputs without actuator are held.
#[derive(Clone, Debug)]
pub struct Feedback {
    /// State of the trim at the start.
    pub state: Vec<f64>,
    /// Rate of the trim, per second: of a climb that of the altitude, else 0.
    pub rate: Vec<f64>,
    /// Input of the trim.
    pub input: Vec<f64>,
    /// Gain, inputs by states; the unit of an entry is that of the input over that of the state.
    pub gain: DMatrix<f64>,
    /// What moves each input.
    pub actuators: Vec<Option<Actuator>>,
}

/// A state that does not follow its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsteady {
    /// The state.
    pub state: &'static str,
    /// Its rate where the reference starts, per second.
    pub rate: f64,
    /// The rate that it should have, per second.
    pub expected: f64,
}

/// A row of the law.
#[derive(Clone, Copy)]
struct Row<F: GeneratedModel> {
    input: f64,
    gain: F::StateOf<f64>,
    actuator: ActuatorStep,
}

/// The law over steps of fixed length.
#[derive(Clone, Copy)]
pub(super) struct SampledFeedback<F: GeneratedModel> {
    state: F::StateOf<f64>,
    rate: F::StateOf<f64>,
    /// Whether the reference moves.
    moves: bool,
    dt: f64,
    /// Steps that each member had flown before those that are counted.
    flown: [u64; LANES],
    rows: F::InputOf<Option<Row<F>>>,
}

impl Feedback {
    /// The first state of `model` that does not follow the reference: the states that move in a trim move on, and all
    /// others stay.
    pub fn unsteady<M: GeneratedModel>(&self, model: &M) -> Option<Unsteady> {
        let (x, u): (M::State, M::Input) = (vector(&self.state), vector(&self.input));
        let (drift, by_state, by_input) = model.drift_and_jacobians(&x, &u);
        let rates = self.rate.iter().zip(M::State::NAMES).enumerate();
        let mut followed = rates.filter_map(|(index, (&own, &state))| {
            let rate = drift.get(index)?;
            let moves = M::TRIM.moving.contains(&state);
            let expected = if moves { rate } else { 0.0 };
            let row: M::State = by_state.get(index)?;
            let terms = size(&row, &x) + size(&by_input.get(index)?, &u);
            let follows = |rate: f64| (rate - expected).abs() <= STEADY * terms;
            let rate = if follows(rate) { own } else { rate };
            let unsteady = Unsteady {
                state,
                rate,
                expected,
            };
            (!follows(rate)).then_some(unsteady)
        });
        followed.next()
    }

    /// The same law for a linear covariance: it acts all the time, and the actuators have no limits.
    pub fn regulation(&self) -> Regulation {
        let bandwidth = |actuator: &Option<Actuator>| actuator.map_or(0.0, |it| it.bandwidth);
        Regulation {
            state: self.state.clone(),
            rate: self.rate.clone(),
            input: self.input.clone(),
            gain: self.gain.clone(),
            bandwidth: self.actuators.iter().map(bandwidth).collect(),
        }
    }

    /// The law over steps of `dt`, for members that have flown some steps.
    #[inline(never)]
    pub(super) fn over<F: GeneratedModel>(
        &self,
        dt: f64,
        flown: [u64; LANES],
    ) -> SampledFeedback<F> {
        let gain = |at: (usize, usize)| self.gain.get(at).map_or(0.0, |gain: &f64| *gain);
        let rows = F::InputOf::from_fn(|index| {
            let actuator = self.actuators.get(index).copied()??;
            Some(Row {
                input: *self.input.get(index)?,
                gain: F::StateOf::from_fn(|state| gain((index, state))),
                actuator: actuator.over(dt),
            })
        });
        SampledFeedback {
            state: vector(&self.state),
            rate: vector(&self.rate),
            moves: self.rate.iter().any(|&rate| rate != 0.0),
            dt,
            flown,
            rows,
        }
    }
}

/// Sum of the absolute products of two vectors' components.
fn size<V: Vector<f64>>(slopes: &V, point: &V) -> f64 {
    let terms = (0..V::LEN).filter_map(|index| Some(slopes.get(index)? * point.get(index)?));
    terms.map(f64::abs).sum()
}

impl<F: GeneratedModel> SampledFeedback<F> {
    /// Moves the inputs over step number `step`, towards what the law wants at its start.
    #[inline(always)]
    pub(super) fn apply(&self, x: &F::StateOf<Packed>, u: &mut F::InputOf<Packed>, step: u64) {
        let mut deviation = *x;
        F::update_state(&mut deviation, self.state, |x, rest| {
            *x = *x - Packed::splat(rest);
        });
        if self.moves {
            let mut time = Packed::ZERO;
            for lane in 0..LANES {
                time.0[lane] = (self.flown[lane] + step) as f64 * self.dt;
            }
            F::update_state(&mut deviation, self.rate, |x, rate| {
                *x = *x - Packed::splat(rate) * time;
            });
        }
        // No closure around this: it would be too large to be inlined.
        for index in 0..F::InputOf::<Packed>::LEN {
            let (Some(mut position), Some(Some(row))) = (u.get(index), self.rows.get(index)) else {
                continue;
            };
            let mut command = Packed::splat(row.input);
            F::zip_state(&deviation, &row.gain, |&deviation, &gain| {
                command = command - Packed::splat(gain) * deviation;
            });
            for lane in 0..LANES {
                position.0[lane] = row.actuator.moved(position.0[lane], command.0[lane]);
            }
            // The index is one of the input's own.
            let _ = u.set(index, position);
        }
    }
}

#[cfg(test)]
mod tests {
    use ahv_core::{Bounds, Vector};
    use ahv_models::sdcom::{Input, Model, State};

    use super::{Actuator, DMatrix, Feedback, LANES, Packed, Real};

    /// A member that flies on from step 40 sees the reference of step 40.
    #[test]
    fn the_reference_moves_from_the_start_of_each_member() {
        let actuator = Actuator {
            bandwidth: 20.0,
            rate: 1.0,
            bounds: Bounds::new(-1.0, 1.0),
        };
        // The second state is the altitude, the second input the elevator.
        let mut gain = DMatrix::zeros(3, 8);
        gain[(1, 1)] = 1e-3;
        let feedback = Feedback {
            state: vec![0.0; 8],
            rate: vec![0.0, 134.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            input: vec![0.0; 3],
            gain,
            actuators: vec![None, Some(actuator), None],
        };
        let moved = |flown: [u64; LANES], step| {
            let mut u = Input::splat(Packed::ZERO);
            let law = feedback.over::<Model<f64>>(0.01, flown);
            law.apply(&State::splat(Packed::ZERO), &mut u, step);
            u.delta_e.0
        };
        let mut flown = [0; LANES];
        flown[1] = 40;
        let (on, later) = (moved(flown, 0), moved([0; LANES], 40));
        assert_eq!(on[0], 0.0);
        assert_eq!(on[1], later[1]);
        assert!(on[1] > 1e-3, "{on:?}");
    }
}
