//! `ahv new`: a repository for a vehicle that stands alone. It holds tables, their family, the generated models, a program of
//! three lines with every command, a test, a guard for CI and pre-commit, and a README that explains them.
//!
//! May depend on `ahv-generate`, which makes the models; knows no model. Start reading at [`create`]: `start` says what
//! a repository starts from, `origin` where its `ahv` comes from, `name` what it may be called, `repository` has the files.
//!
//! It is a crate of its own because it embeds the tables: `ahv-generate` must not be built again when a table changes.
//!
//! ```
//! use clap::Parser;
//!
//! #[derive(Parser)]
//! struct Line {
//!     #[command(flatten)]
//!     new: ahv_new::Args,
//! }
//!
//! // A folder that holds something is nobody's to overwrite.
//! let taken = env!("CARGO_MANIFEST_DIR");
//! let line = Line::parse_from(["new", taken, "--example", "van-der-pol", "--ahv", "."]);
//! assert_eq!(ahv_new::run(&line.new), 2);
//! ```
#![forbid(unsafe_code)]

mod name;
mod origin;
mod place;
mod repository;
mod start;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

pub use ahv_generate::Failure;
use ahv_generate::Surroundings;

use name::Name;
use origin::Origin;
use place::Place;
use start::Start;

/// Create a repository for a vehicle of your own, with its models generated: ready to build, trim, fly and test.
///
/// Nothing is overwritten: the folder must not exist, or be empty. Needs Python 3.11 or newer, as `generate` does.
/// Exit code: 0 done, 2 refused or failed; then nothing was written.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Folder of the new repository
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,

    /// Start from an example [default: winged-cone]
    #[arg(long, value_name = "NAME", conflicts_with = "family")]
    pub example: Option<String>,

    /// Start from a family: a built-in one (com, dcom, flexible_mode) with its table, or a Python file of your own
    #[arg(long, value_name = "NAME|FILE")]
    pub family: Option<String>,

    /// Table of the family's Python file [default: the file of the same name that ends in .toml]
    #[arg(long, value_name = "FILE", requires = "family")]
    pub table: Option<PathBuf>,

    /// Name of the package and the program [default: name of the folder]
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,

    /// Where ahv comes from: a folder with its repository, or the URL of a git repository (then with --rev)
    #[arg(long, value_name = "PATH|GIT-URL")]
    pub ahv: String,

    /// Revision of ahv in the git repository
    #[arg(long, value_name = "REVISION")]
    pub rev: Option<String>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Created {
    /// The folder, as it was given.
    pub dir: PathBuf,
    /// Every file in it, relative to it, with `/`, in order.
    pub files: Vec<String>,
}

/// Does what the command line asks for, prints what was written, and returns the exit code.
#[must_use]
pub fn run(args: &Args) -> u8 {
    let surroundings = ahv_generate::listen().and_then(|()| Surroundings::of_process());
    let created = surroundings.and_then(|surroundings| create(args, &surroundings));
    match created {
        Ok(created) => {
            // A reader that has gone away is no failure: the repository is there.
            if !ahv_generate::is_quiet() {
                let _ = io::stdout().write_all(created.text().as_bytes());
            }
            ahv_generate::AGREES
        }
        Err(failure) => {
            let _ = io::stderr().write_all(failure.render().as_bytes());
            failure.exit_code()
        }
    }
}

/// Makes the repository beside its place and moves it there when it is whole.
///
/// # Errors
/// A place that is not free, a name or a start that is not valid, no usable Python, faults of a table or a family, a file
/// that cannot be written, a signal. Nothing is left then.
pub fn create(args: &Args, surroundings: &Surroundings) -> Result<Created, Failure> {
    let dir = surroundings.current_dir.join(&args.dir);
    let place = Place::check(&dir, &args.dir)?;
    let name = Name::check(args.name.as_deref(), &place)?;
    let start = Start::find(args, &surroundings.current_dir)?;
    let origin = Origin::find(args, &surroundings.current_dir, &place)?;

    let stage = place.stage()?;
    let files = repository::write(stage.folder(), &name, &start, &origin, surroundings)?;
    stage.move_to(&place)?;
    Ok(Created {
        dir: args.dir.clone(),
        files,
    })
}

impl Created {
    /// What people read.
    fn text(&self) -> String {
        let dir = self.dir.display();
        let mut text = format!("created {dir}: {} files\n", self.files.len());
        for file in &self.files {
            text.push_str(&format!("  {file}\n"));
        }
        text.push_str(&format!(
            "\nREADME.md explains the repository. Next: cd {dir}; git init; git add .; git commit -m \"New vehicle\"; cargo test\n"
        ));
        text
    }
}

/// A path's text with `/` on every platform.
fn slashed(path: &Path) -> String {
    let text = path.to_string_lossy();
    if cfg!(windows) {
        text.replace('\\', "/")
    } else {
        text.into_owned()
    }
}
