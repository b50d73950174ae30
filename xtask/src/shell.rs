//! Running other programs in the repository.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the repository.
pub(crate) fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here)
}

/// Where cargo puts what it builds in the main workspace.
pub(crate) fn target() -> PathBuf {
    root().join(env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()))
}

/// The workspace of the benchmark.
pub(crate) const BENCH: &str = "bench/Cargo.toml";

/// The workspace of the bindings of Python.
pub(crate) const BINDINGS: &str = "crates/ahv-python/Cargo.toml";

/// The packages of the main workspace but for [`STEPPERS`]. Of what they use they have the features that a stranger's `ahv` has
/// of it, and so both are built once.
pub(crate) const WORKSPACE: [&str; 5] = [
    "--workspace",
    "--exclude",
    "ahv-integrate",
    "--exclude",
    "ahv-steppers",
];

/// The packages that need `rand`, which no other has.
pub(crate) const STEPPERS: [&str; 6] = [
    "--package",
    "ahv-integrate",
    "--package",
    "ahv-steppers",
    "--features",
    "ahv-core/std",
];

/// The cargo that runs this program, at the repository's root.
pub(crate) fn cargo() -> Command {
    program(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Any program, at the repository's root.
pub(crate) fn program(name: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root());
    command
}

/// Runs a program that prints for itself.
pub(crate) fn run(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("error: {} failed ({status})", shown(command))),
        Err(error) => Err(format!("error: cannot run {}: {error}", shown(command))),
    }
}

/// Runs a program and gives its standard output.
pub(crate) fn output(command: &mut Command) -> Result<String, String> {
    finished(command).map(|output| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Runs a program and gives what it says beside its output.
pub(crate) fn messages(command: &mut Command) -> Result<String, String> {
    finished(command).map(|output| String::from_utf8_lossy(&output.stderr).into_owned())
}

fn finished(command: &mut Command) -> Result<Output, String> {
    match command.output() {
        Ok(output) if output.status.success() => Ok(output),
        Ok(output) => Err(format!(
            "error: {} failed ({})\n{}",
            shown(command),
            output.status,
            String::from_utf8_lossy(&output.stderr).trim_end()
        )),
        Err(error) => Err(format!("error: cannot run {}: {error}", shown(command))),
    }
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    format!("`{}`", words.join(" "))
}
