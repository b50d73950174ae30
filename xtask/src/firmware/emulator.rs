//! Running a firmware program under QEMU.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::shell;

const QEMU: &str = "qemu-system-arm";
/// The board, and what the program's counter of instructions counts on: 2⁸ ns of virtual time for each. No window, no
/// consoles; semihosting alone.
const OPTIONS: [&str; 12] = [
    "-machine",
    "mps2-an500",
    "-icount",
    "shift=8",
    "-display",
    "none",
    "-monitor",
    "none",
    "-serial",
    "none",
    "-semihosting-config",
    "enable=on,target=native",
];
/// Many times what a flight takes.
pub(super) const LIMIT: Duration = Duration::from_secs(60);

/// Whether there is a QEMU; if not, what to do.
pub(crate) fn found() -> Result<(), String> {
    match Command::new(QEMU).arg("--version").output() {
        Ok(output) if output.status.success() => Ok(()),
        _ => Err(format!(
            "no {QEMU} to run; Debian has it in the package of that name"
        )),
    }
}

/// What the program prints until it ends by itself with status 0.
pub(super) fn run(program: &Path, limit: Duration) -> Result<String, String> {
    let mut qemu = shell::program(QEMU);
    qemu.args(OPTIONS).arg("-kernel").arg(program);
    printed_within(&mut qemu, &program.with_extension("txt"), limit)
}

/// What a command writes to `out`, its standard output; killed if it has not ended after `limit`.
fn printed_within(command: &mut Command, out: &Path, limit: Duration) -> Result<String, String> {
    let problem = |error| format!("{}: {error}", out.display());
    let file = File::create(out).map_err(problem)?;
    let mut child = command
        .stdin(Stdio::null())
        .stdout(file)
        .spawn()
        .map_err(|error| format!("cannot run {command:?}: {error}"))?;
    let start = Instant::now();
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if start.elapsed() < limit => thread::sleep(Duration::from_millis(10)),
            ended => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(match ended {
                    Err(error) => format!("cannot wait for {command:?}: {error}"),
                    _ => format!("did not end within {} s", limit.as_secs()),
                });
            }
        }
    };
    if !status.success() {
        return Err(format!("ended with {status}"));
    }
    fs::read_to_string(out).map_err(problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Result<String, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let mut command = Command::new("sh");
        printed_within(
            command.args(["-c", script]),
            &folder.path().join("out"),
            limit,
        )
    }

    #[test]
    fn output_comes_back() {
        assert_eq!(shell("echo flown", LIMIT), Ok("flown\n".into()));
    }

    #[test]
    fn a_status_is_an_error() {
        let problem = shell("echo flown; exit 1", LIMIT).expect_err("a failure");
        assert!(problem.contains("exit status: 1"), "{problem}");
    }

    #[test]
    fn what_hangs_is_killed() {
        let start = Instant::now();
        let problem = shell("exec sleep 60", Duration::from_millis(50)).expect_err("a failure");
        assert!(problem.contains("did not end"), "{problem}");
        assert!(start.elapsed() < Duration::from_secs(30));
    }
}
