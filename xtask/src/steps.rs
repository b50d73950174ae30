//! `cargo xtask test`: everything that must hold before a change goes in.

use std::process::Command;
use std::time::Instant;

use crate::{
    audit, book, c, determinism, firmware, guide, instructions, no_panic, own_vehicle, packages,
    python, shell, wheel,
};

/// Workspaces of their own, built where the main one is: what they share of the registry is built once.
const XTASK: [&str; 4] = [
    "--manifest-path",
    "xtask/Cargo.toml",
    "--target-dir",
    "target",
];
const BENCH: [&str; 4] = ["--manifest-path", shell::BENCH, "--target-dir", "target"];
const BINDINGS: [&str; 4] = ["--manifest-path", shell::BINDINGS, "--target-dir", "target"];
const CONSUMER: [&str; 4] = [
    "--manifest-path",
    "tests/consumer/Cargo.toml",
    "--target-dir",
    "target/consumer",
];
/// Steps whose time is told at the end.
const LISTED: usize = 10;
/// Python of the benchmark, from the generator's folder.
const PEERS: &str = "../bench/peers";
const EXAMPLES: &str = "../examples";
/// A microcontroller: no standard library, no heap.
pub(crate) const BARE_METAL: &str = "thumbv7em-none-eabihf";

enum Outcome {
    Passed,
    /// It could not be run here, and why.
    Skipped(String),
}

