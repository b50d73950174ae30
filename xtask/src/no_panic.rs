//! The probe of the promise that no panic can be reached: `tests/no-panic` links only while it holds.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell;

const PROBE: &str = "tests/no-panic/src/main.rs";
/// What the linker misses as soon as the panic handler of the probe can be reached.
const MISSED: &str = "undefined symbol: a_panic_can_be_reached";
/// For speed and for size: what can be shown not to panic depends on the optimiser.
const LEVELS: [&str; 2] = ["3", "s"];

/// Links the probe, and shows that it does not link with a planted panic.
pub(crate) fn run(target: &str) -> Result<(), String> {
    every_function_is_called()?;
    for level in LEVELS {
        let built = shell::output(&mut build(target, level));
        built.map_err(|problem| explained(&problem, level))?;
        let planted = shell::output(build(target, level).args(["--features", "plant"]));
        if !planted.is_err_and(|problem| problem.contains(MISSED)) {
            return Err(format!(
                "error: the probe of panics is blind: at opt-level {level} it does not find the planted one"
            ));
        }
    }
    Ok(())
}

fn build(target: &str, level: &str) -> Command {
    let mut cargo = shell::cargo();
    cargo.args(["build", "--quiet", "--locked", "--release"]);
    cargo.args(["--manifest-path", "tests/no-panic/Cargo.toml"]);
    cargo.args(["--target-dir", "target/no-panic", "--target", target]);
    cargo.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level);
    cargo
}

fn explained(problem: &str, level: &str) -> String {
    if problem.contains(MISSED) {
        format!(
            "error: at opt-level {level} a panic can be reached from a generated function or a stepper\n{problem}"
        )
    } else {
        problem.to_owned()
    }
}

/// The probe names every public function of the generated package.
fn every_function_is_called() -> Result<(), String> {
    let probe = read(&shell::root().join(PROBE))?;
    let mut functions = 0;
    for module in entries(&shell::root().join("generated/src"))? {
        if !module.is_dir() {
            continue;
        }
        let name = module.file_name().unwrap_or_default().to_string_lossy();
        for file in entries(&module)? {
            let text = read(&file)?;
            for function in text.lines().filter_map(free_function) {
                functions += 1;
                if !names(&probe, &format!("{name}::{function}")) {
                    return Err(format!("error: {PROBE} does not call {name}::{function}"));
                }
            }
        }
    }
    if functions == 0 {
        return Err("error: found no function in generated/src".to_owned());
    }
    Ok(())
}

/// The name of the function that a line of generated code declares; methods are indented.
fn free_function(line: &str) -> Option<&str> {
    let name = line.strip_prefix("pub fn ")?;
    name.split(['<', '(']).next()
}

/// Whether `text` holds `word` and no longer word there.
fn names(text: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    let ends = |at: usize, found: &str| {
        !text[..at].ends_with(part) && !text[at + found.len()..].starts_with(part)
    };
    text.match_indices(word).any(|(at, found)| ends(at, found))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let failed = |error| format!("error: cannot read {}: {error}", folder.display());
    let entries = fs::read_dir(folder).map_err(failed)?;
    entries
        .map(|entry| entry.map(|it| it.path()).map_err(failed))
        .collect()
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path)
        .map_err(|error| format!("error: cannot read {}: {error}", path.display()))
}
