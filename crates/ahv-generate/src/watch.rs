//! Generation on save: the tables are read a few times a second, and a change that has settled is generated.

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use crate::args::Args;
use crate::failure::Failure;
use crate::project::Project;
use crate::surroundings::Surroundings;
use crate::{complain, files, generate, interrupt, is_quiet, report, tables};

const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// How long the tables must be as they are before they are read: an editor may write a file in parts.
const SETTLE: Duration = Duration::from_millis(100);
/// The same where a table has gone: an editor may put it back.
const SETTLE_WITHOUT: Duration = Duration::from_secs(1);

/// The files of the tables, and of their families and parts beside them, with their bytes; none of a file that cannot be read.
type Seen = Vec<(PathBuf, Option<Vec<u8>>)>;

/// Generates now and after each change of a table, until a signal.
///
/// # Errors
/// [`Failure::Interrupted`]; standard output that cannot be written. Every other failure is shown, and watching goes on.
pub(crate) fn watch(args: &Args, surroundings: &Surroundings) -> Result<u8, Failure> {
    let project = Project::locate(args, surroundings)?;
    loop {
        // Before the generation: what is saved during it is a change.
        let seen = look(&project);
        match generate(args, surroundings) {
            Ok(generated) => report(&generated.text())?,
            Err(interrupted @ Failure::Interrupted { .. }) => return Err(interrupted),
            Err(failure) => complain(&failure.render()),
        }
        let folder = project.shown(&project.tables);
        announce(&format!("watching {folder}; Ctrl-C ends"));
        wait_for_change(&project, seen)?;
        announce("saved: generating ...");
    }
}

/// Writes a line to stderr, unless that is to be quiet.
fn announce(line: &str) {
    if !is_quiet() {
        let _ = writeln!(io::stderr(), "{line}");
    }
}

fn wait_for_change(project: &Project, before: Seen) -> Result<(), Failure> {
    let (mut last, mut since) = (before.clone(), Instant::now());
    loop {
        interrupt::check()?;
        thread::sleep(POLL_INTERVAL);
        let now = look(project);
        if now != last {
            (last, since) = (now, Instant::now());
        }
        let there = |path: &PathBuf| {
            last.iter()
                .any(|(known, text)| known == path && text.is_some())
        };
        let settle = if before.iter().all(|(path, _)| there(path)) {
            SETTLE
        } else {
            SETTLE_WITHOUT
        };
        if last != before && since.elapsed() >= settle {
            return Ok(());
        }
    }
}

fn look(project: &Project) -> Seen {
    let mut seen = Seen::new();
    for path in tables::table_files(project).unwrap_or_default() {
        let bytes = files::read(&path).ok();
        let scripts = bytes
            .as_ref()
            .map_or_else(Vec::new, |it| tables::scripts_of(&path, it));
        seen.push((path, bytes));
        seen.extend(scripts.into_iter().map(|path| {
            let bytes = files::read(&path).ok();
            (path, bytes)
        }));
    }
    seen
}
