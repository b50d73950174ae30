//! `ahv simulate`.

mod bench;
mod conditions;
mod faults;
mod runs;
mod si;
