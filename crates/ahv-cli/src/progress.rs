//! How far long work is: a bar on a terminal, a line every ten seconds in a pipe.

use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use ahv_analysis::ordered::Control;
use indicatif::{ProgressBar, ProgressStyle};

use crate::failure::{complain, is_quiet};

/// Work shorter than this shows no bar.
const BAR_AFTER: Duration = Duration::from_secs(1);
/// Time between two looks at how far the work is, with a bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Time between two lines, without a terminal; shorter work prints none.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// What is counted.
#[derive(Clone, Copy)]
pub struct Work {
    /// Name of the command.
    pub command: &'static str,
    /// What is counted, in the plural; empty if nothing is.
    pub unit: &'static str,
    /// How much there is to do, if that is known.
    pub total: Option<u64>,
}

/// Shows on stderr how far work is, as long as it lives.
pub struct Progress {
    control: Arc<Control>,
    /// Dropped, it ends the thread.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Progress {
    /// Starts to watch work.
    pub fn start(work: Work) -> Self {
        let control = Arc::new(Control::default());
        let watched = Arc::clone(&control);
        let (end, ended) = channel();
        let thread = thread::spawn(move || {
            let started = Instant::now();
            let wait = |time| ended.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
            let done = || watched.done.load(Ordering::Relaxed);
            if is_quiet() {
                // The thread ends at once.
            } else if io::stderr().is_terminal() {
                show_bar(work, wait, || work.line(done(), started.elapsed()), done);
            } else {
                say_lines(wait, || complain(&work.line(done(), started.elapsed())));
            }
        });
        Self {
            control,
            end: Some(end),
            thread: Some(thread),
        }
    }

    /// Counts what is done, and stops the work if a signal asks for it.
    pub fn control(&self) -> &Arc<Control> {
        &self.control
    }

    /// So much is done.
    pub fn reach(&self, done: u64) {
        self.control.done.store(done, Ordering::Relaxed);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            // A bar that failed is no failure of the work.
            let _ = thread.join();
        }
    }
}

/// A line each time that the work is still going on.
fn say_lines(mut wait: impl FnMut(Duration) -> bool, mut say: impl FnMut()) {
    while wait(LINE_INTERVAL) {
        say();
    }
}

fn show_bar(
    work: Work,
    wait: impl Fn(Duration) -> bool,
    line: impl Fn() -> String,
    done: impl Fn() -> u64,
) {
    if !wait(BAR_AFTER) {
        return;
    }
    let (bar, template) = match work.total {
        Some(total) => (ProgressBar::new(total), "{bar:30} {msg}"),
        None => (ProgressBar::new_spinner(), "{spinner} {msg}"),
    };
    let style = ProgressStyle::with_template(template);
    let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    while wait(BAR_INTERVAL) {
        bar.set_position(done());
        bar.set_message(line());
        bar.tick();
    }
    bar.finish_and_clear();
}

impl Work {
    /// How far the work is, in words.
    fn line(self, done: u64, elapsed: Duration) -> String {
        let Self {
            command,
            unit,
            total,
        } = self;
        let seconds = elapsed.as_secs_f64();
        let rate = done as f64 / seconds;
        match total {
            _ if unit.is_empty() || done == 0 => format!("{command}: at work for {seconds:.0} s"),
            Some(total) => format!(
                "{command}: {:.0} % of {} {unit} in {seconds:.0} s, {} per second, {:.0} s left",
                100.0 * done as f64 / total.max(1) as f64,
                count(total as f64),
                count(rate),
                total.saturating_sub(done) as f64 / rate,
            ),
            None => format!(
                "{command}: {} {unit} in {seconds:.0} s, {} per second",
                count(done as f64),
                count(rate)
            ),
        }
    }
}

/// A count in few digits.
fn count(value: f64) -> String {
    if value >= 1e6 {
        format!("{value:.2e}")
    } else if value >= 100.0 {
        format!("{value:.0}")
    } else {
        format!("{value:.1}")
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Work, say_lines};

    #[test]
    fn there_is_a_line_every_ten_seconds_and_none_of_short_work() {
        for lines in [0, 3] {
            let (mut waited, mut said) = (Duration::ZERO, 0);
            let wait = |time| {
                waited += time;
                waited <= Duration::from_secs(10 * lines)
            };
            say_lines(wait, || said += 1);
            assert_eq!(said, lines);
        }
    }

    #[test]
    fn a_line_says_what_how_far_how_fast_and_how_long() {
        let work = |unit, total| Work {
            command: "montecarlo",
            unit,
            total,
        };
        let line = |work: Work, done| work.line(done, Duration::from_secs(20));
        assert_eq!(
            line(work("member-steps", Some(8_000_000)), 2_000_000),
            "montecarlo: 25 % of 8.00e6 member-steps in 20 s, 100000 per second, 60 s left"
        );
        assert_eq!(
            line(work("flights", None), 30),
            "montecarlo: 30.0 flights in 20 s, 1.5 per second"
        );
        assert_eq!(
            line(work("flights", Some(3)), 0),
            "montecarlo: at work for 20 s"
        );
        assert_eq!(line(work("", None), 0), "montecarlo: at work for 20 s");
    }
}
