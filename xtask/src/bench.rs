//! `cargo xtask bench`: the product beside its peers, measured here.

use std::fs;
use std::path::PathBuf;

use ahv_generate::Surroundings;

use crate::{python, shell};

/// What the peers need, apart from the project's own environments: other tools in their latest versions.
const REQUIREMENTS: &str = "bench/peers/requirements.txt";

/// Builds the product and CasADi's C, or with `peers` all peers, and measures them beside each other.
pub(crate) fn run(peers: bool) -> Result<(), String> {
    let mut bench = shell::cargo();
    bench.args([
        "run",
        "--locked",
        "--release",
        "--manifest-path",
        shell::BENCH,
    ]);
    bench.arg("--target-dir").arg(shell::target()).arg("--");
    // The baseline target, whatever flags the user has.
    bench
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("RUSTFLAGS", "");
    bench.arg("--out").arg(shell::target().join("bench"));
    if peers {
        let build = ["build", "--release", "--package", "ahv"];
        shell::run(shell::cargo().args(build))?;
        bench
            .arg("--peers")
            .arg(shell::target().join("release/ahv"));
        bench.arg("--python").arg(environment()?);
    } else {
        bench.arg("--python").arg(python::generation()?);
    }
    shell::run(&mut bench)
}

fn environment() -> Result<PathBuf, String> {
    let path = shell::root().join(REQUIREMENTS);
    let text = fs::read_to_string(&path)
        .map_err(|error| format!("error: cannot read {}: {error}", path.display()))?;
    Surroundings::of_process()
        .and_then(|surroundings| ahv_generate::environment("the benchmark", &text, &surroundings))
        .map_err(|failure| failure.to_string())
}
