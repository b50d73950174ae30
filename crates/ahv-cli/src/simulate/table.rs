//! The CSV file: all of it or none.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::failure::Failure;

/// A CSV file that takes its place only when complete.
///
/// Rows go to a temporary file in the same folder; a run that fails or is killed leaves what was there.
pub(super) struct Table {
    path: PathBuf,
    writer: csv::Writer<NamedTempFile>,
}

impl Table {
    /// Starts the file that will be `path`.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if no file can be made there.
    pub(super) fn create(path: &Path) -> Result<Self, Failure> {
        let existing = fs::metadata(path).ok();
        if let Some(metadata) = &existing {
            // Renaming would replace a device such as /dev/null, or get past a write protection.
            if !metadata.is_file() {
                return Err(cannot_write(path, "it exists and is not a regular file"));
            }
            if metadata.permissions().readonly() {
                return Err(cannot_write(path, "it is write-protected"));
            }
        }
        // A link stays a link: its target is replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if target.file_name().is_none() {
            return Err(cannot_write(path, "it names no file"));
        }
        let folder = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let mut builder = Builder::new();
        builder.prefix(".ahv-").suffix(".tmp");
        if let Some(permissions) = existing
            .map(|m| m.permissions())
            .or_else(default_permissions)
        {
            builder.permissions(permissions);
        }
        let file = builder
            .tempfile_in(folder)
            .map_err(|error| cannot_write(path, &plain(&error)))?;
        let writer = csv::WriterBuilder::new()
            .buffer_capacity(1 << 16)
            .from_writer(file);
        Ok(Self {
            path: target,
            writer,
        })
    }

    /// Writes the header.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the file cannot be written.
    pub(super) fn header(&mut self, columns: &[String]) -> Result<(), Failure> {
        self.writer
            .write_record(columns)
            .map_err(|error| self.failed(error))
    }

    /// Writes a row; each number reads back as the same bits.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the file cannot be written.
    pub(super) fn row(&mut self, values: &[f64]) -> Result<(), Failure> {
        self.writer
            .serialize(values)
            .map_err(|error| self.failed(error))
    }

    fn failed(&self, error: csv::Error) -> Failure {
        let why = match error.into_kind() {
            csv::ErrorKind::Io(error) => plain(&error),
            other => format!("{other:?}"),
        };
        cannot_write(&self.path, &why)
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if that fails; what was there stays.
    pub(super) fn finish(self) -> Result<(), Failure> {
        let Self { path, writer } = self;
        let file = writer
            .into_inner()
            .map_err(|error| cannot_write(&path, &plain(error.error())))?;
        file.as_file()
            .sync_all()
            .map_err(|error| cannot_write(&path, &plain(&error)))?;
        file.persist(&path)
            .map_err(|error| cannot_write(&path, &plain(&error.error)))?;
        Ok(())
    }
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
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.split_once(" at path \"") {
        Some((words, _)) => words.to_owned(),
        None => text,
    }
}

fn cannot_write(path: &Path, why: &str) -> Failure {
    Failure::Request(format!("cannot write {}: {why}", path.display()))
}
