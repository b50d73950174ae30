//! `cargo xtask bench`: the figures of docs/benchmarks.md, measured here.

use std::fs;
use std::path::PathBuf;

use ahv_generate::Surroundings;

use crate::shell;

/// What the peers need, apart from the project's own environments: other tools in their latest versions.
const REQUIREMENTS: &str = "crates/ahv-bench/peers/requirements.txt";

/// Builds the product and its peers, and measures them beside each other.
pub(crate) fn run() -> Result<(), String> {
    let build = ["build", "--quiet", "--release", "--package", "ahv-cli"];
    shell::run(shell::cargo().args(build))?;
    let mut bench = shell::cargo();
    bench.args([
        "run",
        "--quiet",
        "--release",
        "--package",
        "ahv-bench",
        "--",
    ]);
    bench.arg("--python").arg(python()?);
    bench
        .arg("--generate")
        .arg(shell::target().join("release/ahv"));
    bench.arg("--out").arg(shell::target().join("bench"));
    shell::run(&mut bench)
}

fn python() -> Result<PathBuf, String> {
    let path = shell::root().join(REQUIREMENTS);
    let text = fs::read_to_string(&path)
        .map_err(|error| format!("error: cannot read {}: {error}", path.display()))?;
    Surroundings::of_process()
        .and_then(|surroundings| ahv_generate::environment("the benchmark", &text, &surroundings))
        .map_err(|failure| failure.to_string())
}
