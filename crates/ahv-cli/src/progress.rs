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
    /// `None` if nobody knows how much there is to do.
    total: Option<u64>,
    enabled: bool,
    /// Steps at which the clock is looked at next.
    next: u64,
    template: &'static str,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(total: u64) -> Self {
        Self::with_template(Some(total), "{bar:40} {percent:>3} % {eta} left")
    }

    /// With the rate at which member-steps are done.
    pub(crate) fn of_member_steps(total: u64) -> Self {
        Self::with_template(
            Some(total),
            "{bar:40} {percent:>3} % {per_sec} member-steps, {eta} left",
        )
    }

    /// With the member-steps that are done and their rate.
    pub(crate) fn of_unknown() -> Self {
        Self::with_template(None, "{spinner} {human_pos} member-steps, {per_sec}")
    }

    fn with_template(total: Option<u64>, template: &'static str) -> Self {
        Self {
            started: Instant::now(),
            total,
            enabled: io::stderr().is_terminal(),
            next: STRIDE,
            template,
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
            self.bar = Some(bar(self.total, self.template));
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

fn bar(total: Option<u64>, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    let bar = total.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
