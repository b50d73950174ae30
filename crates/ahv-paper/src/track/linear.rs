//! Tracking by the linear-quadratic regulator.

use ahv_analysis::linearize::{LinearizeError, linearize};
use ahv_analysis::lqr::{LqrError, Regulator, bryson, deviations};
use ahv_core::GeneratedModel;
use ahv_models::sdcom::{Input, Model, State};
use nalgebra::{Matrix4, SMatrix, Vector4};

use super::{Controller, Reference};

/// States of SDCOM.
const STATES: usize = State::<()>::LEN;

/// Inputs that the regulator moves.
const INPUTS: [&str; 2] = ["phi", "delta_e"];

/// Why there is no linear-quadratic tracker.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearTrackerError {
    /// The model cannot be linearised.
    #[error(transparent)]
    Linearize(#[from] LinearizeError),
    /// There is no regulator.
    #[error(transparent)]
    Regulator(#[from] LqrError),
    /// Inputs and incidence do not move the rates that a manoeuvre asks for.
    #[error(
        "the linearisation cannot follow a command: its rates of V, gamma, alpha and Q do not depend on alpha, Q, phi and delta_e"
    )]
    Uncommandable,
}

/// u = u₀ + u_c − K (x − x₀ − x_c): the regulator of SDCOM's linearisation at a trim (x₀, u₀), with the linear state and
/// input (x_c, u_c) that follow the commands.
///
/// χ is not measured and taken as 0. It drives the rigid body and is not driven by it, so that the gains of the rigid
/// states are those of a regulator without it.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearTracker {
    state: State<f64>,
    input: Input<f64>,
    /// K.
    gain: SMatrix<f64, 2, STATES>,
    /// Rates of V, γ, α, Q by V, h, γ.
    given: SMatrix<f64, 4, 3>,
    /// From rates of V, γ, α, Q to α, Q, φ, δe.
    inverse: Matrix4<f64>,
}

impl LinearTracker {
    /// The tracker at the trim (x, u) of `model`.
    ///
    /// # Errors
    ///
    /// [`LinearTrackerError`]
    pub fn new(
        model: &Model<f64>,
        x: &State<f64>,
        u: &Input<f64>,
    ) -> Result<Self, LinearTrackerError> {
        let system = linearize(model, x, u, &INPUTS, &[])?;
        let efforts = deviations::<Input<f64>>(Model::<f64>::DEVIATIONS);
        let q = bryson(&deviations::<State<f64>>(Model::<f64>::DEVIATIONS).to_array());
        let r = bryson(&[efforts.phi, efforts.delta_e]);
        let regulator = Regulator::new(&system.a, &system.b, &q, &r)?;
        let (by_state, by_input) = (&system.a, &system.b);
        // Rows V, γ, α, Q; h follows from them.
        const ROWS: [usize; 4] = [0, 2, 3, 4];
        let given = SMatrix::from_fn(|row, column| by_state[(ROWS[row], column)]);
        let sought = Matrix4::from_fn(|row, column| match column {
            0 | 1 => by_state[(ROWS[row], column + 3)],
            _ => by_input[(ROWS[row], column - 2)],
        });
        Ok(Self {
            state: *x,
            input: *u,
            gain: SMatrix::from_fn(|row, column| regulator.gain[(row, column)]),
            given,
            inverse: sought
                .try_inverse()
                .ok_or(LinearTrackerError::Uncommandable)?,
        })
    }

    /// State and input that follow the commands in the linearisation, α and Q quasi-steadily.
    fn commanded(&self, reference: &Reference) -> (State<f64>, Input<f64>) {
        let gamma = reference.gamma();
        let deviations = [
            reference.velocity - self.state.velocity,
            reference.altitude - self.state.altitude,
            gamma - self.state.gamma,
        ];
        let turn = reference.climb_acceleration / reference.velocity;
        let rates = Vector4::new(reference.acceleration, turn, 0.0, 0.0);
        let [alpha, pitch_rate, phi, delta_e] =
            (self.inverse * (rates - self.given * SMatrix::from(deviations))).into();
        let state = State {
            velocity: reference.velocity,
            altitude: reference.altitude,
            gamma,
            alpha: self.state.alpha + alpha,
            pitch_rate,
            ..self.state
        };
        let input = Input {
            phi: self.input.phi + phi,
            delta_e: self.input.delta_e + delta_e,
            ..self.input
        };
        (state, input)
    }
}

impl Controller for LinearTracker {
    type Memory = [f64; 0];

    fn start(&self, _: &State<f64>, _: &Input<f64>) -> [f64; 0] {
        []
    }

    fn command(
        &self,
        _: &mut [f64; 0],
        reference: &Reference,
        x: &State<f64>,
        _: &Input<f64>,
    ) -> Input<f64> {
        let (state, input) = self.commanded(reference);
        let error = SMatrix::<f64, STATES, 1>::from(x.to_array()) - SMatrix::from(state.to_array());
        let correction = self.gain * error;
        Input {
            phi: input.phi - correction[0],
            delta_e: input.delta_e - correction[1],
            ..input
        }
    }
}
