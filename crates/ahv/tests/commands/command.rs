//! Runs the real binary.

use std::process::{Command, Output};

use serde_json::Value;

/// `ahv` with these words; the first text may be several, with blanks between them.
pub(crate) fn command(words: &[&str]) -> Command {
    let (line, others) = words.split_first().expect("a word");
    let mut command = Command::new(env!("CARGO_BIN_EXE_ahv"));
    command.args(line.split_whitespace()).args(others);
    command
}

/// Runs `ahv` with [`command`]'s words.
pub(crate) fn ahv(words: &[&str]) -> Output {
    command(words).output().expect("ahv starts")
}

/// The JSON of a run that succeeds.
pub(crate) fn json(words: &[&str]) -> Value {
    let output = ahv(&[words, &["--json"]].concat());
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
    serde_json::from_slice(&output.stdout).expect("JSON on stdout")
}

/// The text of a run that succeeds.
pub(crate) fn text(words: &[&str]) -> String {
    let output = ahv(words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Runs, expecting failure with `code` and all of `parts` on stderr.
pub(crate) fn fail(words: &[&str], code: i32, parts: &[&str]) -> Output {
    let output = ahv(words);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{words:?}: {message}");
    for part in parts {
        assert!(
            message.contains(part),
            "{words:?}: no {part:?} in: {message}"
        );
    }
    assert!(!message.contains("panicked"), "{message}");
    assert!(code != 2 || output.stdout.is_empty(), "{words:?}");
    output
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A number that must be there.
pub(crate) fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is a number"))
}

/// Numbers that must be there.
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    let list = value
        .as_array()
        .unwrap_or_else(|| panic!("{value} is a list"));
    list.iter().map(number).collect()
}
