//! The regulator in whose closed loop all fly.

use ahv_core::{Bounds, Vector as _};
use ahv_models::sdcom::{INPUT_BOUNDS, Input, State};
use serde_json::Value;

use crate::monte_carlo::problem::{Flight, STATES};

/// Length of a flight in s.
pub(crate) const END: f64 = 10.0;
/// Threads of both.
pub(crate) const THREADS: usize = 2;
/// Of the actuators, in rad/s and units of the input per second: those of `ahv montecarlo`.
pub(crate) const BANDWIDTH: f64 = 20.0;
pub(crate) const RATE: f64 = 1.0;

/// A regulator about the trim.
pub(crate) struct Law {
    pub(crate) flight: Flight,
    /// Of each input whether it moves, its bounds, and its gains.
    pub(crate) rows: [[f64; 3 + STATES]; Input::<f64>::LEN],
}

impl Law {
    /// From a file of gains.
    pub(super) fn read(gains: &Value) -> Option<Self> {
        let named = |key: &str, name: &str| gains[key][name].as_f64();
        let place = |name: &str| gains["inputs"].as_array()?.iter().position(|it| it == name);
        let columns = gains["states"].as_array()?;
        let mut flight = Flight::new();
        let mut rows = [[0.0; 3 + STATES]; Input::<f64>::LEN];
        for (index, (name, row)) in Input::<f64>::NAMES.iter().zip(&mut rows).enumerate() {
            flight.input.set(index, named("input", name)?)?;
            let Some(place) = place(name) else { continue };
            let Bounds { min, max } = INPUT_BOUNDS.get(index)?;
            row[..3].copy_from_slice(&[1.0, min, max]);
            for (entry, state) in row[3..].iter_mut().zip(State::<f64>::NAMES) {
                let column = columns.iter().position(|it| it == state)?;
                *entry = gains["gain"][place][column].as_f64()?;
            }
        }
        for (index, name) in State::<f64>::NAMES.iter().enumerate() {
            flight.start.set(index, named("state", name)?)?;
        }
        Some(Self { flight, rows })
    }
}
