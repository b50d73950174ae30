//! Where the new repository takes ahv from.

use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::place::Place;
use crate::{Args, slashed};
use ahv_generate::Failure;

/// The crates that the new repository depends on, by which a repository of ahv is known.
pub(crate) const CRATES: [&str; 3] = ["ahv-analysis", "ahv-cli", "ahv-core"];

/// Where ahv comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Origin {
    /// A folder, relative to the new repository or absolute.
    Folder(String),
    /// A revision of a git repository.
    Git {
        /// Its URL.
        url: String,
        /// The revision.
        rev: String,
    },
}

impl Origin {
    /// What the command line says, for a repository at `place`.
    ///
    /// # Errors
    /// No such folder, no ahv in it, or a URL without a revision.
    pub(crate) fn find(args: &Args, here: &Path, place: &Place) -> Result<Self, Failure> {
        let given = &args.ahv;
        let is_url = given.contains("://");
        match (&args.rev, is_url) {
            (Some(rev), true) if rev.trim().is_empty() || rev.starts_with('-') => {
                Err(Failure::new(format!("`{rev}` is not a revision")))
            }
            (Some(rev), true) => Ok(Self::Git {
                url: given.clone(),
                rev: rev.clone(),
            }),
            (None, true) => Err(Failure::new(format!("{given} needs a revision"))
                .with_help("give the full hash with --rev: another one may emit other code")),
            (Some(_), false) => Err(Failure::new(format!(
                "--rev is for the URL of a git repository, and `{given}` is a folder"
            ))
            .with_help("a URL has `://`, such as ssh://git@example.org/ahv.git")),
            (None, false) => folder(given, here, place),
        }
    }

    /// What a `Cargo.toml` says of a crate of ahv.
    pub(crate) fn dependency(&self, package: &str) -> String {
        let quoted = |text: &str| toml_edit::Value::from(text).to_string();
        match self {
            Self::Folder(path) => {
                format!(
                    "{{ path = {} }}",
                    quoted(&format!("{path}/crates/{package}"))
                )
            }
            Self::Git { url, rev } => {
                format!("{{ git = {}, rev = {} }}", quoted(url), quoted(rev))
            }
        }
    }
}

fn folder(given: &str, here: &Path, place: &Place) -> Result<Origin, Failure> {
    let path = here.join(given);
    let found = fs::canonicalize(&path).map_err(|error| {
        Failure::new(format!("found no ahv at {given}: {error}")).with_help(
            "--ahv is the folder of ahv's repository, or a URL with `://` and a revision with --rev",
        )
    })?;
    for package in CRATES {
        let manifest = format!("crates/{package}/Cargo.toml");
        if !found.join(&manifest).is_file() {
            let message = format!("{given} is not a repository of ahv: it has no {manifest}");
            return Err(Failure::new(message));
        }
    }
    // A relative path holds where both folders are moved together; an absolute one was asked for.
    let relative = if Path::new(given).is_absolute() {
        None
    } else {
        relative(place.folder(), &found)
    };
    Ok(Origin::Folder(slashed(&relative.unwrap_or(found))))
}

/// The way from one folder to another; none where they lie on different drives.
fn relative(from: &Path, to: &Path) -> Option<PathBuf> {
    let (from, to): (Vec<_>, Vec<_>) = (from.components().collect(), to.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return None;
    }
    let up = from[common..].iter().map(|_| Component::ParentDir);
    Some(up.chain(to[common..].iter().copied()).collect())
}

#[cfg(test)]
mod tests {
    use super::{Origin, relative};
    use std::path::{Path, PathBuf};

    #[test]
    fn the_way_to_ahv_starts_in_the_new_repository() {
        for (from, to, way) in [
            ("/a/w", "/a/ahv", "../ahv"),
            ("/a/b/w", "/a/ahv", "../../ahv"),
            ("/a/ahv/w", "/a/ahv", ".."),
            ("/w", "/a/ahv", "../a/ahv"),
        ] {
            let found = relative(Path::new(from), Path::new(to));
            assert_eq!(found, Some(PathBuf::from(way)));
        }
    }

    #[test]
    fn a_dependency_is_written_as_toml() {
        let folder = Origin::Folder("../a \"b\"".to_owned());
        let line = format!("x = {}", folder.dependency("ahv-core"));
        let document: toml_edit::DocumentMut = line.parse().expect("TOML");
        assert_eq!(
            document["x"]["path"].as_str(),
            Some("../a \"b\"/crates/ahv-core")
        );
        let git = Origin::Git {
            url: "https://example.org/ahv".to_owned(),
            rev: "abc".to_owned(),
        };
        assert_eq!(
            git.dependency("ahv-core"),
            "{ git = \"https://example.org/ahv\", rev = \"abc\" }"
        );
    }
}
