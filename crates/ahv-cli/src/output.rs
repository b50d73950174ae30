//! What commands leave behind: files that are whole or as they were, and JSON.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use ahv_core::Outside;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use tempfile::{Builder, NamedTempFile};

use crate::failure::{Failure, complain, print};
use crate::show::show;

/// Temporary files that are there now.
static TEMPORARIES: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn temporaries() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the process with this code; other threads may still be writing. No temporary file is left.
pub(crate) fn exit_without_temporaries(code: u8) -> ! {
    // Locked until the end, so that no other thread makes a new one.
    let temporaries = temporaries();
    for path in temporaries.iter() {
        // One that is gone need not be removed, and nothing is left to do about one that cannot be.
        let _ = fs::remove_file(path);
    }
    std::process::exit(code.into())
}

/// A temporary file that is listed for as long as this lives.
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        temporaries().remove(&self.0);
    }
}

/// A file that takes its place only when complete.
///
/// Bytes go to a temporary file in the same folder; a run that fails or is ended by a signal leaves what was there.
pub(crate) struct Output {
    path: PathBuf,
    file: NamedTempFile,
    // Dropped after the file.
    _listed: Listed,
}

fn builder<'a>() -> Builder<'a, 'a> {
    let mut builder = Builder::new();
    builder.prefix(".ahv-").suffix(".tmp");
    builder
}

/// A new file in `folder` that a signal removes.
fn temporary(folder: &Path, builder: &Builder<'_, '_>) -> io::Result<(NamedTempFile, Listed)> {
    // No signal comes between the file and its place in the list.
    let mut temporaries = temporaries();
    let file = builder.tempfile_in(folder)?;
    let path = file.path().to_owned();
    temporaries.insert(path.clone());
    Ok((file, Listed(path)))
}

impl Output {
    /// Starts the file that will be `path`.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if no file can be made there.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let existing = fs::symlink_metadata(path).ok();
        if let Some(metadata) = &existing {
            // /dev/stdout is one too, and leads to a file that the shell writes.
            if metadata.is_symlink() {
                return Err(cannot_write(
                    path,
                    "it is a link; name the file that it leads to",
                ));
            }
            // Renaming would replace a device such as /dev/null, or get past a write protection.
            if !metadata.is_file() {
                return Err(cannot_write(path, "it exists and is not a regular file"));
            }
            if metadata.permissions().readonly() {
                return Err(cannot_write(path, "it is write-protected"));
            }
        }
        if path.file_name().is_none() {
            return Err(cannot_write(path, "it names no file"));
        }
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let mut builder = builder();
        if let Some(permissions) = existing
            .map(|m| m.permissions())
            .or_else(default_permissions)
        {
            builder.permissions(permissions);
        }
        let (file, listed) =
            temporary(folder, &builder).map_err(|error| cannot_write(path, &plain(&error)))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            _listed: listed,
        })
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if that fails; what was there stays.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self { path, file, .. } = self;
        file.as_file()
            .sync_all()
            .map_err(|error| cannot_write(&path, &plain(&error)))?;
        file.persist(&path)
            .map_err(|error| cannot_write(&path, &plain(&error.error)))?;
        Ok(())
    }

    /// What was written so far, from its start.
    ///
    /// # Errors
    ///
    /// Those of the system.
    pub(crate) fn reader(&self) -> io::Result<fs::File> {
        self.file.reopen()
    }

    /// Where the file will be.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Writes a whole file, or leaves what was there.
///
/// # Errors
///
/// [`Failure::Request`] if it cannot be written.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
    let mut output = Output::create(path)?;
    output
        .write_all(contents.as_ref())
        .map_err(|error| cannot_write(path, &plain(&error)))?;
    output.finish()
}

/// Makes the folder `path`, and those that it lies in, unless it is there. Called before the work: a file can be made in it.
///
/// # Errors
///
/// [`Failure::Request`] if it cannot be made, or no file can be made in it.
pub fn folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|error| {
        let why = match error.kind() {
            io::ErrorKind::AlreadyExists => "it exists and is not a folder".to_owned(),
            _ => plain(&error),
        };
        Failure::Request(format!("cannot make the folder {}: {why}", path.display()))
    })?;
    match temporary(path, &builder()) {
        Ok(_) => Ok(()),
        Err(error) => Err(cannot_write(path, &plain(&error))),
    }
}

/// Warns of files of an earlier run that stay beside those of this one, which does not write them.
pub fn warn_of_earlier(folder: &Path, names: &[&str]) {
    for path in names.iter().map(|name| folder.join(name)) {
        if fs::symlink_metadata(&path).is_ok() {
            complain(&format!(
                "warning: {} is of an earlier run, and stays as it is",
                path.display()
            ));
        }
    }
}

/// Writes a picture. One that cannot be drawn is a warning that says why: the numbers are not lost with it.
///
/// # Errors
///
/// [`Failure::Request`] if the file cannot be written.
pub fn picture(path: &Path, svg: Result<String, impl Display>) -> Result<(), Failure> {
    match svg {
        Ok(svg) => write(path, svg),
        Err(why) => {
            // One of an earlier run does not belong to the numbers beside it.
            let earlier = fs::symlink_metadata(path).is_ok_and(|it| it.is_file());
            let removed = earlier && fs::remove_file(path).is_ok();
            let earlier = if removed {
                "; the earlier one is removed"
            } else {
                ""
            };
            complain(&format!(
                "warning: {} is not drawn: {why}{earlier}",
                path.display()
            ));
            Ok(())
        }
    }
}

/// `value` as JSON text. Numbers that are not finite become `null`.
///
/// # Errors
///
/// [`Failure::Numeric`] if `value` does not serialize.
pub fn json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value)
        .map_err(|error| Failure::Numeric(format!("cannot write the outcome as JSON: {error}")))
}

/// Prints `value` as JSON.
///
/// # Errors
///
/// As [`json`] and [`print()`].
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// Pairs in their own order, as a JSON object.
pub(crate) struct Pairs<V>(pub(crate) Vec<(&'static str, V)>);

impl<V: Serialize> Serialize for Pairs<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// A component outside its validity box, for a person.
pub(crate) fn describe_outside(outside: &Outside, unit: &str) -> String {
    let Outside {
        name,
        value,
        bounds,
    } = *outside;
    let [value, min, max] = [value, bounds.min, bounds.max].map(|number| show(number, unit));
    format!("{name} is {value}, outside its validity box of {min} to {max}")
}

/// Temporary files are private by default; a result is as open as any new file.
#[cfg(unix)]
fn default_permissions() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn default_permissions() -> Option<fs::Permissions> {
    None
}

/// The system's words, without the name of the temporary file that `tempfile` adds to them.
pub(crate) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.split_once(" at path \"") {
        Some((words, _)) => words.to_owned(),
        None => text,
    }
}

/// A file that cannot be written, and why.
pub(crate) fn cannot_write(path: &Path, why: &str) -> Failure {
    Failure::Request(format!("cannot write {}: {why}", path.display()))
}

/// A unit as pictures show it, with what numbers are multiplied with: degrees in the place of radians.
pub(crate) fn readable(unit: &str) -> (String, f64) {
    let factor = if unit.starts_with("rad") {
        1_f64.to_degrees()
    } else {
        1.0
    };
    let pretty = unit
        .replace("rad", "deg")
        .replace("(ft*slug)^0.5", "(ft·slug)^½")
        .replace("(m*kg)^0.5", "(m·kg)^½");
    (pretty, factor)
}
