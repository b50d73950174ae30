//! A model without a solution for all times.

use ahv_core::Model;

use crate::common::vector;

vector!(State, size, time);

/// x' = x² blows up at t = 1/x₀; y' = 1.
pub(crate) struct BlowUp;

impl Model for BlowUp {
    type Scalar = f64;
    type State = State<f64>;
    type Input = State<f64>;

    fn drift(&self, x: &State<f64>, _: &State<f64>) -> State<f64> {
        State {
            size: x.size * x.size,
            time: 1.0,
        }
    }
}

/// It ends at 1 s.
pub(crate) const ONE: State<f64> = State {
    size: 1.0,
    time: 0.0,
};
