//! The C library of the project's tables, and the system's C compiler.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use ahv_codegen::{Options, Table, Target, Tree, emit};

const STRICT: [&str; 8] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Werror",
    "-ffp-contract=off",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The C tree of the project's tables.
fn tree() -> Tree {
    let read = |path: String| fs::read_to_string(root().join(path)).expect("a file");
    let names = ["com", "dcom", "flexible_mode"];
    let tables = names.map(|name| {
        let file = format!("{name}.toml");
        let text = read(format!("generator/tables/{file}"));
        Table::parse(&file, &text).expect("a table")
    });
    let irs = names.map(|name| (name.to_owned(), read(format!("generated/ir/{name}.json"))));
    let options = Options {
        target: Target::C,
        ..Options::default()
    };
    emit(&tables, &irs.into(), &options).expect("a tree")
}

/// Writes the C library of the project's tables into a folder.
///
/// # Panics
/// Where it cannot be emitted or written.
pub fn write_library(folder: &Path) {
    for (path, text) in tree() {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
}

/// Compiles sources, which are relative to the library's folder, with these flags and warnings denied: by `cc` or what
/// `CC` names.
///
/// # Panics
/// Without a compiler, and where it fails.
pub fn compile(folder: &Path, flags: &[&str], sources: &[String], binary: &Path) {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let mut command = Command::new(compiler);
    command.current_dir(folder).args(STRICT);
    command.args(flags).args(["-Isrc", "-o"]).arg(binary);
    let output = command.args(sources).arg("-lm").output();
    let output = output.unwrap_or_else(|error| {
        panic!("the C compiler does not run ({error}): this test needs one; install gcc or clang, or set CC")
    });
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "the C compiler: {errors}");
}
