//! The Python package, carried inside this program and unpacked where Python can import it.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::failure::Failure;

/// Paths below `ahv_generator/` and texts.
const PACKAGE: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/modules.rs"));

/// What runs when Python is given the folder. What the caller's PYTHONPATH names comes last.
const LAUNCHER: &str = "import faulthandler
import os
import sys

sys.path += filter(None, os.environ.get(\"PYTHONPATH\", \"\").split(os.pathsep))

from ahv_generator.__main__ import main
from ahv_generator.parent import end_with_standard_input

# A crash is reported with its place.
faulthandler.enable()
end_with_standard_input()
sys.exit(main())
";

/// All that is unpacked: names and texts.
pub(super) fn sources() -> impl Iterator<Item = &'static str> {
    let modules = PACKAGE.iter().flat_map(|(name, text)| [*name, *text]);
    modules.chain([LAUNCHER])
}

/// The folder that holds `ahv_generator/`, named after the content, so that two versions of this
/// program never meet in it.
pub(super) fn unpack(cache: &Path) -> Result<PathBuf, Failure> {
    let parent = cache.join("generator");
    let folder = parent.join(key(sources()));
    if folder.is_dir() {
        return Ok(folder);
    }
    fs::create_dir_all(&parent).map_err(Failure::file("make", &parent))?;
    let scratch = tempfile::tempdir_in(&parent).map_err(Failure::file("write in", &parent))?;
    for (name, text) in PACKAGE {
        let path = scratch.path().join("ahv_generator").join(name);
        let folder = path.parent().unwrap_or(&path);
        fs::create_dir_all(folder).map_err(Failure::file("make", folder))?;
        fs::write(&path, text).map_err(Failure::file("write", &path))?;
    }
    let launcher = scratch.path().join("__main__.py");
    fs::write(&launcher, LAUNCHER).map_err(Failure::file("write", &launcher))?;
    // A rename makes the folder appear whole, or not at all when another process was faster.
    match fs::rename(scratch.path(), &folder) {
        Err(_) if folder.is_dir() => Ok(folder),
        Err(error) => Err(Failure::file("make", &folder)(error)),
        Ok(()) => Ok(folder),
    }
}

/// A short name for some texts.
pub(super) fn key<'a>(texts: impl IntoIterator<Item = &'a str>) -> String {
    let mut hash = Sha256::new();
    for text in texts {
        hash.update(text.len().to_le_bytes());
        hash.update(text.as_bytes());
    }
    hash.finalize()
        .iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
