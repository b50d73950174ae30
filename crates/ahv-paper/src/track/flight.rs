//! The closed loop over one sampling period.

use ahv_analysis::actuator::{Actuator, Limits};
use ahv_core::{StochasticModel, Vector};
use ahv_integrate::{ItoHeun, StepError};
use ahv_models::{dcom, sdcom};

use super::{Controller, Manoeuvre, PERIOD};

/// Steps of the truth in a sampling period.
pub const SUBSTEPS: u64 = 4;

/// Wiener increments of the truth.
pub type Increments = <dcom::Model<f64> as StochasticModel>::Noise;

/// A vehicle with its actuators and its controller.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLoop<'a, C> {
    /// The truth.
    pub model: &'a dcom::Model<f64>,
    /// Actuators of φ and δe.
    pub actuators: [Actuator; 2],
    /// The controller.
    pub controller: &'a C,
    /// What to fly.
    pub manoeuvre: Manoeuvre,
}

/// Everything that the closed loop remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopState<M> {
    /// State of the vehicle.
    pub state: dcom::State<f64>,
    /// Positions of the actuators.
    pub input: dcom::Input<f64>,
    /// Memory of the controller.
    pub memory: M,
}

impl<C: Controller> ClosedLoop<'_, C> {
    /// The loop at rest at the trim (x, u).
    pub fn start(&self, state: dcom::State<f64>, input: dcom::Input<f64>) -> LoopState<C::Memory> {
        let memory = self
            .controller
            .start(&measured(&state), &input.to_array().into());
        LoopState {
            state,
            input,
            memory,
        }
    }

    /// One sampling period from `time`, in s: the controller samples, then `SUBSTEPS` steps of the truth follow. Says which
    /// limits the actuators met. `noise` gives the Wiener increments of a substep of this length, in s.
    ///
    /// # Errors
    ///
    /// [`StepError`] if a state is not finite; the loop is then as it was before the substep.
    pub fn advance(
        &self,
        flight: &mut LoopState<C::Memory>,
        time: f64,
        mut noise: impl FnMut(u64, f64) -> Increments,
    ) -> Result<[Limits; 2], StepError<f64>> {
        let reference = self.manoeuvre.at(time);
        let position = flight.input.to_array().into();
        let command = self.controller.command(
            &mut flight.memory,
            &reference,
            &measured(&flight.state),
            &position,
        );
        let dt = PERIOD / SUBSTEPS as f64;
        let mut met = [Limits::default(); 2];
        for substep in 0..SUBSTEPS {
            let u = flight.input;
            let [of_phi, of_elevator] = &self.actuators;
            let (phi, phi_limits) = of_phi.moved(u.phi, command.phi, dt);
            let (delta_e, elevator_limits) = of_elevator.moved(u.delta_e, command.delta_e, dt);
            let next = dcom::Input { phi, delta_e, ..u };
            let mean = u.zip_with(next, |a, b| 0.5 * (a + b));
            ItoHeun::new(dt).step(self.model, &mut flight.state, &mean, &noise(substep, dt))?;
            flight.input = next;
            for (met, limits) in met.iter_mut().zip([phi_limits, elevator_limits]) {
                met.position |= limits.position;
                met.rate |= limits.rate;
            }
        }
        Ok(met)
    }
}

/// What the controller sees of the truth: the rigid states, χ = 0.
pub(super) fn measured(x: &dcom::State<f64>) -> sdcom::State<f64> {
    sdcom::State {
        velocity: x.velocity,
        altitude: x.altitude,
        gamma: x.gamma,
        alpha: x.alpha,
        pitch_rate: x.pitch_rate,
        ..sdcom::State::splat(0.0)
    }
}
