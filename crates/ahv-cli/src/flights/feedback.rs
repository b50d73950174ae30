//! A state feedback from a file of gains, as `ahv lqr --out` writes it.

use std::path::PathBuf;

use ahv_analysis::actuator::Actuator;
use ahv_analysis::monte_carlo::Feedback;
use ahv_analysis::trim::SteadyState;
use clap::{Args, ValueEnum};
use nalgebra::DMatrix;

use crate::assignment::Assignments;
use crate::failure::{Failure, complain};
use crate::gains::Gains;
use crate::number::Shown;
use crate::vehicle::Vehicle;

/// Bandwidth of the actuators, in rad/s, unless another is given.
const BANDWIDTH: f64 = 20.0;
/// Rate of the actuators, in units of the input per second, unless another is given.
const RATE: f64 = 1.0;

/// State feedback.
#[derive(Args)]
pub(crate) struct FeedbackArguments {
    /// File of gains as `ahv lqr --out` writes it: inputs follow u = input - gain (x - state - state_rate t) through actuators
    #[arg(long, value_name = "FILE")]
    feedback: Option<PathBuf>,

    /// Gains of another model, set, choice, table or flight condition
    #[arg(long, value_enum, default_value_t = Mismatch::Refuse, requires = "feedback")]
    feedback_mismatch: Mismatch,

    /// Bandwidth of the actuators in rad/s, a lag of first order
    #[arg(long, value_name = "RAD_S", default_value_t = BANDWIDTH, requires = "feedback", value_parser = crate::number::positive, allow_negative_numbers = true)]
    actuator_bandwidth: f64,

    /// Largest rates of the inputs per second, e.g. phi=1,delta_e=60deg [default: 1 per s, 1 rad/s]
    #[arg(
        long,
        value_name = "NAME=VALUE",
        value_delimiter = ',',
        requires = "feedback"
    )]
    actuator_rate: Vec<String>,
}

/// What becomes of gains that were designed for another vehicle or flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mismatch {
    /// They are an error
    Refuse,
    /// They are flown, with a note
    Allow,
}

impl FeedbackArguments {
    /// Whether there is a file of gains.
    pub(crate) const fn is_given(&self) -> bool {
        self.feedback.is_some()
    }

    /// The feedback, if there is one. Actuators move within the validity box of the inputs.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a file that is no file of gains for this model, or was designed for another vehicle or
    /// flight.
    pub(crate) fn read(
        &self,
        vehicle: &Vehicle,
        flight: &SteadyState,
    ) -> Result<Option<Feedback>, Failure> {
        let Some(path) = &self.feedback else {
            return Ok(None);
        };
        let fault = |what: &str| Failure::Request(format!("--feedback {}: {what}", path.display()));
        let gains = Gains::read(path, vehicle, flight).map_err(|what| fault(&what))?;
        vehicle
            .moves(&gains.state.values(vehicle.states.names))
            .map_err(|why| fault(&why))?;
        let feedback = self.law(vehicle, &gains)?;
        let mut differences = gains.differences(vehicle, flight);
        if let Some(unsteady) = vehicle.model.unsteady(&vehicle.parameters, &feedback) {
            let unit = vehicle.states.unit(unsteady.state);
            differences.push(format!(
                "a reference that is no equilibrium of the flights: {} changes by {} {unit} a second, in a steady flight by {}",
                unsteady.state,
                Shown(unsteady.rate),
                Shown(unsteady.expected)
            ));
        }
        if differences.is_empty() {
            return Ok(Some(feedback));
        }
        let what = format!("its gains have {}", differences.join("; "));
        if self.feedback_mismatch == Mismatch::Allow {
            complain(&format!("note: --feedback {}: {what}", path.display()));
            return Ok(Some(feedback));
        }
        Err(fault(&format!(
            "{what}. What to do: {}",
            Gains::remedy(vehicle, flight)
        )))
    }

    /// The law of gains that fit the model.
    fn law(&self, vehicle: &Vehicle, gains: &Gains) -> Result<Feedback, Failure> {
        let (states, inputs) = (vehicle.states, vehicle.inputs);
        let mut rates = vec![RATE; inputs.len()];
        Assignments::parse("--actuator-rate", &self.actuator_rate, inputs)?.apply(&mut rates);
        let mut named = inputs.names.iter().zip(&rates);
        if let Some((name, _)) = named.find(|(_, rate)| **rate <= 0.0) {
            return Err(Failure::Request(format!(
                "--actuator-rate: the rate of {name} must be above 0"
            )));
        }
        let mut gain = DMatrix::zeros(inputs.len(), states.len());
        let mut actuators = vec![None; inputs.len()];
        for (name, row) in gains.inputs.iter().zip(&gains.gain) {
            let Some(input) = inputs.index_of(name) else {
                continue;
            };
            for (entry, value) in gain.row_mut(input).iter_mut().zip(row) {
                *entry = *value;
            }
            actuators[input] = Some(Actuator {
                bandwidth: self.actuator_bandwidth,
                rate: rates[input],
                bounds: vehicle.input_bounds[input],
            });
        }
        Ok(Feedback {
            state: gains.state.values(states.names),
            rate: gains.state_rate.values(states.names),
            input: gains.input.values(inputs.names),
            gain,
            actuators,
        })
    }
}
