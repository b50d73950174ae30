//! A way to solve a flight.

use serde::{Deserialize, Serialize};

use super::flights::STATES;

/// Numbers of steps from coarse to fine: 2^k and 3·2^(k−1) for k in a range, so that an integrator which divides the flight by
/// the step size finds the number again.
pub(crate) fn steps(first: u32, last: u32) -> Vec<f64> {
    let pair = |k: u32| [2.0_f64.powi(k as i32), 1.5 * 2.0_f64.powi(k as i32)];
    (first..=last).flat_map(pair).collect()
}

/// Tolerances from coarse to fine, relative and in units of the scales: 10^(−2) to 10^(−13), √10 apart.
pub(crate) fn tolerances() -> Vec<f64> {
    let tolerance = |k: u32| 10.0_f64.powf(-0.5 * f64::from(k));
    (4..=26).map(tolerance).collect()
}

/// What is asked of a solver.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Request {
    /// Index of the flight.
    pub(crate) flight: usize,
    pub(crate) setting: f64,
    /// Timed solutions; one that warms up comes before them.
    pub(crate) repeats: u32,
}

/// The end of a flight, and what it took.
#[derive(Clone, Copy, Deserialize)]
pub(crate) struct Solution {
    /// Mean time of a timed solution in s.
    pub(crate) seconds: f64,
    pub(crate) state: [f64; STATES],
    /// Accepted steps.
    pub(crate) steps: u64,
    /// Right-hand sides, those of refused steps included.
    pub(crate) drifts: u64,
    /// Jacobians.
    pub(crate) jacobians: u64,
}

/// Answers a request.
pub(crate) type Solve = Box<dyn FnMut(&Request) -> Result<Solution, String>>;

/// A method in an implementation.
pub(crate) struct Solver {
    pub(crate) name: String,
    /// Numbers of steps or tolerances, from coarse to fine.
    pub(crate) settings: Vec<f64>,
    pub(crate) solve: Solve,
}
