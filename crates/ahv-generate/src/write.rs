//! Brings the tree on disk up to date, whole or not at all.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::compare::{Difference, MANIFEST, Status};
use crate::failure::Failure;
use crate::project::Project;

/// Stands in every generated source file.
const MARK: &str = "ahv generate";

/// Writes what differs or is missing and removes what is stray.
pub(crate) fn apply(project: &Project, differences: &[Difference]) -> Result<(), Failure> {
    refuse_foreign(project, differences)?;
    // All texts are on disk before the first takes its place: a full disk leaves the tree as it was.
    let mut new_folders = Vec::new();
    let staged = match stage(&project.out, differences, &mut new_folders) {
        Ok(staged) => staged,
        Err(failure) => {
            for folder in new_folders.iter().rev() {
                let _ = fs::remove_dir(folder);
            }
            return Err(failure);
        }
    };
    for (file, target) in staged {
        file.persist(&target)
            .map_err(|error| Failure::file("write", &target)(error.error))?;
    }
    for stray in differences.iter().filter(|it| it.status == Status::Stray) {
        let path = project.out.join(&stray.path);
        fs::remove_file(&path).map_err(Failure::file("remove", &path))?;
        remove_emptied(&project.out, &path);
    }
    Ok(())
}

/// A folder without a manifest is perhaps not a generated one: nothing is overwritten or removed
/// there that does not say it was generated.
fn refuse_foreign(project: &Project, differences: &[Difference]) -> Result<(), Failure> {
    if project.out.join(MANIFEST).exists() {
        return Ok(());
    }
    let foreign = |difference: &&Difference| {
        let present = difference.status != Status::Missing && !difference.path.starts_with("ir/");
        present
            && fs::read(project.out.join(&difference.path)).is_ok_and(|bytes| {
                let text = String::from_utf8_lossy(&bytes);
                !text.trim().is_empty() && !text.contains(MARK)
            })
    };
    match differences.iter().find(foreign) {
        None => Ok(()),
        Some(it) => Err(Failure::new(format!(
            "{} was not generated, and would be lost: {} has no {MANIFEST}",
            project.shown_out(&it.path),
            project.shown(&project.out),
        ))
        .with_help("move it away, or name another folder with --out")),
    }
}

/// Writes the new texts beside their targets. Dropping them removes them.
fn stage(
    out: &Path,
    differences: &[Difference],
    new_folders: &mut Vec<PathBuf>,
) -> Result<Vec<(NamedTempFile, PathBuf)>, Failure> {
    let mut staged = Vec::new();
    for difference in differences.iter().filter(|it| it.status != Status::Stray) {
        let target = out.join(&difference.path);
        let folder = target.parent().unwrap_or(out);
        create_folders(folder, new_folders)?;
        let mut file = temporary(folder).map_err(Failure::file("write in", folder))?;
        file.write_all(difference.new.as_bytes())
            // Some file systems find out only now that there is no room.
            .and_then(|()| file.as_file().sync_all())
            .map_err(Failure::file("write", &target))?;
        staged.push((file, target));
    }
    Ok(staged)
}

fn temporary(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".ahv-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any new file: the umask has the last word.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn create_folders(folder: &Path, created: &mut Vec<PathBuf>) -> Result<(), Failure> {
    if folder.is_dir() {
        return Ok(());
    }
    if let Some(parent) = folder.parent() {
        create_folders(parent, created)?;
    }
    fs::create_dir(folder).map_err(Failure::file("make the folder", folder))?;
    created.push(folder.to_owned());
    Ok(())
}

/// Removes the folders that a removed file leaves empty.
fn remove_emptied(out: &Path, removed: &Path) {
    let folders = removed
        .ancestors()
        .skip(1)
        .take_while(|folder| *folder != out);
    for folder in folders {
        if fs::remove_dir(folder).is_err() {
            return;
        }
    }
}
