//! The command line, shared by `ahv generate` and `cargo xtask generate`.

use std::path::PathBuf;

use ahv_codegen::ir::UnitSystem;
use ahv_codegen::{Core, Pass, Target};

use crate::failure::Failure;
use crate::settings::{Settings, package_name};

const PACKAGE: &str = "ahv-models";
const CORE_PATH: &str = "../crates/ahv-core";

/// Derive the models from the tables and write them as Rust or C.
///
/// `[workspace.metadata.ahv]` of a Cargo.toml may give --tables, --out, --package, --core-path and --core-workspace.
///
/// Exit code: 0 done (or, with --check, tree and tables agree), 1 they differ or an audit fails, 2 bad input.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Write nothing; compare the tree on disk with what the tables give
    #[arg(long)]
    pub check: bool,

    /// Check against the IR in the tree instead of deriving again: needs no Python
    #[arg(long, requires = "check")]
    pub from_ir: bool,

    /// Derive and emit everything again, also what the hashes in the manifest vouch for
    #[arg(long, conflicts_with = "check")]
    pub derive: bool,

    /// Generate whenever a table is saved, until Ctrl-C
    #[arg(long, conflicts_with_all = ["check", "json"])]
    pub watch: bool,

    /// Folder of the tables [default: generator/tables in the project]
    #[arg(long, value_name = "DIR")]
    pub tables: Option<PathBuf>,

    /// Folder of the generated package [default: generated in the project]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Name of the generated package; for Rust [default: ahv-models]
    #[arg(long, value_name = "NAME", value_parser = package_name)]
    pub package: Option<String>,

    /// Where the generated package finds ahv-core, relative to itself; for Rust [default: ../crates/ahv-core]
    #[arg(long, value_name = "PATH")]
    pub core_path: Option<String>,

    /// Take ahv-core from the workspace around the generated package, whose Cargo.toml says where it comes from; for Rust
    #[arg(long, conflicts_with = "core_path")]
    pub core_workspace: bool,

    /// Language of the models: a Rust crate, or a C99 library with the same bits [default folder: generated/c]
    #[arg(long, value_name = "LANGUAGE", value_enum, default_value_t = Language::Rust)]
    pub target: Language,

    /// Unit system of the models: ft-slug-s-rad or si [default: that of the tables]
    #[arg(long, value_name = "SYSTEM")]
    pub units: Option<UnitSystem>,

    /// Leave a pass of the emitter out, to see what it does; may be repeated. Such a tree fails --check
    #[arg(long, value_name = "NAME", conflicts_with = "check")]
    pub without_pass: Vec<Pass>,

    /// Then compare the models with 50-digit arithmetic at N random points each
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(conflicts_with_all = ["watch", "from_ir", "json", "units"])]
    pub audit: Option<u32>,

    /// Print the result as JSON
    #[arg(long)]
    pub json: bool,
}

/// A language that models are generated in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Language {
    /// A Rust crate, with documentation.
    Rust,
    /// A C99 library.
    C,
}

impl Language {
    /// The language as people write it.
    pub(crate) fn shown(self) -> &'static str {
        match self {
            Self::Rust => "Rust",
            Self::C => "C",
        }
    }

    /// The folder of the generated files in a project.
    pub(crate) fn folder(self) -> &'static str {
        match self {
            Self::Rust => "generated",
            Self::C => "generated/c",
        }
    }

    /// The same below the project's own folder `out`.
    pub(crate) fn folder_below(self, out: &str) -> String {
        match self {
            Self::Rust => out.to_owned(),
            Self::C => format!("{out}/c"),
        }
    }
}

impl Args {
    /// The language for the emitter.
    pub(crate) fn target(&self) -> Target {
        match self.target {
            Language::Rust => Target::Rust,
            Language::C => Target::C,
        }
    }

    /// Refuses what a C library does not have.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let of_rust = [
            ("--package", self.package.is_some()),
            ("--core-path", self.core_path.is_some()),
            ("--core-workspace", self.core_workspace),
        ];
        let given = of_rust.into_iter().find(|(_, is_given)| *is_given);
        match given {
            Some((flag, _)) if self.target == Language::C => Err(Failure::new(format!(
                "{flag} describes a Rust package, and --target c writes a C library"
            ))
            .with_help(format!("leave {flag} out"))),
            _ => Ok(()),
        }
    }

    /// Name of the generated package.
    pub(crate) fn package(&self, settings: &Settings) -> String {
        let package = self.package.as_ref().or(settings.package.as_ref());
        package.map_or(PACKAGE, String::as_str).to_owned()
    }

    /// Where the generated package finds ahv-core. A flag takes precedence over the project's settings.
    pub(crate) fn core(&self, settings: &Settings) -> Core {
        let flags = self.core_workspace || self.core_path.is_some();
        let (by_workspace, path) = if flags {
            (self.core_workspace, self.core_path.as_deref())
        } else {
            (settings.core_workspace, settings.core_path.as_deref())
        };
        if by_workspace {
            Core::Workspace
        } else {
            Core::Path(path.unwrap_or(CORE_PATH).to_owned())
        }
    }

    /// The command that brings the tree up to date: that of the project, with the flags that this one was given.
    pub(crate) fn mending_command(&self, command: &str) -> String {
        let mut command = command.to_owned();
        let mut flag = |name: &str, value: &str| {
            command.push_str(&format!(" {name} {}", quoted(value)));
        };
        if self.target == Language::C {
            flag("--target", "c");
        }
        if let Some(tables) = &self.tables {
            flag("--tables", &tables.to_string_lossy());
        }
        if let Some(out) = &self.out {
            flag("--out", &out.to_string_lossy());
        }
        if let Some(package) = &self.package {
            flag("--package", package);
        }
        if let Some(units) = self.units {
            flag("--units", units.name());
        }
        if self.core_workspace {
            command.push_str(" --core-workspace");
        } else if let Some(path) = &self.core_path {
            flag("--core-path", path);
        }
        command
    }
}

/// Quotes what a shell would take apart, so that the command can be pasted.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:\\+=,@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::{Args, quoted};
    use clap::Parser as _;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    fn parse(line: &[&str]) -> Result<Args, String> {
        let line = Line::try_parse_from([&["generate"], line].concat());
        line.map(|line| line.args)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_pass_that_there_is_not_is_answered_with_those_there_are() {
        let message = parse(&["--without-pass", "horner"]).unwrap_err();
        assert!(
            message.contains("there is no pass `horner`; there are hash-consing,"),
            "{message}"
        );
    }

    #[test]
    fn a_check_is_always_one_of_all_passes() {
        let message = parse(&["--check", "--without-pass", "estrin"]).unwrap_err();
        assert!(message.contains("cannot be used with"), "{message}");
    }

    #[test]
    fn watching_goes_with_no_check_and_no_json() {
        for other in ["--check", "--json"] {
            let message = parse(&["--watch", other]).unwrap_err();
            assert!(
                message.contains("'--watch' cannot be used with"),
                "{message}"
            );
        }
    }

    #[test]
    fn a_command_survives_the_shell() {
        assert_eq!(quoted("../a/b.toml"), "../a/b.toml");
        assert_eq!(quoted("my tables"), "'my tables'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
