//! The promise of the same bits: whatever the compiler makes of it, every stepper gives the same states.

use std::thread;

use crate::shell;

/// How the program that prints the digests is built.
struct Build {
    name: &'static str,
    /// Folder of what is built; none for that of the main workspace.
    target: Option<&'static str>,
    profile: &'static str,
    /// Which packages' features count.
    packages: &'static [&'static str],
    /// Variables for cargo.
    variables: &'static [(&'static str, &'static str)],
}

const ALONE: &[&str] = &["--package", "ahv-steppers"];

const BUILDS: [Build; 4] = [
    Build {
        name: "opt-level 0",
        target: Some("target/determinism/0"),
        profile: "dev",
        packages: ALONE,
        variables: &[
            ("CARGO_PROFILE_DEV_OPT_LEVEL", "0"),
            ("CARGO_PROFILE_DEV_DEBUG", "0"),
            ("CARGO_INCREMENTAL", "0"),
        ],
    },
    // As `cargo test` has built it.
    Build {
        name: "opt-level 1 with the features of the workspace",
        target: None,
        profile: "dev",
        packages: &shell::STEPPERS,
        variables: &[],
    },
    Build {
        name: "opt-level 3",
        target: Some("target/determinism/3"),
        profile: "release",
        packages: ALONE,
        variables: &[],
    },
    Build {
        name: "opt-level 3 for this very processor",
        target: Some("target/determinism/native"),
        profile: "release",
        packages: ALONE,
        variables: &[("RUSTFLAGS", "-C target-cpu=native")],
    },
];

/// Compares the digests of all builds line by line.
pub(crate) fn run() -> Result<(), String> {
    let outcomes = thread::scope(|scope| {
        let running = BUILDS.map(|build| scope.spawn(move || digests(&build)));
        running.map(|build| build.join())
    });
    let mut found = Vec::new();
    for outcome in outcomes {
        found.push(outcome.map_err(|_| "error: a build has panicked".to_owned())??);
    }
    let report = compare(&BUILDS.map(|build| build.name), &found)?;
    println!("{report}");
    Ok(())
}

/// A line a stepper: its digest and its name.
fn digests(build: &Build) -> Result<String, String> {
    let target = build
        .target
        .map_or_else(shell::target, |folder| shell::root().join(folder));
    let mut cargo = shell::cargo();
    cargo.args(["build", "--quiet", "--locked", "--example", "digest"]);
    cargo.args(["--profile", build.profile]);
    cargo.arg("--target-dir").arg(&target).args(build.packages);
    shell::output(cargo.envs(build.variables.iter().copied()))?;
    let folder = if build.profile == "dev" {
        "debug"
    } else {
        build.profile
    };
    let program = target.join(folder).join("examples/digest");
    shell::output(&mut shell::program(program))
}

fn compare(names: &[&str], found: &[String]) -> Result<String, String> {
    let first = found.first().map_or("", String::as_str);
    for (name, other) in names.iter().zip(found).skip(1) {
        let differing = first
            .lines()
            .zip(other.lines())
            .find(|(one, other)| one != other);
        if let Some((one, other)) = differing {
            return Err(format!(
                "error: other bits with {name} than with {}:\n  {one}\n  {other}",
                names[0]
            ));
        }
        if first.lines().count() != other.lines().count() {
            return Err(format!("error: with {name} there are other steppers"));
        }
    }
    let count = first.lines().count();
    if count == 0 {
        return Err("error: no stepper was digested".to_owned());
    }
    Ok(format!(
        "{count} pairs of a model and a stepper, the same bits with: {}",
        names.join("; ")
    ))
}

#[cfg(test)]
mod tests {
    use super::compare;

    fn compared(texts: [&str; 2]) -> Result<String, String> {
        compare(&["slow", "fast"], &texts.map(str::to_owned))
    }

    #[test]
    fn one_other_digest_is_found_and_named() {
        assert!(compared(["1 Rk4\n2 Heun", "1 Rk4\n2 Heun"]).is_ok());
        let problem = compared(["1 Rk4\n2 Heun", "1 Rk4\n3 Heun"]).expect_err("another number");
        assert!(problem.contains("fast than with slow") && problem.contains("3 Heun"));
    }

    #[test]
    fn a_missing_line_is_found() {
        assert!(compared(["1 Rk4\n2 Heun", "1 Rk4"]).is_err());
        assert!(compared(["", ""]).is_err());
    }
}
