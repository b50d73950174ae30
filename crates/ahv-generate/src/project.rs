//! Where the tables and the generated package lie.

use std::path::{Path, PathBuf};

use crate::args::Args;
use crate::surroundings::Surroundings;

/// The folders that one generation reads and writes.
#[derive(Debug, Clone)]
pub struct Project {
    /// The folder that paths in messages are relative to.
    pub root: PathBuf,
    /// The folder of the tables.
    pub tables: PathBuf,
    /// The folder of the generated package.
    pub out: PathBuf,
}

impl Project {
    /// The nearest folder above that looks like a project, else the current one.
    #[must_use]
    pub fn locate(args: &Args, surroundings: &Surroundings) -> Self {
        let here = &surroundings.current_dir;
        let root = here
            .ancestors()
            .find(|folder| {
                folder.join("generator/tables").is_dir() || folder.join("generated").is_dir()
            })
            .unwrap_or(here)
            .to_owned();
        let given = |path: &Option<PathBuf>| path.as_ref().map(|path| here.join(path));
        Self {
            tables: given(&args.tables).unwrap_or_else(|| root.join("generator/tables")),
            out: given(&args.out).unwrap_or_else(|| root.join(args.target.folder())),
            root,
        }
    }

    /// Whether it is the repository of the generator.
    pub(crate) fn holds_generator(&self) -> bool {
        self.root.join("generator/ahv_generator").is_dir()
    }

    /// A path as messages and JSON name it: from the project's root, with `/`.
    #[must_use]
    pub fn shown(&self, path: &Path) -> String {
        // A name may hold characters that act on a terminal.
        let text = slashed(path.strip_prefix(&self.root).unwrap_or(path));
        let shown = |letter: char| {
            if letter.is_control() {
                letter.escape_default().to_string()
            } else {
                letter.to_string()
            }
        };
        text.chars().map(shown).collect()
    }

    /// The same for a file of the generated package.
    #[must_use]
    pub fn shown_out(&self, relative: &str) -> String {
        self.shown(&self.out.join(relative))
    }
}

/// A path's text with `/` on every platform.
pub(crate) fn slashed(path: &Path) -> String {
    let text = path.to_string_lossy();
    if cfg!(windows) {
        text.replace('\\', "/")
    } else {
        text.into_owned()
    }
}
