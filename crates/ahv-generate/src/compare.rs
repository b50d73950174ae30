//! The tree on disk against the tree that the tables give.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{fs, io};

use ahv_codegen::{AUDIT, Manifest, Table, Tree};
use serde::Serialize;
use similar::{ChangeTag, TextDiff};

use crate::failure::Failure;
use crate::project::slashed;

/// Folders that hold nothing but generated files. Elsewhere a file that the tables do not give is
/// somebody's own.
const OWNED: [&str; 3] = ["docs", "ir", "src"];

/// Says from what the tree was made.
pub(crate) const MANIFEST: &str = "manifest.json";

/// How a file differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Its text is not what the tables give.
    Differs,
    /// It is not there.
    Missing,
    /// No table gives it.
    Stray,
}

/// A file on disk that is not as the tables give it.
#[derive(Debug, Clone)]
pub struct Difference {
    /// Relative to the generated package, with `/`.
    pub path: String,
    /// How it differs.
    pub status: Status,
    /// What is on disk.
    pub(crate) old: String,
    /// What the tables give.
    pub(crate) new: String,
}

impl Difference {
    fn without_text(path: String, status: Status) -> Self {
        Self {
            path,
            status,
            old: String::new(),
            new: String::new(),
        }
    }

    /// An IR that is not what the table gives. Only a derivation could tell what that is.
    fn untold_ir(table: &str) -> Self {
        Self::without_text(ir_path(table), Status::Differs)
    }

    /// Lines added and removed.
    pub(crate) fn counts(&self) -> (usize, usize) {
        let diff = TextDiff::from_lines(&self.old, &self.new);
        let count = |tag| {
            diff.iter_all_changes()
                .filter(|change| change.tag() == tag)
                .count()
        };
        (count(ChangeTag::Insert), count(ChangeTag::Delete))
    }

    /// A patch that turns what is on disk into what the tables give; empty for whole files.
    pub(crate) fn diff(&self, shown: &str) -> String {
        if self.status != Status::Differs || self.old == self.new {
            return String::new();
        }
        TextDiff::from_lines(&self.old, &self.new)
            .unified_diff()
            .context_radius(3)
            .header(&format!("a/{shown}"), &format!("b/{shown}"))
            .to_string()
    }
}

/// Everything in which the folder and the tree differ, in a fixed order.
pub(crate) fn differences(out: &Path, tree: &Tree) -> Result<Vec<Difference>, Failure> {
    let mut found = Vec::new();
    for (path, new) in tree {
        let (status, old) = match read(&out.join(path))? {
            OnDisk::Text(old) if old == *new => continue,
            OnDisk::Text(old) | OnDisk::NotText(old) => (Status::Differs, old),
            OnDisk::Missing => (Status::Missing, String::new()),
        };
        found.push(Difference {
            path: path.clone(),
            status,
            old,
            new: new.clone(),
        });
    }
    for path in owned_files(out)? {
        // What stands where a folder belongs is in the way, not stray.
        let folder = format!("{path}/");
        if !tree.contains_key(&path) && !tree.keys().any(|it| it.starts_with(&folder)) {
            found.push(Difference::without_text(path, Status::Stray));
        }
    }
    // The manifest comes last: it changes with everything, and a reader looks for the cause.
    found.sort_by(|a, b| (a.path == MANIFEST, &a.path).cmp(&(b.path == MANIFEST, &b.path)));
    Ok(found)
}

/// The IRs that lie in the tree, by table name, and those that ought to.
pub(crate) fn checked_in_irs(
    out: &Path,
    tables: &[Table],
) -> Result<(BTreeMap<String, String>, Vec<Difference>), Failure> {
    let (mut irs, mut missing) = (BTreeMap::new(), Vec::new());
    for table in tables {
        let path = ir_path(&table.name);
        match read(&out.join(&path))? {
            OnDisk::Text(text) => {
                irs.insert(table.name.clone(), text);
            }
            OnDisk::NotText(_) => missing.push(Difference::without_text(path, Status::Differs)),
            OnDisk::Missing => missing.push(Difference::without_text(path, Status::Missing)),
        }
    }
    // Whether there must be an audit the emitter knows.
    if let OnDisk::Text(text) = read(&out.join(ir_path(AUDIT)))? {
        irs.insert(AUDIT.to_owned(), text);
    }
    Ok((irs, missing))
}

