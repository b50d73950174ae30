//! A project in a temporary folder, with the tables and the generated package of this repository,
//! and an interpreter that stands in for Python: it answers with the IR that is checked in, or
//! with what a test gives it. The real derivation is tested by `xtask`.

use std::ffi::OsString;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use ahv_generate::{Args, Checked, Failure, Generated, Surroundings};
use clap::Parser as _;
use tempfile::TempDir;

/// Holds the command line of a process.
pub(crate) const LINE: &str = "AHV_TEST_LINE";

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[derive(clap::Parser)]
struct Line {
    #[command(flatten)]
    args: Args,
}

/// The command line of `ahv generate`.
pub(crate) fn args(line: &[&str]) -> Args {
    Line::parse_from([&["generate"], line].concat()).args
}

/// A project of its own.
pub(crate) struct Scratch {
    folder: TempDir,
    python: OsString,
}

impl Scratch {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let repository = Path::new(REPOSITORY);
        for part in ["generator/tables", "generated"] {
            copy(
                &repository.join(part),
                &folder.path().join("project").join(part),
            );
        }
        copy(&repository.join("generated/ir"), &folder.path().join("ir"));
        let derive = format!("cp {}/*.json \"$8\"", folder.path().join("ir").display());
        let mut scratch = Self {
            folder,
            python: OsString::new(),
        };
        scratch.python = scratch.interpreter("3 11", "", &derive);
        scratch
    }

    /// Without the largest table, and so a few times faster.
    pub(crate) fn small() -> Self {
        let scratch = Self::new();
        for file in ["generator/tables/dcom.toml", "../ir/audit.json"] {
            fs::remove_file(scratch.path(file)).expect("removed");
        }
        scratch.generate(&[]).expect("generated");
        scratch
    }

    /// A script that says it is a Python of that version without these modules, and derives so.
    pub(crate) fn interpreter(&self, version: &str, missing: &str, derive: &str) -> OsString {
        let path = self.folder.path().join("python");
        let probe =
            format!("if [ \"$2\" = -c ]; then echo '{version}'; echo '{missing}'; exit; fi");
        fs::write(&path, format!("#!/bin/sh\n{probe}\n{derive}\n")).expect("written");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
        path.into()
    }

    pub(crate) fn use_python(&mut self, python: impl Into<OsString>) {
        self.python = python.into();
    }

    pub(crate) fn python(&self) -> OsString {
        self.python.clone()
    }

    pub(crate) fn path(&self, relative: &str) -> PathBuf {
        self.folder.path().join("project").join(relative)
    }

    pub(crate) fn read(&self, relative: &str) -> String {
        fs::read_to_string(self.path(relative)).expect("a text file")
    }

    pub(crate) fn write(&self, relative: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(relative), text).expect("written");
    }

    pub(crate) fn edit(&self, relative: &str, from: &str, to: &str) {
        let text = self.read(relative);
        assert!(text.contains(from), "{relative} has no {from:?}");
        self.write(relative, text.replacen(from, to, 1));
    }

    /// Lists a file in the manifest as one that ahv wrote as it is now.
    pub(crate) fn list(&self, file: &str) {
        let hash = ahv_codegen::sha256(&self.read(&format!("generated/{file}")));
        self.edit(
            "generated/manifest.json",
            "\"files\": {\n",
            &format!("\"files\": {{\n    {file:?}: {hash:?},\n"),
        );
    }

    pub(crate) fn make_pipe(&self, relative: &str) {
        let made = Command::new("mkfifo").arg(self.path(relative)).status();
        assert!(made.expect("mkfifo runs").success());
    }

    /// This test program as a process of its own that generates here; its temporary files lie in `temporary`.
    pub(crate) fn process(&self, line: &[&str]) -> Command {
        let mut command = Command::new(env::current_exe().expect("a program"));
        let temporary = self.path("temporary");
        fs::create_dir_all(&temporary).expect("made");
        command
            .args(["--exact", "process::generate_in_a_process", "--nocapture"])
            .current_dir(self.path(""))
            .env(LINE, line.join(" "))
            .env("AHV_PYTHON", &self.python)
            .env("AHV_CACHE_DIR", self.folder.path().join("cache"))
            .env("TMPDIR", temporary);
        command
    }

    fn surroundings(&self) -> Surroundings {
        Surroundings {
            current_dir: self.path(""),
            python: Some(self.python.clone()),
            cache: Some(self.folder.path().join("cache")),
        }
    }

    pub(crate) fn generate(&self, line: &[&str]) -> Result<Generated, Failure> {
        ahv_generate::generate(&args(line), &self.surroundings())
    }

    pub(crate) fn check(&self, line: &[&str]) -> Result<Checked, Failure> {
        ahv_generate::check(&args(&[&["--check"], line].concat()), &self.surroundings())
    }

    /// Paths and contents below a folder of the project, hidden files too.
    pub(crate) fn snapshot(&self, relative: &str) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        collect(&self.path(relative), &mut files);
        files.sort();
        files
    }

    /// What `generate` fails with where it derives. The tree must be as it was.
    #[track_caller]
    pub(crate) fn refusal(&self) -> String {
        self.refusal_of(&["--derive"])
    }

    #[track_caller]
    pub(crate) fn refusal_of(&self, line: &[&str]) -> String {
        let before = self.snapshot("generated");
        let failure = self
            .generate(line)
            .err()
            .expect("generate must fail")
            .to_string();
        assert!(
            before == self.snapshot("generated"),
            "the tree changed: {failure}"
        );
        failure
    }

    /// The text of a check that finds differences.
    #[track_caller]
    pub(crate) fn disagreement(&self, line: &[&str]) -> String {
        let checked = self.check(line).expect("the check can be done");
        assert!(!checked.agrees(), "tree and tables agree");
        checked.text()
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("readable") {
        let path = entry.expect("readable").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).expect("copied");
        }
    }
}

fn collect(folder: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            let bytes = fs::read(&path).expect("readable");
            files.push((path, bytes));
        }
    }
}
