//! Embeds the Python package that derives the models, so that an installed `ahv` needs no checkout.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    // `python/` holds links into `generator/`; cargo package copies what they lead to.
    let package = fs::canonicalize("python/ahv_generator")?;
    println!("cargo::rerun-if-changed={}", package.display());

    let mut list = String::from("&[\n");
    for file in modules(&package)? {
        let name = file.strip_prefix(&package).map_err(io::Error::other)?;
        let name = name.display().to_string().replace('\\', "/");
        let path = file.display().to_string();
        writeln!(list, "    ({name:?}, include_str!({path:?})),").map_err(io::Error::other)?;
    }
    list.push(']');

    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets no OUT_DIR"))?;
    fs::write(Path::new(&out).join("modules.rs"), list)
}

/// The package's own files, in an order that does not depend on the file system.
fn modules(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            files.extend(modules(&path)?);
        } else if name.ends_with(".py") || name == "py.typed" {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
