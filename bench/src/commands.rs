//! Programs and files.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Runs a program and gives its standard output.
pub(crate) fn output(command: &mut Command) -> Result<String, String> {
    match command.output() {
        Ok(output) if output.status.success() => {
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        }
        Ok(output) => Err(format!(
            "error: {} failed ({})\n{}",
            shown(command),
            output.status,
            String::from_utf8_lossy(&output.stderr).trim_end()
        )),
        Err(error) => Err(format!("error: cannot run {}: {error}", shown(command))),
    }
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    format!("`{}`", words.join(" "))
}

/// The tables of the project, in order of name.
pub(crate) fn tables(root: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = files(&root.join("generator/tables"))?;
    found.retain(|path| path.extension().is_some_and(|it| it == "toml"));
    Ok(found)
}

/// The entries of a folder, in order of name.
pub(crate) fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(problem("read", folder))?;
    let mut found: Vec<_> = entries
        .filter_map(|it| it.ok())
        .map(|it| it.path())
        .collect();
    found.sort();
    Ok(found)
}

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(problem("read", path))
}

/// The JSON of a file.
pub(crate) fn read_json(path: &Path) -> Result<Value, String> {
    serde_json::from_str(&read(path)?)
        .map_err(|error| format!("error: {}: {error}", path.display()))
}

/// Makes a folder where there is none.
pub(crate) fn make_folder(path: &Path) -> Result<(), String> {
    fs::create_dir_all(path).map_err(problem("make", path))
}

/// Writes a file whole or not at all.
pub(crate) fn write(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().unwrap_or(path);
    let mut file = tempfile::Builder::new();
    // Readable by all, as any file that is written.
    #[cfg(unix)]
    file.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
    let mut file = file
        .tempfile_in(folder)
        .map_err(problem("write in", folder))?;
    file.write_all(text.as_bytes())
        .map_err(problem("write", path))?;
    file.persist(path)
        .map_err(|error| problem("write", path)(error.error))?;
    Ok(())
}

/// A message about what could not be done with a file.
pub(crate) fn problem(deed: &str, path: &Path) -> impl FnOnce(std::io::Error) -> String {
    let message = format!("error: cannot {deed} {}", path.display());
    move |error| format!("{message}: {error}")
}
