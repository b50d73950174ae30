//! Elementary functions, from additions, multiplications and divisions alone.
//!
//! The same bits on every machine, and fast where the models work: an angle below π/4 needs no reduction.
//! Polynomials by `scripts/elementary.py`. Errors stay below 1 ulp (`tests/elementary.rs`, `tests/functions.rs`).
//!
//! Sine, cosine and exponential stand for both precisions. All others are computed in doubles, with two of them for what
//! a quotient or a logarithm needs beyond one; a single is rounded from that. They have no branches: what depends on a
//! number is chosen between values.

pub(crate) mod arc;
pub(crate) mod double;
pub(crate) mod logarithm;
mod pair;
mod reduction;
pub(crate) mod single;
pub(crate) mod tangent;
