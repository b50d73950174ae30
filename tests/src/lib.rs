//! What the tests of the whole chain and the audit share: reference vectors, and the generated functions by name.
#![forbid(unsafe_code)]

pub mod evaluate;
pub mod measure;
pub mod vectors;
