//! State feedback through actuators, for all members of a batch at once.

use ahv_core::Vector;
use nalgebra::DMatrix;

use super::family::{Family, LANES, Packed};
use crate::covariance::Regulation;
use crate::track::{Actuator, ActuatorStep};

/// u = input − gain (x − state), through actuators.
///
/// Inputs without actuator are held.
#[derive(Clone, Copy)]
pub struct Feedback<F: Family> {
    /// State of the trim.
    pub state: F::State<f64>,
    /// Input of the trim.
    pub input: F::Input<f64>,
    /// Gain, row by row; the unit of an entry is that of the input over that of the state.
    pub gain: F::Input<F::State<f64>>,
    /// What moves each input.
    pub actuators: F::Input<Option<Actuator>>,
}

/// A row of the law.
#[derive(Clone, Copy)]
struct Row<F: Family> {
    input: f64,
    gain: F::State<f64>,
    actuator: ActuatorStep,
}

/// The law over steps of fixed length.
#[derive(Clone, Copy)]
pub(super) struct Law<F: Family> {
    state: F::State<f64>,
    rows: F::Input<Option<Row<F>>>,
}

impl<F: Family> Feedback<F> {
    /// The same law for a linear covariance: it acts all the time, and the actuators have no limits.
    pub fn regulation(&self) -> Regulation<F::State<f64>, F::Input<f64>> {
        let (inputs, states) = (F::Input::<f64>::LEN, F::State::<f64>::LEN);
        let gain = |input, state| self.gain.get(input)?.get(state);
        Regulation {
            state: self.state,
            input: self.input,
            gain: DMatrix::from_fn(inputs, states, |input, state| {
                gain(input, state).unwrap_or(0.0)
            }),
            bandwidth: F::map_input(&self.actuators, |actuator| {
                actuator.map_or(0.0, |actuator| actuator.bandwidth)
            }),
        }
    }

    pub(super) fn over(&self, dt: f64) -> Law<F> {
        let rows = F::Input::from_fn(|index| {
            let actuator = self.actuators.get(index)??;
            Some(Row {
                input: self.input.get(index)?,
                gain: self.gain.get(index)?,
                actuator: actuator.over(dt),
            })
        });
        Law {
            state: self.state,
            rows,
        }
    }
}

impl<F: Family> Law<F> {
    /// Moves the inputs over one step, towards what the law wants at its start.
    #[inline(always)]
    pub(super) fn apply(&self, x: &F::State<Packed>, u: &mut F::Input<Packed>) {
        let mut deviation = *x;
        F::update_state(&mut deviation, self.state, |x, rest| {
            *x = *x - Packed::splat(rest);
        });
        // No closure around this: it would be too large to be inlined.
        for index in 0..F::Input::<Packed>::LEN {
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
