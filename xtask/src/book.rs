//! `cargo xtask book`, by the program `book` beside this one.

use crate::shell;

/// Its package; built where the main workspace is.
pub(crate) const PACKAGE: [&str; 6] = [
    "--manifest-path",
    "xtask/Cargo.toml",
    "--package",
    "book",
    "--target-dir",
    "target",
];

/// Builds the book.
pub(crate) fn run() -> Result<(), String> {
    let out = shell::target().join("book");
    let mut book = shell::cargo();
    book.args(["run", "--quiet", "--locked"]).args(PACKAGE);
    shell::run(book.arg("--").arg(shell::root()).arg(out))
}
