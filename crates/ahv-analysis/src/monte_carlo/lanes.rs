//! Members side by side: their numbers, and a model with a parameter of its own in each.

use ahv_core::{GeneratedModel, Lanes, Vector};

/// Members that are flown side by side.
pub const LANES: usize = 8;

/// A number of each member that is flown.
pub type Packed = Lanes<f64, LANES>;

/// Adds the numbers of one member.
#[inline(never)]
pub(super) fn push_lane<V: Vector<Packed>>(vector: &V, lane: usize, numbers: &mut Vec<f64>) {
    numbers.extend((0..V::LEN).filter_map(|index| Some(vector.get(index)?.0[lane])));
}

/// The numbers of one member.
pub(super) fn of_lane<V: Vector<Packed>>(vector: &V, lane: usize) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(V::LEN);
    push_lane(vector, lane, &mut numbers);
    numbers
}

/// The numbers of [`LANES`] members side by side; 0 for those that are missing.
#[inline(never)]
pub(super) fn side_by_side<V: Vector<Packed>>(members: [&[f64]; LANES]) -> V {
    V::from_fn(|index| Lanes(members.map(|member| member.get(index).copied().unwrap_or(0.0))))
}

/// The model with a parameter of its own in every member.
#[inline(never)]
pub(super) fn packed<F: GeneratedModel>(parameters: [&[f64]; LANES]) -> F::With<Packed> {
    F::generic(&side_by_side(parameters))
}
