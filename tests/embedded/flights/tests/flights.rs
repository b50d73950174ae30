//! The flights are worth comparing: every state moves, and none leaves the box of validity.

use ahv_core::{Bounds, Vector, first_outside};
use ahv_models::{dcom, sdcom};
use flights::{Dcom, Flight, STEPS, Sdcom};

fn moves_within<F: Flight>(bounds: &impl Vector<Bounds>) {
    let mut flight = F::at_start();
    let start = flight.state();
    for step in 1..=STEPS {
        flight.step().unwrap();
        let outside = first_outside(&flight.state(), bounds);
        assert!(outside.is_none(), "step {step} of {}: {outside:?}", F::NAME);
    }
    for (index, name) in F::State::NAMES.iter().enumerate() {
        assert_ne!(start.get(index), flight.state().get(index), "{name}");
    }
}

#[test]
fn every_state_moves_within_the_box() {
    moves_within::<Dcom>(&dcom::STATE_BOUNDS);
    moves_within::<Sdcom>(&sdcom::STATE_BOUNDS);
}
