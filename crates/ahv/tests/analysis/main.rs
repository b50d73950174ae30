//! `ahv trim`, `ahv linearize`, `ahv forces` and `ahv poles`, through the real binary.
#![forbid(unsafe_code)]

mod bench;
mod forces;
mod linearize;
mod poles;
mod table;
mod trim;
