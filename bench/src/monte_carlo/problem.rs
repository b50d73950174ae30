//! The flights of the Monte Carlo.

use ahv_core::Vector as _;
use ahv_models::sdcom::{Input, NOMINAL, Parameters, State};

/// Number of states of SDCOM.
pub(crate) const STATES: usize = State::<f64>::LEN;
/// Step size in s.
pub(crate) const DT: f64 = 1e-3;
/// Steps of a flight: after these the unstable airframe is still near the trim.
pub(crate) const STEPS: usize = 200;
/// Flights of a turn.
pub(crate) const MEMBERS: usize = 8192;
/// Numbers of threads.
pub(crate) const THREADS: [usize; 2] = [1, 2];
/// What all fly.
#[derive(Clone, Copy)]
pub(crate) struct Flight {
    pub(crate) parameters: Parameters<f64>,
    pub(crate) start: State<f64>,
    pub(crate) input: Input<f64>,
}

impl Flight {
    /// From the trim, as `ahv trim --model sdcom` has it, at its inputs.
    pub(crate) fn new() -> Self {
        Self {
            parameters: NOMINAL,
            start: State {
                velocity: 7702.0808,
                altitude: 85_000.0,
                alpha: 0.026_210_532_360_591_794,
                ..State::splat(0.0)
            },
            input: Input {
                phi: 0.282_090_564_596_775_9,
                delta_e: 0.228_647_824_758_849_54,
                delta_c: 0.0,
            },
        }
    }
}
