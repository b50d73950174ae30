//! How a command fails.

use std::cell::RefCell;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use console::style;

/// Why a command failed, in words for the person at the terminal.
#[derive(Debug)]
pub enum Failure {
    /// The request cannot be carried out: bad input, a file that cannot be written. Exit code 2.
    Request(String),
    /// The computation failed: no trim, a state that is not finite. Exit code 3.
    Numeric(String),
    /// A signal ended the work; the part that was done is reported. Exit code 130 for SIGINT, 143 for SIGTERM.
    Interrupted(String),
}

impl Failure {
    /// Says on stderr what went wrong and gives the exit code, `interrupted` for work that a signal ended.
    pub(crate) fn report(&self, interrupted: u8) -> u8 {
        let (message, code) = match self {
            Self::Request(message) => (message, 2),
            Self::Numeric(message) => (message, 3),
            Self::Interrupted(message) => (message, interrupted),
        };
        say(&format!("error: {message}"));
        code
    }
}

/// What a command says: to stdout, and beside that.
#[derive(Debug, Default)]
pub(crate) struct Said {
    /// What it prints.
    pub(crate) text: String,
    /// Its notes and warnings.
    pub(crate) notes: Vec<String>,
}

thread_local! {
    /// What a command of this thread says, where a host program listens to it.
    static HEARD: RefCell<Option<Said>> = const { RefCell::new(None) };
}

/// Does `work`, and hears what it says on this thread: nothing of that goes to stdout or stderr.
pub(crate) fn heard<T>(work: impl FnOnce() -> T) -> (T, Said) {
    HEARD.set(Some(Said::default()));
    let outcome = work();
    (outcome, HEARD.take().unwrap_or_default())
}

/// Whether somebody listens, who then has heard it.
fn hear(tell: impl FnOnce(&mut Said)) -> bool {
    HEARD
        .with_borrow_mut(|said| said.as_mut().map(tell))
        .is_some()
}

/// One outcome of many, each of which was tried whatever became of the others: of failures the first is the command's, and the
/// others are said at once.
///
/// # Errors
///
/// The first of theirs.
pub fn all<const N: usize>(outcomes: [Result<(), Failure>; N]) -> Result<(), Failure> {
    let mut first = Ok(());
    for failure in outcomes.into_iter().filter_map(Result::err) {
        match (&first, &failure) {
            (Ok(()), _) => first = Err(failure),
            (_, Failure::Request(message) | Failure::Numeric(message)) => {
                say(&format!("error: {message}"));
            }
            (_, Failure::Interrupted(message)) => say(message),
        }
    }
    first
}

/// Whether notes, warnings and progress are left out.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves out notes, warnings and progress of this process from now on, or prints them again.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Whether notes, warnings and progress are left out.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Writes a note, a warning or how far work is to stderr, unless `--quiet` is given. A closed stderr is no reason to stop.
pub fn complain(message: &str) {
    if !is_quiet() {
        say(message);
    }
}

/// Writes a line to stderr, whose first word is coloured where that is asked for.
pub(crate) fn say(message: &str) {
    if hear(|said| said.notes.push(message.to_owned())) {
        return;
    }
    let line = match message.split_once(": ") {
        Some(("error", rest)) => format!("{} {rest}", style("error:").for_stderr().red().bold()),
        Some(("warning", rest)) => {
            format!("{} {rest}", style("warning:").for_stderr().yellow().bold())
        }
        Some(("note", rest)) => format!("{} {rest}", style("note:").for_stderr().cyan().bold()),
        _ => message.to_owned(),
    };
    let _ = writeln!(io::stderr(), "{line}");
}

/// Writes `text` and a line end to stdout. A reader that has gone away is no failure.
///
/// # Errors
///
/// [`Failure::Request`] if stdout cannot be written for another reason.
pub fn print(text: &str) -> Result<(), Failure> {
    if hear(|said| said.text = format!("{}{text}\n", said.text)) {
        return Ok(());
    }
    let mut stdout = io::stdout();
    written(writeln!(stdout, "{text}").and_then(|()| stdout.flush()))
}

/// What became of writing to stdout. A reader that has gone away is no failure.
///
/// # Errors
///
/// [`Failure::Request`] if stdout could not be written for another reason.
pub(crate) fn written(result: io::Result<()>) -> Result<(), Failure> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Request(format!("cannot write to stdout: {error}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Failure, all};

    #[test]
    fn the_first_failure_is_the_commands() {
        let failed = |what: &str| Err(Failure::Request(what.to_owned()));
        let outcome = all([Ok(()), failed("first"), Ok(()), failed("second")]);
        assert!(matches!(outcome, Err(Failure::Request(what)) if what == "first"));
        assert!(all([Ok(()), Ok(())]).is_ok());
    }
}
