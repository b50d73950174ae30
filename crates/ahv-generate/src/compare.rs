//! The tree on disk against the tree that the tables give.

use std::collections::BTreeMap;
use std::fs::FileType;
use std::path::{Path, PathBuf};
use std::{fs, io};

use ahv_codegen::{AUDIT, Manifest, Table, Tree, sha256};
use serde::Serialize;
use similar::{ChangeTag, TextDiff};

use crate::failure::Failure;
use crate::files;
use crate::manifest::{self, MANIFEST};
use crate::project::slashed;
use crate::structure;
use crate::tables::Tables;

/// Folders that hold nothing but generated files. Elsewhere a file that the tables do not give is
/// somebody's own.
const OWNED: [&str; 4] = ["docs", "ir", "schema", "src"];

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

/// Why a stray file is not removed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kept {
    /// No manifest says that ahv wrote it.
    Unlisted,
    /// It is not what ahv wrote.
    Edited,
    /// It leads to a place that may be anybody's.
    Link,
    /// A pipe, a socket or a device.
    Special,
}

impl Kept {
    /// The reason, after "kept: ".
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::Unlisted => "ahv did not write it",
            Self::Edited => "it was edited after ahv wrote it",
            Self::Link => "it is a link, and ahv follows none",
            Self::Special => "it is not a regular file",
        }
    }
}

/// A file on disk that is not as the tables give it.
#[derive(Debug, Clone)]
pub struct Difference {
    /// Relative to the generated package, with `/`.
    pub path: String,
    /// How it differs.
    pub status: Status,
    /// Why generating leaves a stray file where it is; `None` where it does not.
    pub kept: Option<Kept>,
    /// What is known of a difference whose text only a derivation can find out.
    pub(crate) reason: Option<&'static str>,
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
            kept: None,
            reason: None,
            old: String::new(),
            new: String::new(),
        }
    }

    /// A difference of two texts that are both known.
    pub(crate) fn of_texts(path: String, status: Status, old: String, new: String) -> Self {
        Self {
            old,
            new,
            ..Self::without_text(path, status)
        }
    }

    /// An IR that is not what the table gives. What that is, only a derivation can find out.
    fn unknown_ir(table: &str, reason: &'static str) -> Self {
        Self {
            reason: Some(reason),
            ..Self::without_text(ir_path(table), Status::Differs)
        }
    }

    /// The text that the file is to have; none for one that is to go.
    pub(crate) fn replacement(&self) -> Option<&str> {
        (self.status != Status::Stray).then_some(&self.new)
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
            .header(
                &format!("a/{}", shown.trim_start_matches('/')),
                &format!("b/{}", shown.trim_start_matches('/')),
            )
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
            kept: None,
            reason: None,
            old,
            new: new.clone(),
        });
    }
    let written = manifest::on_disk(out);
    for (path, kind) in owned_files(out)? {
        // What stands where a folder belongs is in the way, not stray.
        let folder = format!("{path}/");
        if !tree.contains_key(&path) && !tree.keys().any(|it| it.starts_with(&folder)) {
            let kept = kept(out, &path, kind, &written);
            found.push(Difference {
                kept,
                ..Difference::without_text(path, Status::Stray)
            });
        }
    }
    // The manifest comes last: it changes with everything, and a reader looks for the cause. And it
    // is written last: until then the old one says what may be removed.
    found.sort_by(|a, b| (a.path == MANIFEST, &a.path).cmp(&(b.path == MANIFEST, &b.path)));
    Ok(found)
}

/// Why a stray file must stay: ahv removes what it wrote, as it wrote it, and nothing else.
fn kept(out: &Path, path: &str, kind: FileType, written: &[Manifest]) -> Option<Kept> {
    if kind.is_symlink() {
        return Some(Kept::Link);
    }
    if !kind.is_file() {
        return Some(Kept::Special);
    }
    let mut recorded = written.iter().filter_map(|it| it.written(path)).peekable();
    if recorded.peek().is_none() {
        return Some(Kept::Unlisted);
    }
    let hash = match read(&out.join(path)) {
        Ok(OnDisk::Text(text)) => sha256(&text),
        _ => return Some(Kept::Edited),
    };
    recorded.all(|it| it != hash).then_some(Kept::Edited)
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
    // A manifest that lists one tells whether it is missing.
    if let OnDisk::Text(text) = read(&out.join(ir_path(AUDIT)))? {
        irs.insert(AUDIT.to_owned(), text);
    }
    Ok((irs, missing))
}

/// The IRs that were derived from tables of another structure than there are now, or by another generator.
pub(crate) fn stale_irs(manifest: Option<&Manifest>, tables: &Tables) -> Vec<Difference> {
    let recorded = |table: &str| manifest.and_then(|it| it.structure.get(table));
    let generator = manifest.map(|it| it.generator.as_str());
    let reason = |(table, structure): (&String, &String)| match recorded(table) {
        None => Some("the manifest does not say from what it was derived"),
        Some(old) if old != structure => Some("the structure of the table has changed"),
        Some(_) if generator != Some(&*structure::of_generator()) => {
            Some("another version of the generator derived it")
        }
        Some(_) => None,
    };
    let stale = |known: (&String, &String)| Some(Difference::unknown_ir(known.0, reason(known)?));
    tables.structure.iter().filter_map(stale).collect()
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
        .map(|table| Difference::unknown_ir(table, "it was edited"))
        .collect()
}

/// The text of a file, with LF line ends; none of what is no text file.
pub(crate) fn text_of(path: &Path) -> Option<String> {
    match read(path) {
        Ok(OnDisk::Text(text)) => Some(text),
        _ => None,
    }
}

pub(crate) fn ir_path(table: &str) -> String {
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
    match files::read(path) {
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

/// Everything below the owned folders but folders and hidden files. Links are found, not followed.
fn owned_files(out: &Path) -> Result<BTreeMap<String, FileType>, Failure> {
    let mut files = BTreeMap::new();
    let mut folders: Vec<PathBuf> = OWNED
        .iter()
        .map(|name| out.join(name))
        .filter(|folder| !folder.is_symlink())
        .collect();
    while let Some(folder) = folders.pop() {
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) => match error.kind() {
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => continue,
                _ => return Err(Failure::file("read", &folder)(error)),
            },
        };
        for entry in entries {
            let entry = entry.map_err(Failure::file("read", &folder))?;
            let path = entry.path();
            let kind = entry.file_type().map_err(Failure::file("read", &path))?;
            if entry.file_name().to_string_lossy().starts_with('.') {
                continue;
            } else if kind.is_dir() {
                folders.push(path);
            } else {
                files.insert(slashed(path.strip_prefix(out).unwrap_or(&path)), kind);
            }
        }
    }
    Ok(files)
}
