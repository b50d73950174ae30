//! The commands, by the words of their lines.

use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use ahv_cli::embedded::{self, Told};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::built;
use crate::failure::raised;

/// The right to lead the campaign of a folder, until it is released.
#[pyclass]
pub(crate) struct CampaignLock(Option<embedded::CampaignLock>);

#[pymethods]
impl CampaignLock {
    /// Takes it; refused while another campaign is at work there.
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let lock = embedded::CampaignLock::take(&folder);
        lock.map(|it| Self(Some(it)))
            .map_err(|failure| raised(py, &failure))
    }

    /// Gives it back.
    fn release(&mut self) {
        self.0 = None;
    }
}

/// Time between two looks for Ctrl-C.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Runs a command, and gives what it prints with its notes and warnings.
///
/// The command has a thread of its own, and Python goes on meanwhile. Ctrl-C stops members that fly; other work is left alone.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<String>) -> PyResult<(String, Vec<String>)> {
    let (told, ended) = channel::<Told>();
    thread::spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = told.send(embedded::tell(words, &(built().extra)()));
    });
    // A receiver is for one thread alone; the lock lets it be looked at without the interpreter.
    let ended = std::sync::Mutex::new(ended);
    loop {
        let wait = || match ended.lock() {
            Ok(ended) => ended.recv_timeout(POLL_INTERVAL),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        match py.detach(wait) {
            Ok(Told { text, notes, end }) => {
                return match end {
                    Ok(()) => Ok((text, notes)),
                    Err(failure) => Err(raised(py, &failure)),
                };
            }
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| {
                embedded::stop();
            })?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the command ended without a word"));
            }
        }
    }
}

/// The program `ahv` by its command line, the first word being its name: prints, and gives the exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, line: Vec<String>) -> u8 {
    py.detach(|| (built().program)(line))
}
