//! Where the tables and the generated package lie, and what the package is called.

use std::path::{Path, PathBuf};

use ahv_codegen::Core;

use crate::args::Args;
use crate::failure::Failure;
use crate::settings::Settings;
use crate::surroundings::Surroundings;

/// What one generation reads and writes.
#[derive(Debug, Clone)]
pub struct Project {
    /// The folder that paths in messages are relative to.
    pub root: PathBuf,
    /// The folder of the tables.
    pub tables: PathBuf,
    /// The folder of the generated package.
    pub out: PathBuf,
    /// The name of the generated package.
    pub(crate) package: String,
    /// Where the generated package finds `ahv-core`.
    pub(crate) core: Core,
    /// The command that people of this project generate with, where it is not the usual one.
    pub(crate) command: Option<String>,
}

impl Project {
    /// The nearest folder above that looks like a project, else the current one.
    ///
    /// # Errors
    /// `[workspace.metadata.ahv]` of its `Cargo.toml` has a fault.
    pub fn locate(args: &Args, surroundings: &Surroundings) -> Result<Self, Failure> {
        let here = &surroundings.current_dir;
        let (root, settings) = root_and_settings(here)?;
        let given = |path: &Option<PathBuf>| path.as_ref().map(|path| here.join(path));
        let own_tables = settings.tables.as_deref().unwrap_or("generator/tables");
        let own_out = match &settings.out {
            Some(out) => args.target.folder_below(out),
            None => args.target.folder().to_owned(),
        };
        Ok(Self {
            tables: given(&args.tables).unwrap_or_else(|| root.join(own_tables)),
            out: given(&args.out).unwrap_or_else(|| root.join(own_out)),
            package: args.package(&settings),
            core: args.core(&settings),
            command: settings.command,
            root,
        })
    }

    /// The command that people of this project generate with. The generator of a repository that holds it does not need the models
    /// to compile.
    pub(crate) fn usual_command(&self) -> &str {
        let usual = if self.root.join("generator/ahv_generator").is_dir() {
            "cargo xtask generate"
        } else {
            "ahv generate"
        };
        self.command.as_deref().unwrap_or(usual)
    }

    /// A path as messages and JSON name it: from the project's root, which is `.`, with `/`.
    #[must_use]
    pub fn shown(&self, path: &Path) -> String {
        // A name may hold characters that act on a terminal.
        let text = match slashed(path.strip_prefix(&self.root).unwrap_or(path)) {
            root if root.is_empty() => ".".to_owned(),
            other => other,
        };
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

/// The root of the project around a folder, and what its `Cargo.toml` says.
fn root_and_settings(here: &Path) -> Result<(PathBuf, Settings), Failure> {
    for folder in here.ancestors() {
        if let Some(settings) = Settings::of(folder)? {
            return Ok((folder.to_owned(), settings));
        }
        if folder.join("generator/tables").is_dir() || folder.join("generated").is_dir() {
            return Ok((folder.to_owned(), Settings::default()));
        }
    }
    Ok((here.to_owned(), Settings::default()))
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
