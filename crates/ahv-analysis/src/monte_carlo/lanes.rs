//! Members side by side: their numbers, and a model with a parameter of its own in each.

use ahv_core::{GeneratedModel, Lanes, Vector};

/// Members that are flown side by side.
pub const LANES: usize = 8;

/// A number of each member that is flown.
pub type Packed = Lanes<f64, LANES>;

/// The numbers of one member.
pub(super) fn of_lane<V: Vector<Packed>>(
    vector: &V,
    lane: usize,
) -> impl Iterator<Item = f64> + use<'_, V> {
    (0..V::LEN).filter_map(move |index| Some(vector.get(index)?.0[lane]))
}

/// The numbers of [`LANES`] members side by side; 0 for those that are missing.
pub(super) fn side_by_side<V: Vector<Packed>>(members: [&[f64]; LANES]) -> V {
    V::from_fn(|index| Lanes(members.map(|member| member.get(index).copied().unwrap_or(0.0))))
}

/// The model with a parameter of its own in every member.
pub(super) fn packed<F: GeneratedModel>(parameters: [&[f64]; LANES]) -> F::With<Packed> {
    F::generic(&side_by_side(parameters))
}
