//! `cargo xtask` as a person meets it, with the real derivation.
#![cfg(unix)]

mod chain;
mod common;
mod generate;
