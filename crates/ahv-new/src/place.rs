//! The folder of the new repository, which nobody else's files may be in.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use ahv_generate::Failure;

/// How the name of the folder starts in which a repository is made.
const TEMPORARY: &str = ".ahv-";

/// A folder that is not there, or is empty.
pub(crate) struct Place {
    /// Without links and `..`.
    folder: PathBuf,
    exists: bool,
}

/// A repository that is being made. Dropping it removes it.
pub(crate) struct Stage {
    folder: PathBuf,
    // Dropped last, in this order: what holds the folder, and then what was made for that.
    _holder: TempDir,
    parents: NewFolders,
}

/// Folders that were made; those that are empty in the end are removed.
struct NewFolders(Vec<PathBuf>);

impl Drop for NewFolders {
    fn drop(&mut self) {
        for folder in &self.0 {
            let _ = fs::remove_dir(folder);
        }
    }
}

impl Place {
    /// Checks that a repository may be made at `dir`, which messages name as it was given.
    ///
    /// # Errors
    /// A file, a link or a folder with something in it stands there.
    pub(crate) fn check(dir: &Path, given: &Path) -> Result<Self, Failure> {
        // Without a last `/`, behind which a link is what it leads to.
        let dir = &dir.components().collect::<PathBuf>();
        let shown = given.display();
        let refused = |why: &str| {
            let message = format!("{shown} {why}");
            Err(Failure::new(message).with_help("name a folder that does not exist, or is empty"))
        };
        let exists = match fs::symlink_metadata(dir) {
            Ok(found) if found.is_symlink() => return refused("is a link"),
            Ok(found) if !found.is_dir() => return refused("is not a folder"),
            Ok(_) => true,
            Err(_) => false,
        };
        if exists {
            let mut entries = fs::read_dir(dir).map_err(Failure::file("read", dir))?;
            if entries.next().is_some() {
                return refused("is not empty");
            }
        }
        let folder = resolved(dir).map_err(Failure::file("find", dir))?;
        if folder.file_name().is_none() {
            return refused("has no name");
        }
        Ok(Self { folder, exists })
    }

    /// Its path without links and `..`.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The last part of its path.
    pub(crate) fn name(&self) -> String {
        let name = self.folder.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// A folder to make the repository in, on the same file system.
    pub(crate) fn stage(&self) -> Result<Stage, Failure> {
        let parent = self.folder.parent().unwrap_or(&self.folder);
        let missing = parent.ancestors().take_while(|folder| !folder.exists());
        let parents = NewFolders(missing.map(Path::to_owned).collect());
        fs::create_dir_all(parent).map_err(Failure::file("make the folder", parent))?;
        let mut builder = tempfile::Builder::new();
        let holder = builder.prefix(TEMPORARY).tempdir_in(parent);
        let holder = holder.map_err(Failure::file("write in", parent))?;
        // Not the holder itself, which only its owner may read.
        let folder = holder.path().join("new");
        fs::create_dir(&folder).map_err(Failure::file("make the folder", &folder))?;
        Ok(Stage {
            folder,
            _holder: holder,
            parents,
        })
    }
}

impl Stage {
    /// The folder to write in.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Moves the whole to its place, if nothing has come there in the meantime.
    pub(crate) fn move_to(mut self, place: &Place) -> Result<(), Failure> {
        let to = place.folder();
        if place.exists {
            // A shell may stand in the folder: it stays the same one.
            self.move_entries(to)?;
        } else if fs::symlink_metadata(to).is_ok() {
            let message = format!("{} has come into being in the meantime", to.display());
            return Err(Failure::new(message));
        } else {
            fs::rename(&self.folder, to).map_err(Failure::file("make", to))?;
        }
        self.parents.0.clear();
        Ok(())
    }

    fn move_entries(&self, to: &Path) -> Result<(), Failure> {
        let entries = fs::read_dir(&self.folder).map_err(Failure::file("read", &self.folder))?;
        let mut moved: Vec<(PathBuf, PathBuf)> = Vec::new();
        for entry in entries {
            let entry = entry.map_err(Failure::file("read", &self.folder))?;
            let (from, target) = (entry.path(), to.join(entry.file_name()));
            let done = match fs::symlink_metadata(&target) {
                Ok(_) => Err(std::io::ErrorKind::AlreadyExists.into()),
                Err(_) => fs::rename(&from, &target),
            };
            if let Err(error) = done {
                for (from, target) in moved {
                    let _ = fs::rename(target, from);
                }
                return Err(Failure::file("write", &target)(error));
            }
            moved.push((from, target));
        }
        Ok(())
    }
}

/// A path without links and `..`, of which the last parts need not exist.
fn resolved(path: &Path) -> std::io::Result<PathBuf> {
    if let Ok(whole) = fs::canonicalize(path) {
        return Ok(whole);
    }
    match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => Ok(resolved(parent)?.join(name)),
        _ => fs::canonicalize(path),
    }
}
