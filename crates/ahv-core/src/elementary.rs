//! Sine, cosine and exponential, from additions and multiplications alone.
//!
//! The same bits on every machine, and fast where the models work: an angle below π/4 needs no reduction.
//! Polynomials by `scripts/elementary.py`. Errors stay below 1 ulp (`tests/elementary.rs`).

pub(crate) mod double;
pub(crate) mod single;
