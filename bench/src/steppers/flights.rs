//! The flights that are solved.

use ahv_models::dcom::{self, Input, NOMINAL, Parameters, SECTION5_3, State};
use serde_json::{Value, json};

/// Number of states of DCOM.
pub(crate) const STATES: usize = State::<f64>::LEN;

/// Length of a flight in s.
pub(crate) const END: f64 = 1.0;

/// A flight of DCOM without canard at held inputs, from near the level trim, with modes displaced so that they ring.
pub(crate) struct Flight {
    /// The set of parameters.
    pub(crate) set: &'static str,
    pub(crate) parameters: Parameters<f64>,
    pub(crate) start: State<f64>,
    pub(crate) input: Input<f64>,
}

/// All flights, and in what their errors are measured.
pub(crate) struct Flights {
    pub(crate) all: [Flight; 2],
    /// Half widths of the box of validity.
    pub(crate) scales: State<f64>,
}

const START: State<f64> = State {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.002,
    alpha: 0.0262,
    pitch_rate: 0.01,
    eta_1: 0.5,
    eta_dot_1: 0.0,
    eta_2: -0.8,
    eta_dot_2: 20.0,
    eta_3: 0.6,
    eta_dot_3: 0.0,
};

impl Flights {
    pub(crate) fn new() -> Self {
        Self {
            all: [
                Flight {
                    set: "section5.1",
                    parameters: NOMINAL,
                    start: START,
                    input: Input {
                        phi: 0.2821,
                        delta_e: 0.2286,
                        delta_c: 0.0,
                    },
                },
                Flight {
                    set: "section5.3",
                    parameters: SECTION5_3,
                    start: State {
                        alpha: 0.0106,
                        ..START
                    },
                    input: Input {
                        phi: 0.2216,
                        delta_e: 0.1919,
                        delta_c: 0.0,
                    },
                },
            ],
            scales: dcom::STATE_BOUNDS.map_into(|bounds| 0.5 * (bounds.max - bounds.min)),
        }
    }

    /// Greatest difference of two states in units of the scales.
    pub(crate) fn distance(&self, a: &[f64; STATES], b: &[f64; STATES]) -> f64 {
        let differences = a.iter().zip(b).zip(self.scales.to_array());
        let differences = differences.map(|((a, b), scale)| (a - b).abs() / scale);
        // Written so that NaN stays.
        differences.fold(0.0, |worst, it| if it <= worst { worst } else { it })
    }

    /// For a peer.
    pub(crate) fn json(&self) -> Value {
        let flight = |it: &Flight| {
            json!({
                "parameters": it.parameters.to_array().to_vec(),
                "state": it.start.to_array(),
                "input": it.input.to_array(),
            })
        };
        json!({
            "end": END,
            "scales": self.scales.to_array(),
            "flights": self.all.each_ref().map(flight),
        })
    }
}