type Step = (&'static str, fn() -> Result<Outcome, String>);

const STEPS: [Step; 32] = [
    ("format", || cargo(&["fmt", "--all", "--check"], &[], &[])),
    ("format of xtask", || {
        cargo(&["fmt", "--all", "--check"], &XTASK[..2], &[])
    }),
    ("clippy", || {
        cargo(&["clippy", "--workspace", "--all-targets"], &[], &DENY)
    }),
    ("clippy without generation", || {
        cargo(
            &["clippy", "--package", "ahv", "--no-default-features"],
            &[],
            &DENY,
        )
    }),
    ("clippy of xtask", || {
        cargo(&["clippy", "--all-targets"], &XTASK, &DENY)
    }),
    ("format of bench", || {
        cargo(&["fmt", "--all", "--check"], &BENCH[..2], &[])
    }),
    ("clippy of bench", || {
        cargo(
            &["clippy", "--workspace", "--all-targets", "--locked"],
            &BENCH,
            &DENY,
        )
    }),
    ("format of the bindings", || {
        cargo(
            &["fmt", "--check"],
            &BINDINGS[..2],
            &["-p", "ahv-python", "-p", "ahv-extension"],
        )
    }),
    ("clippy of the bindings", || {
        cargo(
            &[
                "clippy",
                "--package",
                "ahv-python",
                "--all-targets",
                "--locked",
            ],
            &BINDINGS,
            &DENY,
        )
    }),
    ("ruff", || module(&["ruff", "check", ".", PEERS, EXAMPLES])),
    ("ruff format", || {
        module(&["ruff", "format", "--check", ".", PEERS, EXAMPLES])
    }),
    ("mypy", || {
        module(&["mypy", "ahv_generator", "ahv_oracle", "tests", PEERS])
    }),
    ("pytest", || {
        module(&["pytest", "--quiet", "--numprocesses", "2"])
    }),
    ("generate --check", generate_check),
    ("cargo test", || cargo(&["test"], &shell::WORKSPACE, &[])),
    ("cargo test of the steppers", || {
        cargo(&["test"], &shell::STEPPERS, &[])
    }),
    ("audit", accuracy),
    ("determinism", || {
        determinism::run().map(|()| Outcome::Passed)
    }),
    ("clippy of the book", || {
        cargo(&["clippy", "--all-targets"], &book::PACKAGE, &DENY)
    }),
    ("cargo test of the book", || {
        cargo(&["test"], &book::PACKAGE, &[])
    }),
    ("book", || book::run().map(|()| Outcome::Passed)),
    ("cargo test of xtask", || cargo(&["test"], &XTASK, &[])),
    ("consumer", || cargo(&["test"], &CONSUMER, &[])),
    ("consumer, no_std", || {
        bare_metal(|| cargo(&["build", "--lib", "--target", BARE_METAL], &CONSUMER, &[]))
    }),
    ("c", || c::run(false).map(|()| Outcome::Passed)),
    ("own vehicle", || {
        own_vehicle::run().map(|()| Outcome::Passed)
    }),
    ("wheel", || wheel::run(false).map(|()| Outcome::Passed)),
    ("packages", || {
        packages::run(false).map(|()| Outcome::Passed)
    }),
    ("guide", || guide::run().map(|()| Outcome::Passed)),
    ("no panic path", || {
        bare_metal(|| no_panic::run(BARE_METAL).map(|()| Outcome::Passed))
    }),
    ("firmware", || bare_metal(emulated_flights)),
    ("instructions", counted_calls),
];
/// What takes too long for every change, after all else.
const MORE: [Step; 5] = [
    ("clippy of every feature", || {
        cargo(
            &["clippy", "--workspace", "--all-targets", "--all-features"],
            &[],
            &DENY,
        )
    }),
    ("commands with every feature", || {
        cargo(&["test", "--package", "ahv", "--all-features"], &[], &[])
    }),
    ("packages, built", || {
        packages::run(true).map(|()| Outcome::Passed)
    }),
    ("c with clang and clang-tidy", || {
        c::run(true).map(|()| Outcome::Passed)
    }),
    ("audit in full", || {
        audit::run(audit::POINTS, audit::SEEDS).map(|()| Outcome::Passed)
    }),
];
const DENY: [&str; 3] = ["--", "-D", "warnings"];

/// Runs the steps in turn, up to the first that fails; with `all`, those too that take too long for every change.
pub(crate) fn run(all: bool) -> Result<(), String> {
    let (mut passed, mut skipped, mut failed, mut times) = (0, Vec::new(), Vec::new(), Vec::new());
    let more: &[Step] = if all { &MORE } else { &[] };
    let steps = STEPS.iter().chain(more);
    let count = STEPS.len() + more.len();
    for (number, (name, step)) in (1..).zip(steps) {
        println!("== {name} ({number} of {count})");
        let start = Instant::now();
        let outcome = step();
        let seconds = start.elapsed().as_secs_f64();
        times.push((*name, seconds));
        match outcome {
            Ok(Outcome::Passed) => {
                passed += 1;
                println!("== {name}: passed in {seconds:.1} s");
            }
            Ok(Outcome::Skipped(reason)) => {
                println!("== {name}: SKIPPED: {reason}");
                skipped.push(format!("SKIPPED {name}: {reason}"));
            }
            Err(problem) => {
                // The others are told too: who waits this long learns all of it.
                eprintln!("{problem}");
                println!("== {name}: FAILED after {seconds:.1} s");
                failed.push(*name);
            }
        }
    }
    print!("{}", slowest(times));
    for line in &skipped {
        println!("{line}");
    }
    if failed.is_empty() {
        println!("{passed} passed, 0 failed");
        return Ok(());
    }
    Err(format!(
        "error: failed: {}\n{passed} passed, {} failed",
        failed.join(", "),
        failed.len()
    ))
}

/// The slowest steps, the slowest first, and what all took.
fn slowest(mut times: Vec<(&str, f64)>) -> String {
    let all: f64 = times.iter().map(|it| it.1).sum();
    times.sort_by(|a, b| b.1.total_cmp(&a.1));
    let lines = times.iter().take(LISTED);
    let lines = lines.map(|(name, seconds)| format!("  {seconds:>7.1} s  {name}\n"));
    format!("the slowest of {all:.0} s:\n{}", lines.collect::<String>())
}

fn cargo(command: &[&str], place: &[&str], rest: &[&str]) -> Result<Outcome, String> {
    passed(shell::cargo().args(command).args(place).args(rest))
}

fn passed(command: &mut Command) -> Result<Outcome, String> {
    shell::run(command).map(|()| Outcome::Passed)
}

/// A module of the development environment, in the Python project's folder.
fn module(arguments: &[&str]) -> Result<Outcome, String> {
    let mut command = shell::program(python::development()?);
    passed(
        command
            .current_dir(shell::root().join("generator"))
            .arg("-m")
            .args(arguments),
    )
}

/// As a user's CI runs it: with the Python environment of generation alone.
fn generate_check() -> Result<Outcome, String> {
    let own = std::env::current_exe().map_err(|error| format!("error: {error}"))?;
    passed(shell::program(own).args(["generate", "--check"]))
}

/// The audit of accuracy with as few points as a gate can wait for, by the program that `cargo test` has built. What the oracle
/// says of them stays in the cache until oracle or table change; what is generated is always compared with it.
fn accuracy() -> Result<Outcome, String> {
    cargo(&["build", "--bin", "audit"], &shell::WORKSPACE, &[])?;
    let mut audit = shell::program(shell::target().join("debug/audit"));
    audit.args(["--points", "100", "--root"]).arg(shell::root());
    if let Some(cache) = python::cache()? {
        audit.arg("--cache").arg(cache.join("audit"));
    }
    passed(audit.arg("--python").arg(python::development()?))
}

/// A step that needs the target of a microcontroller.
fn bare_metal(step: fn() -> Result<Outcome, String>) -> Result<Outcome, String> {
    let mut add = shell::program("rustup");
    if let Err(problem) = shell::output(add.args(["target", "add", BARE_METAL])) {
        let told = problem.lines().find(|line| line.starts_with("error:"));
        let reason = told.or(problem.lines().last()).unwrap_or_default();
        return Ok(Outcome::Skipped(format!(
            "no target {BARE_METAL}: {reason}"
        )));
    }
    step()
}

/// Flights on a microcontroller, which need QEMU.
fn emulated_flights() -> Result<Outcome, String> {
    match firmware::found() {
        Ok(()) => firmware::run(BARE_METAL, false).map(|()| Outcome::Passed),
        Err(reason) => Ok(Outcome::Skipped(reason)),
    }
}

/// Instructions of a call, which need valgrind.
fn counted_calls() -> Result<Outcome, String> {
    match instructions::found() {
        Ok(()) => instructions::run(false).map(|()| Outcome::Passed),
        Err(reason) => Ok(Outcome::Skipped(reason)),
    }
}