/// What the tree on disk says that it was made from, if it can be read.
pub(crate) fn manifest(out: &Path) -> Option<Manifest> {
    let text = fs::read_to_string(out.join(MANIFEST)).ok()?;
    Manifest::parse(&text).ok()
}

/// Whether the folder's manifest is one of ahv, perhaps with the markers of a merge conflict or of
/// another version.
pub(crate) fn is_generated(out: &Path) -> bool {
    let text = fs::read(out.join(MANIFEST)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let names = |key: &str| text.contains(&format!("\"{key}\""));
    Manifest::parse(&text).is_ok() || (names("emitter") && names("templates"))
}

/// The IRs that were derived from other tables than there are now.
pub(crate) fn stale_irs(manifest: Option<&Manifest>, tables: &[Table]) -> Vec<Difference> {
    let recorded = |table: &Table| manifest.and_then(|it| it.tables.get(&table.name));
    tables
        .iter()
        .filter(|table| recorded(table) != Some(&table.sha256()))
        .map(|table| Difference::untold_ir(&table.name))
        .collect()
}

/// The IRs that are not those that were derived: `tree`, emitted from them, records other hashes.
pub(crate) fn edited_irs(manifest: Option<&Manifest>, tree: &Tree) -> Vec<Difference> {
    let now = tree
        .get(MANIFEST)
        .and_then(|text| Manifest::parse(text).ok());
    let (Some(recorded), Some(now)) = (manifest, now) else {
        return Vec::new();
    };
    let edited = |table: &&String| recorded.ir.get(*table) != now.ir.get(*table);
    recorded
        .ir
        .keys()
        .filter(edited)
        .map(|table| Difference::untold_ir(table))
        .collect()
}

fn ir_path(table: &str) -> String {
    format!("ir/{table}.json")
}

enum OnDisk {
    /// With LF line ends, as git may have checked it out with others.
    Text(String),
    /// Not UTF-8; what can be shown of it.
    NotText(String),
    Missing,
}

fn read(path: &Path) -> Result<OnDisk, Failure> {
    match fs::read(path) {
        Ok(bytes) => Ok(match String::from_utf8(bytes) {
            Ok(text) => OnDisk::Text(text.replace("\r\n", "\n")),
            Err(error) => OnDisk::NotText(String::from_utf8_lossy(error.as_bytes()).into_owned()),
        }),
        Err(error) => match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Ok(OnDisk::Missing),
            io::ErrorKind::IsADirectory => Err(Failure::new(format!(
                "{} is a folder where a generated file belongs",
                path.display()
            ))),
            _ => Err(Failure::file("read", path)(error)),
        },
    }
}

/// All files below the owned folders, hidden ones excepted. Links to folders are followed.
fn owned_files(out: &Path) -> Result<BTreeSet<String>, Failure> {
    let (mut files, mut seen) = (BTreeSet::new(), BTreeSet::new());
    let mut folders: Vec<PathBuf> = OWNED.iter().map(|name| out.join(name)).collect();
    while let Some(folder) = folders.pop() {
        // A link may lead back to where it lies.
        if fs::canonicalize(&folder).is_ok_and(|real| !seen.insert(real)) {
            continue;
        }
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) => match error.kind() {
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => continue,
                _ => return Err(Failure::file("read", &folder)(error)),
            },
        };
        for entry in entries {
            let entry = entry.map_err(Failure::file("read", &folder))?;
            if entry.file_name().to_string_lossy().starts_with('.') {
                continue;
            } else if fs::metadata(entry.path()).is_ok_and(|it| it.is_dir()) {
                folders.push(entry.path());
            } else {
                files.insert(slashed(
                    entry.path().strip_prefix(out).unwrap_or(&entry.path()),
                ));
            }
        }
    }
    Ok(files)
}
