//! Generating and checking, in projects of all kinds.
#![cfg(unix)]

mod bad_tables;
mod passes;
mod python;
mod scratch;
mod tree;
