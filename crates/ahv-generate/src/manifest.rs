//! The manifest on disk: what ahv wrote there before, whatever became of the manifest since.

use std::path::Path;

use ahv_codegen::Manifest;

use crate::args::{Args, Language};
use crate::failure::Failure;
use crate::files;
use crate::project::Project;

/// Says from what the tree was made, and what was written.
pub(crate) const MANIFEST: &str = "manifest.json";

/// The manifest of a tree, if it can be read.
pub(crate) fn whole(out: &Path) -> Option<Manifest> {
    let bytes = files::read(&out.join(MANIFEST)).ok()?;
    Manifest::parse(std::str::from_utf8(&bytes).ok()?).ok()
}

/// The manifests of ahv that the file holds: one, both sides of a merge conflict, or none.
pub(crate) fn on_disk(out: &Path) -> Vec<Manifest> {
    let bytes = files::read(&out.join(MANIFEST)).unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    let sides = sides(&text);
    let parsed = sides.iter().filter_map(|side| Manifest::parse(side).ok());
    parsed.collect()
}

/// Refuses a folder that holds models in another language: its files would be removed or overwritten.
pub(crate) fn refuse_other_language(args: &Args, project: &Project) -> Result<(), Failure> {
    let own = args.target().language();
    let written = on_disk(&project.out);
    let Some(other) = written.iter().find(|it| it.language.as_deref() != own) else {
        return Ok(());
    };
    let found = match other.language.as_deref() {
        None => Language::Rust.shown().to_owned(),
        Some("c") => Language::C.shown().to_owned(),
        // Whatever stands there must not act on a terminal.
        Some(other) => format!("{other:?}"),
    };
    Err(Failure::new(format!(
        "{} holds models in {found}; models in {} need a folder of their own",
        project.shown(&project.out),
        args.target.shown()
    ))
    .with_help("name another folder with --out, or another language with --target"))
}

/// What git merged: the text with one side of each conflict, then with the other.
fn sides(text: &str) -> [String; 2] {
    let mut sides = [String::new(), String::new()];
    let mut kept = [true, true];
    for line in text.lines() {
        if line.starts_with("<<<<<<<") {
            kept = [true, false];
        } else if line.starts_with("|||||||") {
            // What both sides had before.
            kept = [false, false];
        } else if line == "=======" {
            kept = [false, true];
        } else if line.starts_with(">>>>>>>") {
            kept = [true, true];
        } else {
            for (side, _) in sides.iter_mut().zip(kept).filter(|(_, kept)| *kept) {
                side.push_str(line);
                side.push('\n');
            }
        }
    }
    sides
}
