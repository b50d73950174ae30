//! Runs the real binary in a folder of its own.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use crate::command::{self, stderr};

/// A short run of the DCOM.
pub(crate) const DCOM: [&str; 1] = ["--model dcom --t-end 0.5 --dt 0.01"];

/// A folder with the file that a run is to write.
pub(crate) struct Bench {
    pub(crate) folder: TempDir,
    pub(crate) out: PathBuf,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("run.csv");
        Self { folder, out }
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let (line, others) = arguments.split_first().expect("a word");
        let line = format!("simulate {line}");
        let mut command = command::command(&[&[line.as_str()], others].concat());
        command.arg("--out").arg(&self.out);
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("ahv starts")
    }

    pub(crate) fn succeed(&self, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        output
    }

    /// Runs, expecting failure with `code` and all of `words` on stderr.
    pub(crate) fn fail(&self, arguments: &[&str], code: i32, words: &[&str]) {
        let output = self.run(arguments);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        for word in words {
            assert!(
                message.contains(word),
                "{arguments:?}: no {word:?} in: {message}"
            );
        }
        assert!(!message.contains("panicked"), "{message}");
        assert!(output.stdout.is_empty());
    }

    pub(crate) fn text(&self) -> String {
        fs::read_to_string(&self.out).expect("the file is there")
    }

    pub(crate) fn rows(&self) -> Vec<Vec<f64>> {
        let number = |cell: &str| cell.parse::<f64>().expect("a number");
        self.text()
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(number).collect())
            .collect()
    }

    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder is there");
        entries
            .map(|e| {
                e.expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect()
    }
}

pub(crate) fn with<'a>(base: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [base, more].concat()
}

pub(crate) fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("JSON on stdout")
}
