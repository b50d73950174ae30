//! The Python that derives: which interpreter, and the package that it runs.

mod environment;
mod interpreter;
mod package;

use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

use crate::failure::Failure;
use crate::surroundings::Surroundings;

pub use environment::environment;

/// What the derivation imports, and an interpreter named by `AHV_PYTHON` must therefore have.
const MODULES: [&str; 2] = ["casadi", "pint"];
const REQUIREMENTS: &str = include_str!("../../python/requirements.txt");

/// An interpreter that can run the generator, and the folder of the generator.
pub(crate) struct Generator {
    interpreter: PathBuf,
    search_path: OsString,
}

/// The interpreter that `AHV_PYTHON` names, else one of ahv's own environment.
pub(crate) fn for_generation(surroundings: &Surroundings) -> Result<Generator, Failure> {
    let (interpreter, inherited) = match &surroundings.python {
        // Its modules may be found through the caller's PYTHONPATH, so that stays.
        Some(given) => (interpreter::given(given)?, env::var_os("PYTHONPATH")),
        None => (environment("generation", REQUIREMENTS, surroundings)?, None),
    };
    let package = package::unpack(&surroundings.cache)?;
    let folders = [package]
        .into_iter()
        .chain(inherited.iter().flat_map(env::split_paths));
    let search_path = env::join_paths(folders).map_err(|error| {
        Failure::new(format!(
            "the cache folder cannot stand in PYTHONPATH: {error}"
        ))
        .with_help("set AHV_CACHE_DIR to another folder")
    })?;
    Ok(Generator {
        interpreter,
        search_path,
    })
}

impl Generator {
    /// `python -m ahv_generator`, ready for its arguments.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.interpreter);
        // -P: a file in the current folder must not be taken for a module.
        command.args(["-P", "-X", "utf8", "-m", "ahv_generator"]);
        command.env("PYTHONPATH", &self.search_path);
        command
    }
}

/// The end of what a program printed, as further lines of a message.
pub(crate) fn last_lines(output: &[u8]) -> String {
    const KEPT: usize = 12;
    let text = String::from_utf8_lossy(output);
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let first = lines.len().saturating_sub(KEPT);
    lines[first..]
        .iter()
        .map(|line| format!("\n    {}", line.trim_end()))
        .collect()
}
