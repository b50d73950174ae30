//! `ahv simulate`, through the real binary.
#![forbid(unsafe_code)]

mod bench;
mod conditions;
mod faults;
mod runs;
mod si;
