//! Vectors as slices, in the order of their names.

use ahv_core::Vector;

/// The components of a vector, in order.
pub fn values<T: Copy, V: Vector<T>>(vector: &V) -> Vec<T> {
    (0..V::LEN).filter_map(|index| vector.get(index)).collect()
}

/// The vector of these components; 0 for those that are missing.
pub fn vector<V: Vector<f64>>(values: &[f64]) -> V {
    V::from_fn(|index| values.get(index).copied().unwrap_or(0.0))
}
