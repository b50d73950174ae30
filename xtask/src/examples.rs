//! The examples whose generated packages are checked in: those with a `Cargo.toml`, which says what is read and written.

use std::fs;
use std::path::PathBuf;

use ahv_generate::{Args, Surroundings};
use clap::Parser as _;

use crate::shell;

const FOLDER: &str = "examples";

/// The command line of `ahv generate`.
#[derive(clap::Parser)]
struct GenerateLine {
    #[command(flatten)]
    args: Args,
}

/// Generates every such package, or only checks that it is what its tables give.
pub(crate) fn run(check: bool) -> Result<(), String> {
    for folder in folders()? {
        println!("{}", folder.display());
        let surroundings = Surroundings::of_process().map_err(|it| it.to_string())?;
        let surroundings = Surroundings {
            current_dir: folder,
            ..surroundings
        };
        let line = ["generate"].into_iter().chain(check.then_some("--check"));
        let args = GenerateLine::parse_from(line).args;
        if check {
            let checked = ahv_generate::check(&args, &surroundings).map_err(|it| it.to_string())?;
            if !checked.agrees() {
                return Err(checked.text());
            }
        } else {
            ahv_generate::generate(&args, &surroundings).map_err(|it| it.to_string())?;
        }
    }
    Ok(())
}

fn folders() -> Result<Vec<PathBuf>, String> {
    let unreadable = |error| format!("error: cannot read {FOLDER}: {error}");
    let entries = fs::read_dir(shell::root().join(FOLDER)).map_err(unreadable)?;
    let mut folders = Vec::new();
    for entry in entries {
        let folder = entry.map_err(unreadable)?.path();
        if folder.join("Cargo.toml").is_file() {
            folders.push(folder);
        }
    }
    folders.sort();
    Ok(folders)
}
