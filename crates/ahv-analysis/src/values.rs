//! Vectors as slices, in the order of their names.

use ahv_core::Vector;
use nalgebra::DMatrix;

/// The components of a vector, in order.
pub fn values<T: Copy, V: Vector<T>>(vector: &V) -> Vec<T> {
    (0..V::LEN).filter_map(|index| vector.get(index)).collect()
}

/// The vector of these components; 0 for those that are missing.
pub fn vector<V: Vector<f64>>(values: &[f64]) -> V {
    V::from_fn(|index| values.get(index).copied().unwrap_or(0.0))
}

/// A matrix of a vector of rows.
#[inline(never)]
pub(crate) fn matrix<Row: Vector<f64>, Rows: Vector<Row>>(rows: &Rows) -> DMatrix<f64> {
    DMatrix::from_fn(Rows::LEN, Row::LEN, |row, column| {
        let row: Option<Row> = rows.get(row);
        row.and_then(|row| row.get(column)).unwrap_or(0.0)
    })
}
