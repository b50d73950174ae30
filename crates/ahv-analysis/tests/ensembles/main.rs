//! Many flights: the engine, what is computed of its outcomes, and the linear covariance beside them.
//!
//! One program, because the engine takes long to compile for a model.
#![forbid(unsafe_code)]

mod chain;
#[path = "../common/mod.rs"]
mod common;
mod control_variate;
mod covariance;
mod coverage;
mod feedback;
mod monte_carlo;
mod rare;
mod small;
mod spread;
