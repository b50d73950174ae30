//! A progress bar for long work.

use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Steps between two looks at the clock.
const STRIDE: u64 = 4096;

/// A bar on stderr, if that is a terminal and the work is long.
pub(crate) struct Progress {
    started: Instant,
    total: u64,
    enabled: bool,
    /// Steps at which the clock is looked at next.
    next: u64,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(total: u64) -> Self {
        Self {
            started: Instant::now(),
            total,
            enabled: io::stderr().is_terminal(),
            next: STRIDE,
            bar: None,
        }
    }

    /// Tells of `done` steps.
    pub(crate) fn tell(&mut self, done: u64) {
        if !self.enabled || done < self.next {
            return;
        }
        self.next = done + STRIDE;
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            self.bar = Some(bar(self.total));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {eta} left");
    ProgressBar::new(total).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
