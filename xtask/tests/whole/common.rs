//! Copies of this repository's tables and generated package to break, and the program to run there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use ahv_generate::Surroundings;
use tempfile::TempDir;

/// What a program answered.
pub(crate) struct Answer {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// A project to break.
pub(crate) struct Scratch {
    /// Removed at the end.
    folder: TempDir,
}

impl Scratch {
    /// The tables and the generated package, in a temporary folder.
    pub(crate) fn new() -> Self {
        Self::of(&["generator/tables", "generated"])
    }

    /// These parts of the repository.
    pub(crate) fn of(parts: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for part in parts {
            copy(&repository().join(part), &folder.path().join(part));
        }
        Self { folder }
    }

    pub(crate) fn path(&self, relative: &str) -> PathBuf {
        self.folder.path().join(relative)
    }

    pub(crate) fn edit(&self, relative: &str, from: &str, to: &str) {
        let path = self.path(relative);
        let text = fs::read_to_string(&path).expect("a text file");
        assert!(text.contains(from), "{relative} has no {from:?}");
        fs::write(&path, text.replacen(from, to, 1)).expect("written");
    }

    /// All files of the generated package, hidden ones too.
    pub(crate) fn snapshot(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let mut files = Vec::new();
        collect(&self.path("generated"), &mut files);
        files.sort();
        files
    }

    /// `cargo xtask generate`, in an own environment of ahv's.
    pub(crate) fn command(&self, line: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command
            .arg("generate")
            .args(line)
            .current_dir(&self.folder)
            .env_remove("AHV_PYTHON");
        command
    }

    pub(crate) fn generate(&self, line: &[&str]) -> Answer {
        answer(&mut self.command(line))
    }
}

pub(crate) fn answer(command: &mut Command) -> Answer {
    let output = command.output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    Answer {
        code: output.status.code().expect("an exit code"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// The folder of this repository.
pub(crate) fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("a parent")
}

/// The interpreter of generation's own environment.
pub(crate) fn generation_python() -> PathBuf {
    let requirements = repository().join("generator/requirements.txt");
    let requirements = fs::read_to_string(requirements).expect("a text file");
    let surroundings = Surroundings::of_process().expect("a cache folder");
    ahv_generate::environment("generation", &requirements, &surroundings).expect("set up")
}

/// Copies a file or a folder, and what links lead to, with the times that cargo goes by.
pub(crate) fn copy(from: &Path, to: &Path) {
    if from.is_file() {
        fs::create_dir_all(to.parent().expect("a parent")).expect("a folder");
        fs::copy(from, to).expect("copied");
        let changed = fs::metadata(from).and_then(|metadata| metadata.modified());
        let copy = fs::File::options().write(true).open(to).expect("opened");
        copy.set_modified(changed.expect("a time")).expect("set");
        return;
    }
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("readable") {
        let path = entry.expect("readable").path();
        let name = path.file_name().expect("a name");
        if name != "target" && name != "__pycache__" {
            copy(&path, &to.join(name));
        }
    }
}

fn collect(folder: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) {
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            let bytes = fs::read(&path).expect("readable");
            files.push((path, bytes));
        }
    }
}
