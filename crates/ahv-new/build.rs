//! Embeds what a new repository starts from: the examples, the tables of the built-in families, and the versions of this
//! workspace's lock file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    // `starts/` holds links; cargo package copies what they lead to.
    let mut list = String::from("&[\n");
    let examples = fs::canonicalize("starts/examples")?;
    println!("cargo::rerun-if-changed={}", examples.display());
    for folder in entries(&examples)? {
        if folder.is_dir() {
            start(&mut list, "Example", &name(&folder), &entries(&folder)?)?;
        }
    }
    let tables = fs::canonicalize("starts/tables")?;
    println!("cargo::rerun-if-changed={}", tables.display());
    for table in entries(&tables)? {
        let family = name(&table);
        if let Some(family) = family.strip_suffix(".toml") {
            start(&mut list, "Family", family, std::slice::from_ref(&table))?;
        }
    }
    list.push(']');

    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets no OUT_DIR"))?;
    fs::write(Path::new(&out).join("starts.rs"), list)
}

/// Adds a start with its tables and Python files; a folder without a table is none.
fn start(list: &mut String, kind: &str, start: &str, files: &[PathBuf]) -> io::Result<()> {
    let is = |file: &PathBuf, extension: &str| {
        file.extension().is_some_and(|it| it == extension) && name(file) != "Cargo.toml"
    };
    if !files.iter().any(|file| is(file, "toml")) {
        return Ok(());
    }
    let mut text = format!("    (Kind::{kind}, {start:?}, &[\n");
    for file in files {
        if is(file, "toml") || is(file, "py") {
            let (name, path) = (name(file), file.display().to_string());
            writeln!(text, "        ({name:?}, include_str!({path:?})),")
                .map_err(io::Error::other)?;
        }
    }
    writeln!(list, "{text}    ]),").map_err(io::Error::other)
}

/// What a folder holds, in an order that does not depend on the file system.
fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?;
    let mut paths = entries
        .map(|entry| entry.map(|it| it.path()))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
