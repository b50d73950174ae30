//! The probe of the promise that no panic can be reached: `tests/no-panic` links only while it holds.

use std::process::Command;
use std::thread;

use crate::shell;

/// What the linker misses as soon as the panic handler of the probe can be reached.
const MISSED: &str = "undefined symbol: a_panic_can_be_reached";
/// For speed and for size: what can be shown not to panic depends on the optimiser.
const LEVELS: [&str; 2] = ["3", "s"];

/// Links the probe, which calls every public function of the generated package and every stepper, and shows that it does
/// not link with a planted panic.
pub(crate) fn run(target: &str) -> Result<(), String> {
    // Most of a build is one thread's work: the levels run side by side.
    let outcomes = thread::scope(|scope| {
        let running = LEVELS.map(|level| scope.spawn(move || probe(target, level)));
        running.map(|level| level.join())
    });
    for outcome in outcomes {
        outcome.map_err(|_| "error: the probe of panics has panicked".to_owned())??;
    }
    Ok(())
}

fn probe(target: &str, level: &str) -> Result<(), String> {
    let built = shell::output(&mut build(target, level));
    built.map_err(|problem| explained(&problem, level))?;
    let planted = shell::output(build(target, level).args(["--features", "plant"]));
    if !planted.is_err_and(|problem| problem.contains(MISSED)) {
        return Err(format!(
            "error: the probe of panics is blind: at opt-level {level} it does not find the planted one"
        ));
    }
    Ok(())
}

fn build(target: &str, level: &str) -> Command {
    let mut cargo = shell::cargo();
    cargo.args(["build", "--quiet", "--locked", "--release"]);
    cargo.args(["--manifest-path", "tests/no-panic/Cargo.toml"]);
    cargo.args(["--target-dir", &format!("target/no-panic/{level}")]);
    cargo.args(["--target", target]);
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
