//! What the schemes need of vectors beside the trait.

use ahv_core::{Real, Vector};

/// Component `index`; 0 out of range.
#[inline(always)]
pub(crate) fn component<R: Real, X: Vector<R>>(x: &X, index: usize) -> R {
    x.get(index).unwrap_or(R::ZERO)
}

/// The vector that is 1 in component `index` and 0 elsewhere.
#[inline(always)]
pub(crate) fn unit<R: Real, X: Vector<R>>(index: usize) -> X {
    X::from_fn(|i| if i == index { R::ONE } else { R::ZERO })
}
