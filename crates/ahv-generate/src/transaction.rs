//! Changes of many files, all of them or none.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::compare::Difference;
use crate::failure::Failure;
use crate::interrupt;

/// How the names of temporary files start.
const TEMPORARY: &str = ".ahv-";

/// Changes that are on disk, beside the files that they change. Dropping them removes them.
pub(crate) struct Transaction {
    steps: Vec<Step>,
    // Dropped last: only an empty folder can be removed.
    folders: NewFolders,
}

/// The change of one file.
struct Step {
    target: PathBuf,
    /// The new text; none for a file that is removed.
    new: Option<NamedTempFile>,
    /// The old bytes; none for a file that is created.
    old: Option<NamedTempFile>,
    removes: bool,
}

/// Folders that were made for new files. Those that hold nothing in the end are removed.
#[derive(Default)]
struct NewFolders(Vec<PathBuf>);

impl Drop for NewFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

impl Transaction {
    /// Writes the new texts, and copies of the old ones, beside the files: a full disk leaves the tree as it was.
    ///
    /// # Errors
    /// A file that cannot be read, no room for a new one, or a signal. No file was changed then.
    pub(crate) fn stage<'a>(
        out: &Path,
        differences: impl Iterator<Item = &'a Difference>,
    ) -> Result<Self, Failure> {
        let mut staged = Self {
            steps: Vec::new(),
            folders: NewFolders::default(),
        };
        for difference in differences {
            interrupt::check()?;
            let target = out.join(&difference.path);
            let new = match difference.replacement() {
                Some(text) => Some(staged.write(&target, text)?),
                None => None,
            };
            let old = copy(&target).map_err(Failure::file("copy", &target))?;
            staged.steps.push(Step {
                removes: new.is_none(),
                target,
                new,
                old,
            });
        }
        Ok(staged)
    }

    fn write(&mut self, target: &Path, text: &str) -> Result<NamedTempFile, Failure> {
        let folder = target.parent().unwrap_or(target);
        self.folders.make(folder)?;
        let mut file = temporary(folder).map_err(Failure::file("write in", folder))?;
        file.write_all(text.as_bytes())
            // Some file systems find out only now that there is no room.
            .and_then(|()| file.as_file().sync_all())
            .map_err(Failure::file("write", target))?;
        Ok(file)
    }

    /// Brings the changes about.
    ///
    /// # Errors
    /// A change that is refused. Those before it are undone; what cannot be undone is named.
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        for index in 0..self.steps.len() {
            let step = &mut self.steps[index];
            let Err(error) = step.apply() else { continue };
            let deed = if step.removes { "remove" } else { "write" };
            let failure = Failure::file(deed, &step.target)(error);
            let changed: Vec<String> = self.steps[..index]
                .iter_mut()
                .rev()
                .filter_map(Step::undo)
                .collect();
            return Err(if changed.is_empty() {
                failure.with_help("every file is as it was")
            } else {
                failure.with_help(format!(
                    "these files could not be put back: {}; every other file is as it was",
                    changed.join("; ")
                ))
            });
        }
        Ok(())
    }
}

impl Step {
    fn apply(&mut self) -> io::Result<()> {
        match self.new.take() {
            // A rename: whoever reads the file finds the old text or the new.
            Some(file) => file.persist(&self.target).map(drop).map_err(|it| it.error),
            None => remove(&self.target),
        }
    }

    /// Puts the old file back; where that fails, says which file is new.
    fn undo(&mut self) -> Option<String> {
        let target = self.target.display();
        let Some(old) = self.old.take() else {
            let error = remove(&self.target).err()?;
            return Some(format!("{target} is new ({error})"));
        };
        let failed = old.persist(&self.target).err()?;
        let what = if self.removes { "removed" } else { "new" };
        let kept = match failed.file.keep() {
            Ok((_, path)) if path.exists() => format!("its old text is in {}", path.display()),
            _ => "its old text is lost".to_owned(),
        };
        Some(format!("{target} is {what} ({}), {kept}", failed.error))
    }
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        // Another run was faster.
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        done => done,
    }
}

