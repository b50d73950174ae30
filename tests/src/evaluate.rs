//! Every generated function at a point, by the names that the oracle uses.

use ahv_core::{Pattern, Real, Vector};
use std::collections::BTreeMap;

/// Values by label.
pub type Values = BTreeMap<String, f64>;

type Inputs = BTreeMap<String, f64>;

include!(concat!(env!("OUT_DIR"), "/evaluate.rs"));

/// All functions of a model at a point, computed in `R`.
///
/// Compressed forms are held against the dense ones bit for bit.
///
/// # Panics
/// When the model is unknown or the point lacks a number.
pub fn evaluate<R: Real + PartialEq>(model: &str, inputs: &BTreeMap<String, f64>) -> Values {
    dispatch::<R>(model, inputs)
}

/// The vector of a kind (`state`, `input`, `noise`, `parameter`) from a point's numbers.
///
/// # Panics
/// When the point lacks a component.
pub fn vector<R: Real, V: Vector<R>>(kind: &str, inputs: &BTreeMap<String, f64>) -> V {
    V::from_fn(|index| {
        let label = format!("{kind}.{}", V::NAMES[index]);
        R::from_f64(
            *inputs
                .get(&label)
                .unwrap_or_else(|| panic!("the point has no {label}; run `cargo xtask vectors`")),
        )
    })
}

/// The components of a vector with their names.
fn components<T: Copy, V: Vector<T>>(of: &V) -> Vec<(&'static str, T)> {
    let all = (0..V::LEN).map(|index| of.get(index).expect("a component"));
    V::NAMES.iter().copied().zip(all).collect()
}

fn put<R: Real, V: Vector<R>>(values: &mut Values, prefix: &str, of: &V) {
    for (name, component) in components::<R, V>(of) {
        values.insert(format!("{prefix}.{name}"), component.to_f64());
    }
}

fn put_array<R: Real, const N: usize>(values: &mut Values, prefix: &str, of: &[R; N]) {
    for (index, component) in of.iter().enumerate() {
        values.insert(format!("{prefix}.{index}"), component.to_f64());
    }
}

fn put_rows<R: Real, C: Vector<R>, V: Vector<C>>(values: &mut Values, prefix: &str, of: &V) {
    for (name, row) in components::<C, V>(of) {
        put(values, &format!("{prefix}.{name}"), &row);
    }
}

fn put_cube<R: Real, D: Vector<R>, C: Vector<D>, V: Vector<C>>(
    values: &mut Values,
    prefix: &str,
    of: &V,
) {
    for (name, rows) in components::<C, V>(of) {
        put_rows::<R, D, C>(values, &format!("{prefix}.{name}"), &rows);
    }
}

/// Entries whose first index is not below the second; the others are the same numbers.
fn put_symmetric<R: Real + PartialEq, C: Vector<R>, D: Vector<C>, V: Vector<D>>(
    values: &mut Values,
    prefix: &str,
    of: &V,
) {
    for (name, matrix) in components::<D, V>(of) {
        let rows = components::<C, D>(&matrix);
        for (i, (first, row)) in rows.iter().enumerate() {
            for (j, (second, entry)) in components::<R, C>(row).into_iter().enumerate() {
                if j <= i {
                    values.insert(format!("{prefix}.{name}.{first}.{second}"), entry.to_f64());
                } else {
                    let mirrored = components::<R, C>(&rows[j].1)[i].1;
                    assert!(entry == mirrored, "{prefix}.{name} is not symmetric");
                }
            }
        }
    }
}

/// Holds a compressed matrix against the dense one.
fn held2<R: Real + PartialEq, C: Vector<R>, V: Vector<C>>(
    pattern: &Pattern<2>,
    compressed: &[R],
    dense: &V,
) {
    assert_eq!(pattern.shape, [V::LEN, C::LEN]);
    assert_eq!(pattern.len(), compressed.len());
    for (&[row, column], value) in pattern.at.iter().zip(compressed) {
        let entry = dense.get(row).and_then(|row| row.get(column));
        assert!(entry == Some(*value), "entry {row}, {column}");
    }
    assert!(pattern.at.is_sorted(), "entries stand row by row");
}

/// Holds a compressed array of three indices against the dense one.
fn held3<R: Real + PartialEq, D: Vector<R>, C: Vector<D>, V: Vector<C>>(
    pattern: &Pattern<3>,
    compressed: &[R],
    dense: &V,
) {
    assert_eq!(pattern.shape, [V::LEN, C::LEN, D::LEN]);
    assert_eq!(pattern.len(), compressed.len());
    for (&[i, j, k], value) in pattern.at.iter().zip(compressed) {
        let entry = dense
            .get(i)
            .and_then(|m| m.get(j))
            .and_then(|row| row.get(k));
        assert!(entry == Some(*value), "entry {i}, {j}, {k}");
    }
    assert!(pattern.at.is_sorted(), "entries stand row by row");
}
