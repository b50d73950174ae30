//! The Monte Carlo of SDCOM as a process: from its start to the outcome.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde::Serialize;
use serde_json::Value;

use crate::arrays::{Answer, Turn, ask_once};
use crate::commands;
use crate::monte_carlo::problem::{DT, MEMBERS, STEPS};
use crate::rounds::Spread;
use crate::setting::Setting;
use crate::table::Table;

/// Threads of all.
const THREADS: usize = 2;
/// Runs of each, taken in turns.
const RUNS: usize = 3;

/// Seconds of a process.
#[derive(Serialize)]
pub(crate) struct Process {
    pub(crate) name: &'static str,
    pub(crate) how: &'static str,
    pub(crate) seconds: Spread,
}

/// Those of `ahv montecarlo`, JAX, numba, and numba without what it takes to compile.
pub(crate) const NAMES: [&str; 4] = ["ahv", "JAX", "numba", "numba, cached"];
const HOW: [&str; 4] = [
    "`ahv montecarlo`, f64, with trim and statistics",
    "import, `jit`, one turn",
    "import, `njit`, one turn",
    "the same less the compilation, as if a cache had it",
];

/// Runs all of them.
pub(crate) fn measure(
    setting: &Setting,
    program: &Path,
    problem: &Value,
) -> Result<Vec<Process>, String> {
    eprintln!("timing processes");
    let mut seconds: [Vec<f64>; NAMES.len()] = Default::default();
    for run in 0..RUNS {
        let seed = run as u64;
        let numba = peer(setting, "numba", problem, seed)?;
        let times = [
            own(program, seed)?,
            peer(setting, "jax", problem, seed)?[0],
            numba[0],
            numba[0] - numba[1],
        ];
        for (all, one) in seconds.iter_mut().zip(times) {
            all.push(one);
        }
    }
    let named = NAMES.into_iter().zip(HOW).zip(seconds);
    let processes = named.map(|((name, how), seconds)| Process {
        name,
        how,
        seconds: Spread::of(seconds),
    });
    Ok(processes.collect())
}

fn own(program: &Path, seed: u64) -> Result<f64, String> {
    let start = Instant::now();
    let mut command = Command::new(program);
    command.args(["montecarlo", "--model", "sdcom", "--json"]);
    for (option, value) in [
        ("--scheme", "euler-maruyama".to_owned()),
        ("--members", MEMBERS.to_string()),
        ("--t-end", (STEPS as f64 * DT).to_string()),
        ("--dt", DT.to_string()),
        ("--threads", THREADS.to_string()),
        ("--seed", seed.to_string()),
        // The others look at the end alone.
        ("--snapshots", "1".to_owned()),
    ] {
        command.args([option, &value]);
    }
    commands::output(&mut command)?;
    Ok(start.elapsed().as_secs_f64())
}

/// Seconds in all, and those of the compilation.
fn peer(setting: &Setting, package: &str, problem: &Value, seed: u64) -> Result<[f64; 2], String> {
    let start = Instant::now();
    let turn = Turn {
        values: true,
        ..Turn::of(seed)
    };
    let Answer { first, .. } = ask_once(setting, package, THREADS, problem, "monte_carlo", turn)?;
    Ok([start.elapsed().as_secs_f64(), first])
}

/// For people.
pub(crate) fn table(processes: &[Process]) -> Table {
    let own = processes.first().map_or(f64::NAN, |it| it.seconds.median);
    let row = |it: &Process| {
        let Spread {
            lower_quartile,
            median,
            upper_quartile,
            ..
        } = it.seconds;
        vec![
            it.name.to_owned(),
            it.how.to_owned(),
            format!("{median:.3}"),
            format!("{lower_quartile:.3}–{upper_quartile:.3}"),
            format!("{:.3}", own / median),
        ]
    };
    Table {
        title: "Monte Carlo of SDCOM as a process".to_owned(),
        note: format!(
            "The {MEMBERS} flights of {STEPS} steps that the rates above are of, from the start of the program to the outcome, on {THREADS} \
             threads; {RUNS} runs, taken in turns. The longer the work, the less the start counts: the rates above are what \
             remains."
        ),
        columns: vec!["candidate", "how", "s", "quartiles", "ahv over it"],
        rows: processes.iter().map(row).collect(),
    }
}