/// A copy beside a file, with its permissions; none of a file that is not there.
fn copy(path: &Path) -> io::Result<Option<NamedTempFile>> {
    let mut original = match fs::File::open(path) {
        Ok(file) => file,
        // Of what is in the way of a folder the folder's maker complains.
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    let mut copy = temporary(path.parent().unwrap_or(path))?;
    io::copy(&mut original, copy.as_file_mut())?;
    copy.as_file()
        .set_permissions(original.metadata()?.permissions())?;
    Ok(Some(copy))
}

fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any new file: the umask has the last word.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

impl NewFolders {
    fn make(&mut self, folder: &Path) -> Result<(), Failure> {
        if folder.is_dir() {
            return Ok(());
        }
        if let Some(parent) = folder.parent() {
            self.make(parent)?;
        }
        match fs::create_dir(folder) {
            // Another run was faster.
            Err(_) if folder.is_dir() => return Ok(()),
            done => done.map_err(Failure::file("make the folder", folder))?,
        }
        self.0.push(folder.to_owned());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{NewFolders, Step, Transaction, copy, temporary};
    use std::fs;
    use std::io::Write as _;
    use std::path::{Path, PathBuf};

    /// A change of three files of which the last is refused: a folder with something in it stands there.
    fn refused(folder: &Path) -> Transaction {
        let mut steps = Vec::new();
        for (name, old, new) in [
            ("a", Some("old a"), Some("new a")),
            ("b", None, Some("new b")),
            ("c", Some("old c"), None),
            ("d", None, Some("new d")),
        ] {
            let target = folder.join(name);
            if let Some(old) = old {
                fs::write(&target, old).expect("written");
            }
            let new = new.map(|text| {
                let mut file = temporary(folder).expect("a file");
                file.write_all(text.as_bytes()).expect("written");
                file
            });
            let old = copy(&target).expect("copied");
            steps.push(Step {
                removes: new.is_none(),
                target,
                new,
                old,
            });
        }
        fs::create_dir_all(folder.join("d/in the way")).expect("made");
        Transaction {
            steps,
            folders: NewFolders::default(),
        }
    }

    fn files(folder: &Path) -> Vec<(String, String)> {
        let entries = fs::read_dir(folder).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let name = |path: &PathBuf| path.file_name().expect("a name").display().to_string();
        let mut files: Vec<(String, String)> = paths
            .filter(|path| path.is_file())
            .map(|path| (name(&path), fs::read_to_string(&path).expect("text")))
            .collect();
        files.sort();
        files
    }

    fn named(files: &[(&str, &str)]) -> Vec<(String, String)> {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        files.iter().map(owned).collect()
    }

    #[test]
    fn what_was_changed_before_a_failure_is_undone() {
        let folder = tempfile::tempdir().expect("a folder");
        let failure = refused(folder.path())
            .commit()
            .expect_err("d is in the way");
        let text = failure.to_string();
        let place = folder.path().join("d");
        assert!(
            text.starts_with(&format!("error: cannot write {}: ", place.display())),
            "{text}"
        );
        assert!(text.ends_with("help: every file is as it was"), "{text}");
        assert_eq!(
            files(folder.path()),
            named(&[("a", "old a"), ("c", "old c")])
        );
    }

    /// The copies are gone: another program removed them.
    #[test]
    fn what_cannot_be_undone_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let transaction = refused(folder.path());
        for step in &transaction.steps {
            if let Some(old) = &step.old {
                fs::remove_file(old.path()).expect("removed");
            }
        }
        let text = transaction
            .commit()
            .expect_err("d is in the way")
            .to_string();
        let place = |name: &str| folder.path().join(name).display().to_string();
        for said in [
            format!("{} is new (", place("a")),
            format!("{} is removed (", place("c")),
            "every other file is as it was".to_owned(),
        ] {
            assert!(text.contains(&said), "no {said:?} in {text}");
        }
        assert!(!text.contains(&place("b")), "{text}");
        assert_eq!(files(folder.path()), named(&[("a", "new a")]));
    }

    #[test]
    fn what_is_not_committed_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = NewFolders::default();
        folders.make(&folder.path().join("x/y")).expect("made");
        let transaction = refused(folder.path());
        drop((transaction, folders));
        assert_eq!(
            files(folder.path()),
            named(&[("a", "old a"), ("c", "old c")])
        );
        assert!(!folder.path().join("x").exists());
    }
}
