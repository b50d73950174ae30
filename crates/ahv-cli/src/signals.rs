//! SIGINT (Ctrl-C), SIGTERM, and SIGHUP of a terminal that is closed.
//!
//! Work that can report a part of its outcome is stopped by the first signal; all else ends at once, and everything ends at
//! once by the second. Either way no temporary file is left, and the exit code is 128 and the number of the signal.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use ahv_analysis::ordered::Control;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::failure::{Failure, say};
use crate::output;

/// Signals that end the work in order.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Time between two looks for a signal.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// Exit code of a process that signal number 0 would end, as shells have it.
const EXIT_BASE: u8 = 128;

/// Number of the signal that stopped the work; 0 for none.
static STOPPED_BY: AtomicUsize = AtomicUsize::new(0);
/// Work that the next signal stops, in the place of the process.
static STOPPABLE: Mutex<Option<Arc<Control>>> = Mutex::new(None);

/// Listens to the signals from now on.
///
/// # Errors
///
/// [`Failure::Request`] if the system does not allow it.
pub(crate) fn listen() -> Result<(), Failure> {
    let pending = Arc::new(AtomicUsize::new(0));
    for signal in SIGNALS {
        flag::register_usize(signal, Arc::clone(&pending), signal as usize)
            .map_err(|error| Failure::Request(format!("cannot listen to signals: {error}")))?;
    }
    thread::spawn(move || {
        loop {
            thread::sleep(POLL_INTERVAL);
            match pending.swap(0, Ordering::Relaxed) {
                0 => {}
                signal => obey(signal),
            }
        }
    });
    Ok(())
}

fn obey(signal: usize) {
    STOPPED_BY.store(signal, Ordering::Relaxed);
    if !stop() {
        say("interrupted");
        output::exit_without_temporaries(exit_code());
    }
}

/// Stops the work that can be stopped in order, and says whether there is any.
pub fn stop() -> bool {
    let mut stoppable = STOPPABLE.lock().unwrap_or_else(PoisonError::into_inner);
    match stoppable.take() {
        Some(control) => {
            control.stop.store(true, Ordering::Relaxed);
            true
        }
        None => false,
    }
}

/// Exit code of work that a signal ended.
pub(crate) fn exit_code() -> u8 {
    match STOPPED_BY.load(Ordering::Relaxed) {
        0 => EXIT_BASE + SIGINT as u8,
        signal => EXIT_BASE + signal as u8,
    }
}

/// The mark of an outcome that a signal cut short, as "interrupted: 3 of 8 members"; empty if it is complete.
pub fn interrupted(done: u64, asked: u64, unit: &str) -> String {
    if done == asked {
        String::new()
    } else {
        format!("interrupted: {done} of {asked} {unit}")
    }
}

/// While it lives, the first signal stops the work of a control and leaves the process alone.
pub struct Stoppable;

impl Stoppable {
    /// Stops the work of `control` by a signal from now on.
    pub fn new(control: &Arc<Control>) -> Self {
        set(Some(Arc::clone(control)));
        Self
    }
}

impl Drop for Stoppable {
    fn drop(&mut self) {
        set(None);
    }
}

fn set(control: Option<Arc<Control>>) {
    *STOPPABLE.lock().unwrap_or_else(PoisonError::into_inner) = control;
}
