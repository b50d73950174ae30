//! What is computed, against 50-digit arithmetic; what intervals say, against what they hold.

use crate::{python, shell};

/// Points of each function, in full.
pub(crate) const POINTS: u32 = 10_000;
/// Seeds of each interval, in full.
pub(crate) const SEEDS: u32 = 400;

/// Both, with so many points and seeds.
pub(crate) fn run(points: u32, seeds: u32) -> Result<(), String> {
    accuracy(points)?;
    coverage(seeds)
}

fn accuracy(points: u32) -> Result<(), String> {
    let python = python::development()?;
    let mut audit = shell::cargo();
    audit.args([
        "run",
        "--release",
        "--package",
        "ahv-tests",
        "--bin",
        "audit",
        "--",
    ]);
    audit
        .args(["--points", &points.to_string(), "--python"])
        .arg(python);
    shell::run(&mut audit)
}

/// The test of the intervals' coverage, which the gate runs with few seeds.
fn coverage(seeds: u32) -> Result<(), String> {
    let mut test = shell::cargo();
    test.args(["test", "--release", "--package", "ahv-analysis"]);
    test.args([
        "--test",
        "ensembles",
        "coverage",
        "--",
        "--nocapture",
        "--test-threads",
        "1",
    ]);
    shell::run(test.env("AHV_COVERAGE_SEEDS", seeds.to_string()))
}
