//! `ahv simulate`, through the real binary.
#![forbid(unsafe_code)]

mod bench;
mod faults;
mod runs;
