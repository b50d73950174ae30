//! Hashes the sources of the emitter, so that files which another emitter wrote are never taken for its own.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// What decides about emitted text: this crate, and those of its dependencies that are here. A published package has its own
/// folders alone; the versions of the others say what they are.
const SOURCES: [&str; 6] = [
    "Cargo.toml",
    "src",
    "templates",
    "../ahv-table/src",
    "../../Cargo.lock",
    "../../xtask/Cargo.lock",
];
/// How the names of other people's packages start whose versions decide about emitted text.
const PACKAGES: [&str; 8] = [
    "askama",
    "prettyplease",
    "proc-macro2",
    "ryu",
    "serde_json",
    "syn\"",
    "toml_",
    "zmij",
];

fn main() -> io::Result<()> {
    let mut hash = Sha256::new();
    for source in SOURCES.iter().filter(|source| Path::new(source).exists()) {
        println!("cargo::rerun-if-changed={source}");
        for path in files(Path::new(source))? {
            // The same on every platform, whatever line ends git gave the file.
            let text = fs::read_to_string(&path)?.replace("\r\n", "\n");
            let name = path.to_string_lossy().replace('\\', "/");
            let text = if name.ends_with(".lock") {
                versions(&text)
            } else {
                text
            };
            for part in [name, text] {
                hash.update((part.len() as u64).to_le_bytes());
                hash.update(part);
            }
        }
    }
    let hex: String = hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets no OUT_DIR"))?;
    fs::write(Path::new(&out).join("emitter.txt"), hex)
}

/// A file, or all below a folder, in an order that does not depend on the file system.
fn files(path: &Path) -> io::Result<Vec<PathBuf>> {
    if path.is_file() {
        return Ok(vec![path.to_owned()]);
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            found.extend(files(&entry.path())?);
        }
    }
    found.sort();
    Ok(found)
}

/// The entries of a lock file that matter.
fn versions(lock: &str) -> String {
    let named = |entry: &&str| {
        let mut names = PACKAGES.iter().map(|name| format!("name = \"{name}"));
        names.any(|name| entry.contains(&name))
    };
    lock.split("[[package]]").filter(named).collect()
}
