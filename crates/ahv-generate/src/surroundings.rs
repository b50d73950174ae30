//! What the process finds around itself, gathered in one place so that tests can give their own.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// The parts of the environment that generation depends on.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// Where relative paths start and the project is looked for.
    pub current_dir: PathBuf,
    /// `AHV_PYTHON`: the interpreter to use instead of an environment of its own.
    pub python: Option<OsString>,
    /// Where Python environments and the unpacked generator are kept; none where nothing names a place.
    pub cache: Option<PathBuf>,
}

impl Surroundings {
    /// Those of this process.
    ///
    /// # Errors
    /// No current folder.
    pub fn of_process() -> Result<Self, Failure> {
        let current_dir = env::current_dir()
            .map_err(|error| Failure::new(format!("there is no current folder: {error}")))?;
        // An empty variable is how shells and CI say "not set".
        let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty());
        Ok(Self {
            cache: cache_folder(variable).map(|cache| current_dir.join(cache)),
            python: variable("AHV_PYTHON"),
            current_dir,
        })
    }

    /// The folder of the cache, which only a derivation needs.
    pub(crate) fn cache(&self) -> Result<&Path, Failure> {
        self.cache.as_deref().ok_or_else(|| {
            Failure::new("found no folder for the cache: HOME is not set").with_help(
                "set AHV_CACHE_DIR to a folder that can be written; `--check --from-ir` needs none",
            )
        })
    }
}

/// `AHV_CACHE_DIR`, else the place that the platform has for caches.
fn cache_folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = |name: &str| variable(name).map(PathBuf::from);
    if let Some(own) = folder("AHV_CACHE_DIR") {
        return Some(own);
    }
    let caches = if cfg!(windows) {
        folder("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Caches"))
    } else {
        folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")))
    };
    caches.map(|caches| caches.join("ahv"))
}

#[cfg(test)]
mod tests {
    use super::cache_folder;
    use std::path::PathBuf;

    fn folder(set: &[(&str, &str)]) -> Option<PathBuf> {
        cache_folder(|name| {
            set.iter()
                .find(|(key, _)| *key == name)
                .map(|(_, value)| value.into())
        })
    }

    #[test]
    fn an_own_folder_comes_first() {
        let set = [
            ("HOME", "/h"),
            ("XDG_CACHE_HOME", "/x"),
            ("AHV_CACHE_DIR", "/own"),
        ];
        assert_eq!(folder(&set), Some("/own".into()));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn linux_follows_xdg() {
        assert_eq!(
            folder(&[("HOME", "/h"), ("XDG_CACHE_HOME", "/x")]),
            Some("/x/ahv".into())
        );
        assert_eq!(folder(&[("HOME", "/h")]), Some("/h/.cache/ahv".into()));
        assert_eq!(folder(&[]), None);
    }
}
