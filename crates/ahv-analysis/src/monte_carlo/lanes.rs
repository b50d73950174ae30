//! Members side by side: their numbers, and a model with a parameter of its own in each.

use ahv_core::{GeneratedModel, Lanes, Real, Vector};

/// Members that are flown side by side.
pub const LANES: usize = 8;

/// A number of each member that is flown.
pub type Packed = Lanes<f64, LANES>;

/// The model with a parameter of its own in every member.
pub(super) fn packed<F: GeneratedModel>(
    parameters: &[F::ParametersOf<f64>; LANES],
) -> F::With<Packed> {
    let mut packed = F::ParametersOf::splat(Packed::ZERO);
    for (lane, &parameters) in parameters.iter().enumerate() {
        F::update_parameters(&mut packed, parameters, |packed, value| {
            packed.0[lane] = value
        });
    }
    F::generic(&packed)
}
