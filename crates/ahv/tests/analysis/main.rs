//! `ahv trim`, `ahv linearize` and `ahv poles`, through the real binary.
#![forbid(unsafe_code)]

mod bench;
mod linearize;
mod poles;
mod table;
mod trim;
