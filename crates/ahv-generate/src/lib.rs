//! The act of generating: tables of coefficients in, a tree of models in Rust or C written or checked.
//!
//! `ahv generate` and `cargo xtask generate` are both [`run`]. This crate never depends on the
//! generated package, so that it also mends a tree that does not compile.
//!
//! ```no_run
//! use clap::Parser;
//!
//! #[derive(Parser)]
//! struct Line {
//!     #[command(flatten)]
//!     generate: ahv_generate::Args,
//! }
//!
//! // Whether the tree on disk is what the tables give: 0 if so, 1 if not.
//! let line = Line::parse_from(["generate", "--check"]);
//! std::process::exit(ahv_generate::run(&line.generate).into());
//! ```
#![forbid(unsafe_code)]

mod args;
mod audit;
mod code;
mod compare;
mod derive;
mod describe;
mod excerpt;
mod failure;
mod files;
mod interrupt;
mod manifest;
mod progress;
mod project;
mod python;
mod report;
mod rules;
mod settings;
mod structure;
mod surroundings;
mod tables;
mod transaction;
mod trust;
mod watch;
mod write;

use std::collections::BTreeMap;
use std::io::{self, Write as _};
use std::time::Instant;

use ahv_codegen::{Options, Passes, Tree};

pub use args::{Args, Language};
pub use audit::{Evaluate, Values};
pub use code::{ChangedFile, changed_code};
pub use compare::{Difference, Kept, Status};
pub use describe::{Described, FamilyFault, describe};
pub use failure::{Failure, TableFault};
pub use progress::{is_quiet, set_quiet};
pub use project::Project;
pub use python::environment;
pub use report::{Checked, Generated};
pub use surroundings::Surroundings;

use report::{Owners, Seconds};
use tables::Tables;
use trust::Trusted;

/// Exit code: done, or tree and tables agree.
pub const AGREES: u8 = 0;
/// Exit code: tree and tables differ, of `--check`; or an error is over the bar, of `--audit`.
pub const DIFFERS: u8 = 1;
/// Exit code: bad input, or generation could not do its work. Every file is as it was, or named in the message.
pub const FAILED: u8 = 2;

/// Does what the command line asks for, prints the result, and returns the exit code. After SIGINT or SIGTERM
/// that is 130 or 143, and temporary files are removed.
#[must_use]
pub fn run(args: &Args) -> u8 {
    run_with(args, &|_, _| None)
}

/// As [`run`], in a program into which models are compiled: an audit runs them by `evaluate`.
#[must_use]
pub fn run_with(args: &Args, evaluate: Evaluate<'_>) -> u8 {
    match answer(args, evaluate) {
        Ok(code) => code,
        Err(failure) => {
            complain(&failure.render());
            failure.exit_code()
        }
    }
}

/// From now on a first SIGINT, SIGTERM or SIGHUP ends a generation in order: it fails, and temporary files are removed.
///
/// # Errors
/// The platform refuses.
pub fn listen() -> Result<(), Failure> {
    interrupt::listen().map_err(|error| Failure::new(format!("cannot listen to signals: {error}")))
}

fn answer(args: &Args, evaluate: Evaluate<'_>) -> Result<u8, Failure> {
    listen()?;
    let surroundings = Surroundings::of_process()?;
    if args.watch {
        watch::watch(args, &surroundings)
    } else if args.check {
        let checked = check(args, &surroundings)?;
        if args.json {
            print(&checked.json())?;
        } else if checked.agrees() {
            report(&checked.text())?;
        } else {
            complain(&checked.text());
        }
        let code = if checked.agrees() { AGREES } else { DIFFERS };
        Ok(code.max(audited(args, &surroundings, evaluate)?))
    } else {
        let generated = generate(args, &surroundings)?;
        if args.json {
            print(&generated.json())?;
        } else {
            report(&generated.text())?;
        }
        audited(args, &surroundings, evaluate)
    }
}

/// The audit, if it is asked for.
fn audited(
    args: &Args,
    surroundings: &Surroundings,
    evaluate: Evaluate<'_>,
) -> Result<u8, Failure> {
    let Some(points) = args.audit else {
        return Ok(AGREES);
    };
    let project = located(args, surroundings)?;
    let audited = audit::audit(points, surroundings, &project, evaluate)?;
    print(audited.text())?;
    Ok(if audited.is_within { AGREES } else { DIFFERS })
}

