//! What the tests of the whole chain and the audit share: reference vectors, and the generated functions by name.
#![forbid(unsafe_code)]

pub mod c;
pub mod evaluate;
pub mod measure;
pub mod vectors;

/// The Rust in the documentation must compile and run.
#[cfg(doctest)]
mod docs {
    #[doc = include_str!("../../docs/integrators.md")]
    mod integrators {}

    #[doc = include_str!("../../docs/link.md")]
    mod link {}

    #[doc = include_str!("../../README.md")]
    mod readme {}
}
