//! Analyses of the flight models.
//!
//! * [`trim`]: the state and input of steady level flight.
//! * [`noise`]: Wiener increments that depend on seed, member, channel and step alone.
#![forbid(unsafe_code)]

pub mod noise;
pub mod trim;
