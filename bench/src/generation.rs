//! The time of the generator's command.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde::Serialize;
use serde_json::Value;

use crate::commands;
use crate::rounds::Spread;

const RUNS: u32 = 5;

/// Seconds of `generate` on all tables, into an empty folder.
#[derive(Serialize)]
pub(crate) struct Generation {
    pub(crate) total: Spread,
    pub(crate) derive: Spread,
    pub(crate) emit: Spread,
    pub(crate) runs: u32,
}

/// Runs `program generate --json` several times, after one run that sets up what is missing.
pub(crate) fn measure(program: &Path, out: &Path) -> Result<Generation, String> {
    let scratch = out.join("generated");
    once(program, &scratch)?;
    let mut seconds = [Vec::new(), Vec::new(), Vec::new()];
    for _ in 0..RUNS {
        for (all, one) in seconds.iter_mut().zip(once(program, &scratch)?) {
            all.push(one);
        }
    }
    let [total, derive, emit] = seconds.map(Spread::of);
    Ok(Generation {
        total,
        derive,
        emit,
        runs: RUNS,
    })
}

/// Seconds in all, of derivation, and of emission.
fn once(program: &Path, scratch: &Path) -> Result<[f64; 3], String> {
    if scratch.exists() {
        fs::remove_dir_all(scratch).map_err(commands::problem("remove", scratch))?;
    }
    let start = Instant::now();
    let mut command = Command::new(program);
    command
        .current_dir(crate::root())
        .args(["generate", "--json", "--out"])
        .arg(scratch);
    let said = commands::output(&mut command)?;
    let total = start.elapsed().as_secs_f64();
    let said: Value = serde_json::from_str(&said).unwrap_or_default();
    let part = |name: &str| {
        let seconds = said["seconds"][name].as_f64();
        seconds.ok_or_else(|| format!("error: {} does not say its seconds", program.display()))
    };
    Ok([total, part("derive")?, part("emit")?])
}
