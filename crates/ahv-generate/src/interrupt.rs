//! SIGINT, SIGTERM, and SIGHUP of a terminal that is closed: the work ends before its next step, and takes its temporary files with it.

use std::fs::File;
use std::io::{self, Read as _, Seek as _};
use std::process::{Child, Command, ExitStatus, Output};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::failure::Failure;

/// Signals that end the work in order.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// How often a waiting process looks for a signal and for the end of its child.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// How long a child may take to end by itself: Ctrl-C of a terminal reaches it, too.
const GRACE: Duration = Duration::from_millis(200);

/// The number of the signal that arrived; 0 before. None where no process asked for it.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// From now on these signals end the work in order, and a second one ends it at once.
pub(crate) fn listen() -> io::Result<()> {
    if SIGNAL.get().is_some() {
        return Ok(());
    }
    let (signal, again) = (
        Arc::new(AtomicUsize::new(0)),
        Arc::new(AtomicBool::new(false)),
    );
    for number in SIGNALS {
        // In this order: the first signal must not find the flag that it sets.
        flag::register_conditional_default(number, Arc::clone(&again))?;
        flag::register(number, Arc::clone(&again))?;
        flag::register_usize(number, Arc::clone(&signal), number.unsigned_abs() as usize)?;
    }
    let _ = SIGNAL.set(signal);
    Ok(())
}

/// Whether the work may go on.
///
/// # Errors
/// [`Failure::Interrupted`] after a signal.
pub(crate) fn check() -> Result<(), Failure> {
    match SIGNAL
        .get()
        .map_or(0, |signal| signal.load(Ordering::Relaxed))
    {
        0 => Ok(()),
        signal => Err(Failure::Interrupted { signal }),
    }
}

/// Runs a program to its end, and returns what it printed; a signal ends it.
///
/// # Errors
/// [`Failure::Interrupted`] after a signal; `failed` of what else went wrong.
pub(crate) fn output(
    command: &mut Command,
    failed: impl Fn(io::Error) -> Failure,
) -> Result<Output, Failure> {
    check()?;
    // Files, not pipes: nobody has to read them while the program runs.
    let mut start = || {
        let (out, err) = (tempfile::tempfile()?, tempfile::tempfile()?);
        command.stdout(out.try_clone()?).stderr(err.try_clone()?);
        Ok((command.spawn()?, out, err))
    };
    let (mut child, out, err) = start().map_err(&failed)?;
    let status = wait(&mut child, &failed)?;
    let (stdout, stderr) = (text(out).map_err(&failed)?, text(err).map_err(&failed)?);
    Ok(Output {
        status,
        stdout,
        stderr,
    })
}

fn wait(child: &mut Child, failed: impl Fn(io::Error) -> Failure) -> Result<ExitStatus, Failure> {
    loop {
        if let Some(status) = child.try_wait().map_err(&failed)? {
            // A program that the same signal ended has not failed.
            check()?;
            return Ok(status);
        }
        if let Err(interrupted) = check() {
            let start = Instant::now();
            while start.elapsed() < GRACE && matches!(child.try_wait(), Ok(None)) {
                thread::sleep(POLL_INTERVAL);
            }
            let _ = child.kill();
            let _ = child.wait();
            return Err(interrupted);
        }
        thread::sleep(POLL_INTERVAL);
    }
}

fn text(mut file: File) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}
