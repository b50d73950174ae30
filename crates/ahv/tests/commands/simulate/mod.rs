//! `ahv simulate`.

mod adaptive;
mod bench;
mod conditions;
mod faults;
mod runs;
mod si;
