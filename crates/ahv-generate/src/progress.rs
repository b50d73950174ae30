//! Tells a person who waits what goes on.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Whether only errors, differences and JSON are printed.
static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on prints only errors, the differences that `--check` finds, and JSON: no progress, and nothing of what was done.
/// `false` takes that back.
pub fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Whether only errors, differences and JSON are printed.
#[must_use]
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// A spinner on a terminal with the time since its start, gone when dropped.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// For work of a second or so: nothing in a pipe.
    pub(crate) fn quiet(message: impl Into<String>) -> Self {
        if is_quiet() {
            return Self(ProgressBar::hidden());
        }
        let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
        let bar = ProgressBar::new_spinner().with_message(message.into());
        let bar = bar.with_style(style);
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(bar)
    }

    /// For work of many seconds: a log gets the message as a line.
    pub(crate) fn announced(message: impl Into<String>) -> Self {
        let message = message.into();
        if !is_quiet() && !io::stderr().is_terminal() {
            let _ = writeln!(io::stderr(), "{message}...");
        }
        Self::quiet(message)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
