//! Python environments of ahv's own: made once from a locked list of packages, kept in the cache.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{interpreter, isolated, last_lines, package};
use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Progress;
use crate::surroundings::Surroundings;

/// Stands in an environment whose set-up came to its end. An environment cannot be built aside
/// and renamed (its scripts hold its path), so this file tells a whole one from a broken-off one.
const COMPLETE: &str = "complete";

/// The interpreter of the environment that has exactly the locked `requirements`, which is set up
/// first where there is none. `purpose` is for the messages.
///
/// # Errors
/// No Python, no network, no room: each says what to do.
pub fn environment(
    purpose: &str,
    requirements: &str,
    surroundings: &Surroundings,
) -> Result<PathBuf, Failure> {
    let parent = surroundings.cache()?.join("python");
    let key = package::key([requirements]);
    if let Some(python) = finished(&parent, &key) {
        return Ok(python);
    }
    fs::create_dir_all(&parent).map_err(Failure::file("make", &parent))?;
    let _lock = lock(&parent.join(format!("{key}.lock")))?;
    // Another process may have finished it while this one waited.
    if let Some(python) = finished(&parent, &key) {
        return Ok(python);
    }
    let (base, version) = interpreter::find()?;
    let folder = parent.join(format!("{key}-{version}"));
    let _progress = Progress::announced(format!(
        "setting up the Python environment for {purpose} (once)"
    ));
    // What a failure or a signal leaves is of no use.
    set_up(base, &folder, requirements).inspect_err(|_| {
        let _ = fs::remove_dir_all(&folder);
    })?;
    Ok(python_in(&folder))
}

/// A finished environment for these requirements, of whichever Python version: found without
/// running anything.
fn finished(parent: &Path, key: &str) -> Option<PathBuf> {
    let prefix = format!("{key}-");
    let mut folders: Vec<PathBuf> = fs::read_dir(parent)
        .ok()?
        .filter_map(|entry| entry.ok())
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(&prefix))
        .map(|entry| entry.path())
        // The interpreter is a link: it leads nowhere once its Python was uninstalled.
        .filter(|folder| folder.join(COMPLETE).is_file() && python_in(folder).is_file())
        .collect();
    folders.sort();
    folders.pop().map(|folder| python_in(&folder))
}

fn python_in(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    })
}

/// Held until dropped; the system lets go of it when the process dies.
fn lock(path: &Path) -> Result<File, Failure> {
    let file = File::create(path).map_err(Failure::file("write", path))?;
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let _progress = Progress::announced("waiting for another ahv that sets up Python");
            file.lock().map_err(Failure::file("lock", path))?;
        }
        Err(TryLockError::Error(error)) => return Err(Failure::file("lock", path)(error)),
    }
    Ok(file)
}

fn set_up(base: &str, folder: &Path, requirements: &str) -> Result<(), Failure> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(Failure::file("remove", folder))?;
    }
    let mut venv = isolated(base);
    venv.args(["-m", "venv"]).arg(folder);
    run(&mut venv, |reason| {
        Failure::new(format!(
            "{base} cannot make a virtual environment: {reason}"
        ))
        .with_help(
            "install its venv module (Debian, Ubuntu: apt install python3-venv), or set AHV_PYTHON",
        )
    })?;

    let list = folder.join("requirements.txt");
    fs::write(&list, requirements).map_err(Failure::file("write", &list))?;
    let mut pip = isolated(python_in(folder));
    // Where pip unpacks, so that it goes with the folder.
    for variable in ["TMPDIR", "TEMP", "TMP"] {
        pip.env(variable, folder);
    }
    pip.args([
        "-m",
        "pip",
        "install",
        "--no-input",
        "--disable-pip-version-check",
        "--quiet",
    ])
    .args(["--require-hashes", "--only-binary", ":all:", "-r"])
    .arg(&list);
    run(&mut pip, |reason| {
        Failure::new(format!(
            "pip could not install the Python packages: {reason}"
        ))
        .with_help(
            "they are fetched once: is there a network? \
             Or set AHV_PYTHON to a Python that has casadi and pint",
        )
    })?;

    let marker = folder.join(COMPLETE);
    File::create(&marker)
        .map(drop)
        .map_err(Failure::file("write", &marker))
}

/// Runs a program; when it fails, `failed` gets the end of what it said.
fn run(command: &mut Command, failed: impl Fn(String) -> Failure) -> Result<(), Failure> {
    let output = interrupt::output(command, |error| failed(error.to_string()))?;
    if output.status.success() {
        return Ok(());
    }
    // venv writes its errors to standard output.
    let said = if output.stderr.is_empty() {
        &output.stdout
    } else {
        &output.stderr
    };
    Err(failed(format!("{}{}", output.status, last_lines(said))))
}
