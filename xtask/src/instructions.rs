//! `cargo xtask instructions`: what a call of the generated functions and of the steppers costs in instructions, which is the
//! same on a noisy machine as on a quiet one.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::shell;

const PACKAGE: &str = "ahv-bench-kernels";
const PROGRAM: &str = "instructions";
/// The figures, by name.
const FIGURES: &str = "bench/kernels/instructions.json";
const VALGRIND: &str = "valgrind";
/// Counts instructions and nothing else.
const OPTIONS: [&str; 3] = [
    "--tool=cachegrind",
    "--cache-sim=no",
    "--cachegrind-out-file=/dev/null",
];
/// The copies of glibc that every x86_64 can run: it would choose others by the processor.
const TUNABLES: (&str, &str) = (
    "GLIBC_TUNABLES",
    "glibc.cpu.hwcaps=-AVX2,-AVX_Fast_Unaligned_Load,-AVX512VL,-ERMS,-FSRM",
);
/// Calls of two runs; as many digits in both, so that the runs differ in nothing else.
const CALLS: [u64; 2] = [1000, 2000];
/// Share by which a count may differ from its figure.
const TOLERANCE: f64 = 0.02;

type Figures = BTreeMap<String, f64>;

/// Whether instructions can be counted here; if not, what to do.
pub(crate) fn found() -> Result<(), String> {
    if !cfg!(target_arch = "x86_64") {
        return Err("the figures are those of x86_64".to_owned());
    }
    match Command::new(VALGRIND).arg("--version").output() {
        Ok(output) if output.status.success() => Ok(()),
        _ => Err(format!(
            "no {VALGRIND} to count with; Debian has it in the package of that name"
        )),
    }
}

/// Counts, prints, and holds the counts to the figures or, with `write`, writes them there.
pub(crate) fn run(write: bool) -> Result<(), String> {
    found()?;
    shell::run(&mut build())?;
    let program = shell::target().join("release/examples").join(PROGRAM);
    let names = shell::output(&mut shell::program(&program))?;
    let measured: Figures = names
        .lines()
        .map(|name| Ok((name.to_owned(), per_call(&program, name)?)))
        .collect::<Result<_, String>>()?;
    let path = shell::root().join(FIGURES);
    let problem = |error: &dyn std::fmt::Display| format!("error: {FIGURES}: {error}");
    if write {
        let text = serde_json::to_string_pretty(&measured).map_err(|it| problem(&it))?;
        fs::write(&path, text + "\n").map_err(|it| problem(&it))?;
        print!("{}", table(&measured, &measured).0);
        return Ok(());
    }
    let text = fs::read_to_string(&path).map_err(|it| problem(&it))?;
    let figures: Figures = serde_json::from_str(&text).map_err(|it| problem(&it))?;
    let (table, held) = table(&figures, &measured);
    print!("{table}");
    if held {
        return Ok(());
    }
    Err(format!(
        "error: counts differ from {FIGURES} by more than {} %; to write them there, run:  cargo xtask instructions --write",
        100.0 * TOLERANCE
    ))
}

/// The baseline target, whatever flags the user has.
fn build() -> Command {
    let mut cargo = shell::cargo();
    cargo
        .args(["build", "--locked", "--release", "--package", PACKAGE])
        .args(["--example", PROGRAM, "--manifest-path", shell::BENCH])
        .arg("--target-dir")
        .arg(shell::target())
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("RUSTFLAGS", "");
    cargo
}

/// Instructions of a call: what is the same in both runs falls out.
fn per_call(program: &Path, name: &str) -> Result<f64, String> {
    let [few, many] = CALLS;
    let difference = counted(program, name, many)?.checked_sub(counted(program, name, few)?);
    let difference = difference.ok_or_else(|| format!("error: {name}: fewer for more calls"))?;
    Ok(difference as f64 / (many - few) as f64)
}

fn counted(program: &Path, name: &str, calls: u64) -> Result<u64, String> {
    let mut valgrind = shell::program(VALGRIND);
    valgrind.args(OPTIONS).arg(program);
    valgrind.args([name, &calls.to_string()]);
    let output = valgrind.env(TUNABLES.0, TUNABLES.1).output();
    let output = output.map_err(|error| format!("error: cannot run {VALGRIND}: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    instructions(&said)
        .filter(|_| output.status.success())
        .ok_or_else(|| format!("error: {VALGRIND} does not count {name}:\n{said}"))
}

/// The number in valgrind's line `I refs: 1,234`.
fn instructions(said: &str) -> Option<u64> {
    let line = said.lines().find(|line| {
        let mut words = line.split_whitespace().skip(1);
        words.next() == Some("I") && words.next() == Some("refs:")
    })?;
    line.split_whitespace()
        .last()?
        .replace(',', "")
        .parse()
        .ok()
}

/// Both beside each other, and whether all are there and close to each other.
fn table(figures: &Figures, measured: &Figures) -> (String, bool) {
    let mut names: Vec<&String> = figures.keys().chain(measured.keys()).collect();
    names.sort();
    names.dedup();
    let mut held = true;
    let mut text = format!(
        "{:40} {:>9} {:>9} {:>8}\n",
        "call", "figure", "measured", "change"
    );
    for name in names {
        let number = |all: &Figures| {
            all.get(name)
                .map_or("-".to_owned(), |it| format!("{it:.0}"))
        };
        let change = figures.get(name).zip(measured.get(name));
        let change = change.map(|(figure, measured)| measured / figure - 1.0);
        // Written so that NaN fails.
        let close = change.is_some_and(|it| it.abs() <= TOLERANCE);
        held &= close;
        let change = change.map_or("-".to_owned(), |it| format!("{:+.1} %", 100.0 * it));
        let mark = if close { "" } else { "  <- out" };
        let (figure, measured) = (number(figures), number(measured));
        text += &format!("{name:40} {figure:>9} {measured:>9} {change:>8}{mark}\n");
    }
    (text, held)
}

#[cfg(test)]
mod tests {
    use super::{Figures, instructions, table};

    fn figures(pairs: &[(&str, f64)]) -> Figures {
        pairs
            .iter()
            .map(|(name, it)| ((*name).to_owned(), *it))
            .collect()
    }

    #[test]
    fn the_line_of_valgrind_is_read() {
        let said = "==1== Command: x\n==1== I   refs:      1,134,129\n==1== D refs: 5\n";
        assert_eq!(instructions(said), Some(1_134_129));
        assert_eq!(instructions("==1== I refs: 42\n"), Some(42));
        assert_eq!(instructions("==1== D refs: 42\n"), None);
    }

    #[test]
    fn two_percent_pass_and_three_do_not() {
        let old = figures(&[("a", 100.0), ("b", 200.0)]);
        assert!(table(&old, &figures(&[("a", 101.9), ("b", 196.1)])).1);
        let (text, held) = table(&old, &figures(&[("a", 103.0), ("b", 200.0)]));
        assert!(!held && text.contains("+3.0 %"), "{text}");
        assert!(!table(&old, &figures(&[("a", 100.0), ("b", 194.0)])).1);
    }

    #[test]
    fn none_may_be_missing() {
        let (old, new) = (figures(&[("a", 1.0)]), figures(&[("a", 1.0), ("b", 2.0)]));
        assert!(!table(&old, &new).1);
        assert!(!table(&new, &old).1);
    }
}
