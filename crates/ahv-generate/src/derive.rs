//! The derivation: runs the Python package on the tables and takes the IR.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Output;

use ahv_codegen::AUDIT;

use serde::Deserialize;

use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Progress;
use crate::python::{Generator, last_lines};
use crate::tables::{Diagnostic, Tables};

/// The exit code with which the Python package says that a table is at fault.
const BAD_TABLES: i32 = 2;

#[derive(Deserialize)]
pub(crate) struct Diagnostics {
    pub(crate) diagnostics: Vec<Diagnostic>,
}

/// The IR of each table, by the table's name; and the audit, where a table has the printed form. Those that are `known` are
/// not derived again.
pub(crate) fn derive(
    python: &Generator,
    tables: &Tables,
    known: &BTreeMap<String, String>,
) -> Result<BTreeMap<String, String>, Failure> {
    let folder = tempfile::tempdir()
        .map_err(|error| Failure::new(format!("cannot make a temporary folder: {error}")))?;
    let output = {
        let sought = tables.parsed.iter().map(|it| it.name.as_str());
        let sought: Vec<&str> = sought.filter(|it| !known.contains_key(*it)).collect();
        let _progress = Progress::quiet(format!("deriving the models of {}", sought.join(", ")));
        let mut command = python.command();
        command.args(["derive", "--out"]).arg(folder.path());
        for table in known.keys().filter(|it| *it != AUDIT) {
            command.args(["--known", table]);
        }
        command.args(known.contains_key(AUDIT).then_some("--audit-known"));
        command.args(tables.sources.iter().map(|source| &source.path));
        interrupt::output(&mut command, |error| {
            Failure::new(format!("cannot run Python: {error}"))
        })?
    };
    if !output.status.success() {
        return Err(failure(&output, tables));
    }
    let mut irs = BTreeMap::new();
    for table in &tables.parsed {
        if let Some(text) = known.get(&table.name) {
            irs.insert(table.name.clone(), text.clone());
            continue;
        }
        let path = folder.path().join(format!("{}.json", table.name));
        let text = fs::read_to_string(&path).map_err(|error| {
            let message = format!(
                "the derivation left no IR for table {:?}: {error}",
                table.name
            );
            with_stderr(message, &output)
        })?;
        irs.insert(table.name.clone(), text.replace("\r\n", "\n"));
    }
    let audit = folder.path().join(format!("{AUDIT}.json"));
    match fs::read_to_string(&audit) {
        Ok(text) => {
            let text = known.get(AUDIT).unwrap_or(&text).replace("\r\n", "\n");
            irs.insert(AUDIT.to_owned(), text);
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(Failure::file("read", &audit)(error)),
    }
    Ok(irs)
}

pub(crate) fn failure(output: &Output, tables: &Tables) -> Failure {
    if output.status.code() == Some(BAD_TABLES)
        && let Ok(found) = serde_json::from_slice::<Diagnostics>(&output.stdout)
        && !found.diagnostics.is_empty()
    {
        return tables.faults(found.diagnostics);
    }
    if let Some(fault) = crash(&output.stderr, tables) {
        return tables.faults(vec![fault]);
    }
    with_stderr(format!("the derivation failed ({})", output.status), output)
}

/// A crash of the interpreter in a file beside a table, as Python's fault handler reports it.
fn crash(stderr: &[u8], tables: &Tables) -> Option<Diagnostic> {
    let text = String::from_utf8_lossy(stderr);
    let (_, report) = text.split_once("Fatal Python error: ")?;
    let message = format!("the Python interpreter crashed: {}", report.lines().next()?);
    let (file, line) = report.lines().find_map(|frame| {
        let (path, place) = frame
            .trim()
            .strip_prefix("File \"")?
            .split_once("\", line ")?;
        let line = place.split(' ').next()?.parse().ok()?;
        let folders = tables.sources.iter().filter_map(|it| it.path.parent());
        let file = folders
            .into_iter()
            .find_map(|it| Path::new(path).strip_prefix(it).ok())?;
        Some((file.to_str()?.to_owned(), line))
    })?;
    Some(Diagnostic::of_line(&file, line, message))
}

pub(crate) fn with_stderr(message: String, output: &Output) -> Failure {
    Failure::new(format!("{message}{}", last_lines(&output.stderr)))
}
