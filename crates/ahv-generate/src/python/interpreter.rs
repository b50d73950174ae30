//! Finding a Python that is new enough.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Command;

use super::{MODULES, given_command, isolated, last_lines};
use crate::failure::Failure;
use crate::interrupt;

const OLDEST: Version = Version(3, 11);
const NAMES: [&str; 5] = [
    "python3",
    "python3.13",
    "python3.12",
    "python3.11",
    "python",
];
/// Prints the version, then those of the named modules that it does not find.
const PROBE: &str = "import os, sys, importlib.util as u
sys.path = [p for p in sys.path if p] + os.environ.get('PYTHONPATH', '').split(os.pathsep)
print(*sys.version_info[:2])
print(*[m for m in sys.argv[1:] if u.find_spec(m) is None])";

/// Major and minor version.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Version(u32, u32);

impl std::fmt::Display for Version {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}.{}", self.0, self.1)
    }
}

/// Checks the interpreter that `AHV_PYTHON` names.
pub(super) fn given(python: &OsStr) -> Result<PathBuf, Failure> {
    let named = format!("AHV_PYTHON names {:?}", python.to_string_lossy());
    let fail = |what: String| {
        Failure::new(format!("{named}, {what}")).with_help(format!(
            "name a Python {OLDEST} or newer that has {}, or unset AHV_PYTHON: ahv then makes its own",
            MODULES.join(" and ")
        ))
    };
    let (version, missing) = probe(given_command(python), &MODULES, |reason| {
        fail(format!("which cannot be run: {reason}"))
    })?;
    if version < OLDEST {
        return Err(fail(format!(
            "which is Python {version}; generation needs {OLDEST}"
        )));
    }
    if !missing.is_empty() {
        return Err(fail(format!("which has no {}", missing.join(" and no "))));
    }
    Ok(python.into())
}

/// The first Python on the search path that is new enough.
pub(super) fn find() -> Result<(&'static str, Version), Failure> {
    let mut too_old = Vec::new();
    for name in NAMES {
        match probe(isolated(name), &[], Failure::new) {
            Ok((version, _)) if version >= OLDEST => return Ok((name, version)),
            Ok((version, _)) => too_old.push(format!("{name} is {version}")),
            Err(interrupted @ Failure::Interrupted { .. }) => return Err(interrupted),
            // Not there, or a version manager's stand-in for one that is not there.
            Err(_) => {}
        }
    }
    let found = if too_old.is_empty() {
        String::new()
    } else {
        format!(" ({})", too_old.join(", "))
    };
    Err(Failure::new(format!(
        "found no Python {OLDEST} or newer, which deriving needs{found}"
    ))
    .with_help("install one, or set AHV_PYTHON to its path; `--check --from-ir` needs none"))
}

fn probe(
    mut python: Command,
    modules: &[&str],
    failed: impl Fn(String) -> Failure,
) -> Result<(Version, Vec<String>), Failure> {
    python.args(["-c", PROBE]).args(modules);
    let output = interrupt::output(&mut python, |error| failed(error.to_string()))?;
    if !output.status.success() {
        let said = last_lines(&output.stderr);
        return Err(failed(format!("{}{said}", output.status)));
    }
    answer(&String::from_utf8_lossy(&output.stdout))
        .ok_or_else(|| failed("it is no Python".to_owned()))
}

fn answer(text: &str) -> Option<(Version, Vec<String>)> {
    let mut lines = text.lines();
    let (major, minor) = lines.next()?.split_once(' ')?;
    let version = Version(major.parse().ok()?, minor.trim().parse().ok()?);
    let missing = lines
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    Some((version, missing))
}

#[cfg(test)]
mod tests {
    use super::{Version, answer};

    #[test]
    fn reads_what_the_probe_prints() {
        assert_eq!(answer("3 11\n\n"), Some((Version(3, 11), vec![])));
        let missing = vec!["casadi".to_owned(), "pint".to_owned()];
        assert_eq!(
            answer("3 9\r\ncasadi pint\r\n"),
            Some((Version(3, 9), missing))
        );
        assert_eq!(answer("hello\n"), None);
        assert!(Version(3, 9) < Version(3, 11));
    }
}
