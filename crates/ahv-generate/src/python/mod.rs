//! The Python that derives: which interpreter, and the package that it runs.

mod environment;
mod interpreter;
mod package;

use std::env;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::failure::Failure;
use crate::surroundings::Surroundings;

pub use environment::environment;

/// What the derivation imports, and an interpreter named by `AHV_PYTHON` must therefore have.
const MODULES: [&str; 2] = ["casadi", "pint"];
/// How Python starts the report of an exception.
const TRACEBACK: &str = "Traceback (most recent call last)";
const REQUIREMENTS: &str = include_str!("../../python/requirements.txt");

/// What decides about the IR of a table: the generator with the packages that it runs with.
pub(crate) fn sources() -> impl Iterator<Item = &'static str> {
    package::sources().chain([REQUIREMENTS])
}

/// The version of CasADi that is locked. An interpreter that `AHV_PYTHON` names may have another.
pub(crate) fn casadi_version() -> Option<&'static str> {
    let mut lines = REQUIREMENTS.lines();
    lines.find_map(|line| line.strip_prefix("casadi==")?.split([' ', '\\']).next())
}

/// An interpreter that can run the generator, and the folder of the generator.
pub(crate) struct Generator {
    interpreter: PathBuf,
    given: bool,
    package: PathBuf,
}

/// The interpreter that `AHV_PYTHON` names, else one of ahv's own environment.
pub(crate) fn for_generation(surroundings: &Surroundings) -> Result<Generator, Failure> {
    let interpreter = match &surroundings.python {
        Some(given) => interpreter::given(given)?,
        None => environment("generation", REQUIREMENTS, surroundings)?,
    };
    Ok(Generator {
        interpreter,
        given: surroundings.python.is_some(),
        package: package::unpack(surroundings.cache()?)?,
    })
}

impl Generator {
    /// The generator, ready for its arguments.
    pub(crate) fn command(&self) -> Command {
        let mut command = if self.given {
            given_command(self.interpreter.as_os_str())
        } else {
            isolated(&self.interpreter)
        };
        // -P: a file in the current folder must not be taken for a module.
        command.args(["-P", "-X", "utf8"]).arg(&self.package);
        // The generator ends when this pipe is closed: with this process, however that ends.
        command.stdin(Stdio::piped());
        command
    }
}

/// A Python without input that no variable of the environment changes: not where it looks for modules, not how it prints, not
/// what it does at its end.
fn isolated(python: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(python);
    for (name, _) in env::vars_os() {
        let text = name.to_string_lossy();
        if text.starts_with("PYTHON") || text == "__PYVENV_LAUNCHER__" {
            command.env_remove(name);
        }
    }
    command.arg("-E").stdin(Stdio::null());
    command
}

/// The same for the interpreter that `AHV_PYTHON` names. Its modules may lie in the caller's PYTHONPATH: the program
/// that runs appends that itself, so that it hides nothing of the standard library.
fn given_command(python: &OsStr) -> Command {
    let mut command = isolated(python);
    if let Some(path) = env::var_os("PYTHONPATH") {
        command.env("PYTHONPATH", path);
    }
    command
}

/// The end of what a program printed, as further lines of a message. Of a traceback of Python only what it is about.
pub(crate) fn last_lines(output: &[u8]) -> String {
    const KEPT: usize = 12;
    let text = String::from_utf8_lossy(output);
    let traceback = text.contains(TRACEBACK);
    let frame = |line: &str| traceback && (line.starts_with(TRACEBACK) || line.starts_with(' '));
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !frame(line))
        .collect();
    let first = lines.len().saturating_sub(KEPT);
    lines[first..]
        .iter()
        .map(|line| format!("\n    {}", line.trim_end()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::last_lines;

    #[test]
    fn of_a_traceback_the_error_is_left() {
        let said = "warning\nTraceback (most recent call last):\n  File \"a.py\", line 1, in f\n    f()\n    ^^^\n\
                    OverflowError: too large\n";
        assert_eq!(
            last_lines(said.as_bytes()),
            "\n    warning\n    OverflowError: too large"
        );
        assert_eq!(last_lines(b"one\n  two\n"), "\n    one\n      two");
    }
}