/// Writes to standard error; where that cannot be written, the exit code must do.
fn complain(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Writes what was done to standard output, unless that is to be quiet.
fn report(text: &str) -> Result<(), Failure> {
    if is_quiet() { Ok(()) } else { print(text) }
}

/// Writes to standard output; a reader that has gone away (`| head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::new(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Derives and emits what has changed, and brings the tree on disk up to date.
///
/// # Errors
/// Flags or a folder of another language, bad tables, no usable Python, a signal, or a tree that cannot be written; the tree is then as it was, or the
/// message names the files that are new.
pub fn generate(args: &Args, surroundings: &Surroundings) -> Result<Generated, Failure> {
    let project = located(args, surroundings)?;
    let tables = Tables::load(&project)?;
    let trusted = if args.derive {
        Trusted::default()
    } else {
        Trusted::of(&project.out, &tables)
    };
    let made = derive_and_emit(args, surroundings, &project, &tables, trusted)?;
    let differences = compare::differences(&project.out, &made.tree)?;
    write::apply(&project, &differences)?;
    Ok(Generated::new(
        &project,
        differences,
        made.derived,
        made.seconds,
    ))
}

/// Compares the tree on disk with what the tables give, and writes nothing.
///
/// # Errors
/// Flags or a folder of another language, bad tables, no usable Python, an IR of an unknown schema version, or an unreadable tree.
pub fn check(args: &Args, surroundings: &Surroundings) -> Result<Checked, Failure> {
    let project = located(args, surroundings)?;
    let tables = Tables::load(&project)?;
    let start = Instant::now();
    let (differences, owners, seconds, command) = if args.from_ir {
        let (differences, owners) = check_from_ir(args, &project, &tables)?;
        let seconds = Seconds {
            derive: 0.0,
            emit: start.elapsed().as_secs_f64(),
        };
        (
            differences,
            owners,
            seconds,
            args.mending_command(project.usual_command()),
        )
    } else {
        let made = derive_and_emit(args, surroundings, &project, &tables, Trusted::default())?;
        let differences = compare::differences(&project.out, &made.tree)?;
        let mut command = args.mending_command(project.usual_command());
        if !differences.is_empty() && !is_made_by_generate(args, &project, &tables, &made) {
            command.push_str(" --derive");
        }
        let owners = Owners::new(&tables, &made.irs);
        (differences, owners, made.seconds, command)
    };
    // A command that would refuse is no advice.
    let mending = write::check(&project, &differences).map(|()| command);
    Ok(Checked::new(
        &project,
        differences,
        &owners,
        mending,
        seconds,
    ))
}

/// What one run derived and emitted.
struct Made {
    irs: BTreeMap<String, String>,
    tree: Tree,
    /// The tables that were derived.
    derived: Vec<String>,
    seconds: Seconds,
}

/// The project, where its folder may hold what is asked for.
fn located(args: &Args, surroundings: &Surroundings) -> Result<Project, Failure> {
    args.check()?;
    let project = Project::locate(args, surroundings)?;
    manifest::refuse_other_language(args, &project)?;
    Ok(project)
}

fn derive_and_emit(
    args: &Args,
    surroundings: &Surroundings,
    project: &Project,
    tables: &Tables,
    mut trusted: Trusted,
) -> Result<Made, Failure> {
    let start = Instant::now();
    let known = std::mem::take(&mut trusted.irs);
    let derived = tables.parsed.iter().map(|table| table.name.clone());
    let derived = derived.filter(|name| !known.contains_key(name)).collect();
    let irs = if trusted.is_whole {
        rules::check(tables, &known)?;
        known
    } else {
        let python = python::for_generation(surroundings)?;
        let irs = derive::derive(&python, tables, &known)?;
        tables.hold_still(project)?;
        irs
    };
    let after = Instant::now();
    let tree = emit(args, project, tables, &irs, trusted)?;
    let seconds = Seconds {
        derive: (after - start).as_secs_f64(),
        emit: after.elapsed().as_secs_f64(),
    };
    Ok(Made {
        irs,
        tree,
        derived,
        seconds,
    })
}

/// Whether `generate` makes the same of the tree on disk as a derivation from nothing does. It does not where IR or files
/// were edited together with their hashes, or another interpreter or build wrote them.
fn is_made_by_generate(args: &Args, project: &Project, tables: &Tables, whole: &Made) -> bool {
    let mut trusted = Trusted::of(&project.out, tables);
    let mut irs = whole.irs.clone();
    irs.extend(std::mem::take(&mut trusted.irs));
    emit(args, project, tables, &irs, trusted).is_ok_and(|tree| tree == whole.tree)
}

fn emit(
    args: &Args,
    project: &Project,
    tables: &Tables,
    irs: &BTreeMap<String, String>,
    trusted: Trusted,
) -> Result<Tree, Failure> {
    let options = Options {
        package: project.package.clone(),
        core: project.core.clone(),
        units: args.units,
        passes: Passes::without(&args.without_pass),
        target: args.target(),
    };
    ahv_codegen::emit_again(&tables.parsed, irs, &options, &trusted.known(tables))
        .map_err(|error| Failure::new(error.to_string()))
}

/// The check without Python: the checked-in IR stands in for the derivation, and the manifest
/// says whether it was derived from the tables as they are now.
fn check_from_ir(
    args: &Args,
    project: &Project,
    tables: &Tables,
) -> Result<(Vec<Difference>, Owners), Failure> {
    let (irs, missing) = compare::checked_in_irs(&project.out, &tables.parsed)?;
    let owners = Owners::new(tables, &irs);
    if !missing.is_empty() {
        return Ok((missing, owners));
    }
    let manifest = manifest::whole(&project.out);
    let stale = compare::stale_irs(manifest.as_ref(), tables);
    if stale.is_empty() {
        // The IR is of these tables: it says which values they may have.
        rules::check(tables, &irs)?;
    }
    match emit(args, project, tables, &irs, Trusted::default()) {
        Ok(tree) => {
            let mut found = compare::differences(&project.out, &tree)?;
            let edited = compare::edited_irs(manifest.as_ref(), &tree);
            let is_stale = |it: &Difference| stale.iter().any(|known| known.path == it.path);
            found.extend(edited.into_iter().filter(|it| !is_stale(it)));
            found.extend(stale);
            Ok((found, owners))
        }
        // A table of another structure than its IR may not be emittable: that is a difference.
        Err(_) if !stale.is_empty() => Ok((stale, owners)),
        Err(failure) => Err(failure),
    }
}
