//! The Python environments of the project, kept where `ahv generate` keeps its own.

use std::fs;
use std::path::PathBuf;

use ahv_generate::Surroundings;

use crate::shell;

/// Makes both environments, and says where they are.
pub(crate) fn set_up() -> Result<(), String> {
    println!("generation:  {}", generation()?.display());
    println!("development: {}", development()?.display());
    Ok(())
}

/// The interpreter that has what generation needs.
pub(crate) fn generation() -> Result<PathBuf, String> {
    environment("generation", "generator/requirements.txt")
}

/// The interpreter that has what tests and the audit need.
pub(crate) fn development() -> Result<PathBuf, String> {
    environment("development", "generator/requirements-dev.txt")
}

/// The interpreter that has the large checkers of C: clang and clang-tidy.
pub(crate) fn checkers_of_c() -> Result<PathBuf, String> {
    environment("checking C", "generator/requirements-c.txt")
}

/// The interpreter that has what the bindings are built and tested with.
pub(crate) fn bindings() -> Result<PathBuf, String> {
    environment("the bindings", "crates/ahv-python/requirements-dev.txt")
}

/// The folder where the environments are, and what else stays from run to run.
pub(crate) fn cache() -> Result<Option<PathBuf>, String> {
    let surroundings = Surroundings::of_process().map_err(|failure| failure.to_string())?;
    Ok(surroundings.cache)
}

fn environment(purpose: &str, requirements: &str) -> Result<PathBuf, String> {
    let path = shell::root().join(requirements);
    let text = fs::read_to_string(&path)
        .map_err(|error| format!("error: cannot read {}: {error}", path.display()))?;
    Surroundings::of_process()
        .and_then(|surroundings| ahv_generate::environment(purpose, &text, &surroundings))
        .map_err(|failure| failure.to_string())
}
