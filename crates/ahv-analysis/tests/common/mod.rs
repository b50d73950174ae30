//! What many tests begin with.

use ahv_analysis::trim::SteadyState;
use ahv_core::GeneratedModel;

/// The steady state that a model's problem describes where nothing else is asked for: of a vehicle its level flight.
pub(crate) fn level<M: GeneratedModel>() -> SteadyState {
    SteadyState::new(&M::TRIM)
}
