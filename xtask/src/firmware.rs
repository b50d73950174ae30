//! `cargo xtask firmware`: flights on a Cortex-M7 under QEMU, bit for bit those of the host, and what a step costs there.

mod emulator;
mod image;
mod report;

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use self::emulator::LIMIT;
pub(crate) use self::emulator::found;
use self::report::{Row, compare, documented, table};
use crate::shell;

const MANIFEST: [&str; 2] = ["--manifest-path", "tests/embedded/Cargo.toml"];
const PACKAGES: [&str; 4] = ["--package", "firmware", "--package", "flights"];
const TARGET_DIR: [&str; 2] = ["--target-dir", "target/embedded"];
const PAGE: &str = "docs/embedded.md";
/// The firmware programs, which are named after what they fly.
const FLIGHTS: [&str; 3] = ["idle", "dcom", "sdcom"];
/// Flight, step and component in which the feature `plant` flips a bit.
const PLANTED: (&str, u32, &str) = ("dcom", 500, "alpha");

/// How the firmware is compiled.
struct Build {
    name: &'static str,
    /// For the compiler; the user's own flags do not count, for they would change the figures.
    flags: &'static str,
    /// Whether doubles are added and multiplied by instructions.
    hardware: bool,
}

const BUILDS: [Build; 2] = [
    Build {
        name: "hardware f64",
        flags: "-C target-cpu=cortex-m7",
        hardware: true,
    },
    Build {
        name: "software f64",
        flags: "",
        hardware: false,
    },
];

/// Flies on the host and under the emulator, compares the states, prints the costs, and holds `docs/embedded.md` to them
/// or, with `write`, writes them there.
pub(crate) fn run(target: &str, write: bool) -> Result<(), String> {
    found()?;
    let mut fmt = shell::cargo();
    fmt.args(["fmt", "--check"]).args(MANIFEST).args(PACKAGES);
    shell::run(&mut fmt)?;
    let mut clippy = cargo("clippy", &PACKAGES);
    // The host's program among the binaries has no place there.
    clippy.args([
        "--release",
        "--lib",
        "--bin",
        FLIGHTS[0],
        "--target",
        target,
    ]);
    shell::run(clippy.args(["--", "-D", "warnings"]))?;
    shell::run(&mut cargo("test", &["--test", "flights"]))?;
    let host: Vec<String> = FLIGHTS.into_iter().map(host).collect::<Result<_, _>>()?;
    let mut rows = Vec::new();
    for build in &BUILDS {
        shell::run(&mut firmware(build, target))?;
        for (flight, host) in FLIGHTS.into_iter().zip(&host) {
            rows.push(row(build, target, flight, host)?);
        }
    }
    planted(target, &host)?;
    let table = table(&rows);
    print!("{table}");
    let page = shell::root().join(PAGE);
    let problem = |error| format!("error: {PAGE}: {error}");
    let text = fs::read_to_string(&page).map_err(problem)?;
    let place = documented(&text).ok_or(format!("error: {PAGE} has no table of costs"))?;
    if text[place.clone()] == table {
        return Ok(());
    }
    if !write {
        return Err(format!(
            "error: {PAGE} has another table; to write this one, run:  cargo xtask firmware --write"
        ));
    }
    let text = format!("{}{table}{}", &text[..place.start], &text[place.end..]);
    fs::write(&page, text).map_err(problem)
}

fn cargo(command: &str, arguments: &[&str]) -> Command {
    let mut cargo = shell::cargo();
    cargo.args([command, "--quiet", "--locked"]);
    cargo.args(MANIFEST).args(TARGET_DIR).args(arguments);
    cargo
}

fn firmware(build: &Build, target: &str) -> Command {
    let mut cargo = cargo("build", &["--package", "firmware", "--release"]);
    cargo.args(["--target", target]);
    cargo.env_remove("CARGO_ENCODED_RUSTFLAGS");
    cargo.env("RUSTFLAGS", build.flags);
    cargo
}

/// What the host prints of a flight.
fn host(flight: &str) -> Result<String, String> {
    let mut run = cargo("run", &["--package", "flights", "--", flight]);
    shell::output(&mut run)
}

/// Where cargo puts a firmware program.
fn program(target: &str, flight: &str) -> PathBuf {
    let folder = shell::root().join(TARGET_DIR[1]).join(target);
    folder.join("release").join(flight)
}

fn row<'a>(build: &Build, target: &str, flight: &'a str, host: &str) -> Result<Row<'a>, String> {
    let at = |problem: String| format!("error: {flight}, {}: {problem}", build.name);
    let program = program(target, flight);
    let image = image::read(&program).map_err(at)?;
    // What stands still adds no doubles.
    if flight != FLIGHTS[0] && image.soft_doubles == build.hardware {
        return Err(at(format!(
            "compiled with `{}`, yet doubles are added by {}",
            build.flags,
            if build.hardware {
                "software"
            } else {
                "hardware"
            }
        )));
    }
    let printed = emulator::run(&program, LIMIT).map_err(at)?;
    let costs = compare(host, &printed).map_err(at)?;
    Ok(Row {
        build: build.name,
        flight,
        costs,
        flash: image.flash,
    })
}

/// Shows that one flipped bit is found, and named.
fn planted(target: &str, host: &[String]) -> Result<(), String> {
    let (flight, step, component) = PLANTED;
    let mut build = firmware(&BUILDS[0], target);
    shell::run(build.args(["--features", "plant", "--bin", flight]))?;
    let printed = emulator::run(&program(target, flight), LIMIT)?;
    let host = FLIGHTS
        .into_iter()
        .zip(host)
        .find(|(name, _)| *name == flight);
    let found = host.map(|(_, host)| compare(host, &printed));
    let wanted = format!("step {step}: {component} ");
    match found {
        Some(Err(problem)) if problem.starts_with(&wanted) => Ok(()),
        _ => Err("error: the comparison is blind: it does not find the planted bit".into()),
    }
}
