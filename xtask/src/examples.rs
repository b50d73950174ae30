//! The examples whose generated packages are checked in: those with a `Cargo.toml`, which says what is read and written.

use std::path::PathBuf;
use std::{env, fs};

use ahv_generate::{AGREES, Args, DIFFERS, FAILED, Failure, Surroundings};

use crate::shell;

const FOLDER: &str = "examples";
/// With these the command line is about all that is checked in, and not about another folder or another form.
const OF_ALL: [&str; 3] = ["--check", "--from-ir", "--derive"];

/// Generates the models of this repository, or checks them, and then those of the examples; returns the exit code.
pub(crate) fn generate(args: &Args) -> u8 {
    match ahv_generate::run(args) {
        AGREES if is_of_all() => each(args).unwrap_or_else(|problem| {
            eprintln!("{problem}");
            FAILED
        }),
        code => code,
    }
}

fn is_of_all() -> bool {
    // The name of the program, and that of the command.
    let mut flags = env::args().skip(2);
    let at_root = env::current_dir().is_ok_and(|it| it == shell::root());
    at_root && flags.all(|flag| OF_ALL.contains(&flag.as_str()))
}

fn each(args: &Args) -> Result<u8, String> {
    let failed = |failure: Failure| failure.render();
    for folder in folders()? {
        println!("{}:", folder.display());
        let surroundings = Surroundings {
            current_dir: folder,
            ..Surroundings::of_process().map_err(failed)?
        };
        if args.check {
            let checked = ahv_generate::check(args, &surroundings).map_err(failed)?;
            print!("{}", checked.text());
            if !checked.agrees() {
                return Ok(DIFFERS);
            }
        } else {
            let generated = ahv_generate::generate(args, &surroundings).map_err(failed)?;
            print!("{}", generated.text());
        }
    }
    Ok(AGREES)
}

fn folders() -> Result<Vec<PathBuf>, String> {
    let unreadable = |error| format!("error: cannot read {FOLDER}: {error}");
    let mut folders = Vec::new();
    for entry in fs::read_dir(shell::root().join(FOLDER)).map_err(unreadable)? {
        let folder = entry.map_err(unreadable)?.path();
        if folder.join("Cargo.toml").is_file() {
            folders.push(folder);
        }
    }
    folders.sort();
    Ok(folders)
}
