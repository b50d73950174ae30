//! Generating and checking, in projects of all kinds.
#![cfg(unix)]

mod again;
mod bad_tables;
mod c;
mod owned;
mod passes;
mod process;
mod python;
mod scratch;
mod stale;
mod tree;
