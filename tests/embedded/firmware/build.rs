//! Tells the linker the board's memory.

use std::path::PathBuf;
use std::{env, fs};

const MEMORY: &str = "memory.x";

fn main() {
    println!("cargo::rerun-if-changed={MEMORY}");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::copy(MEMORY, out.join(MEMORY)).expect("OUT_DIR is writable");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
}
