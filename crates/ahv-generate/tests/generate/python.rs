//! Interpreters that cannot derive: each says what is the matter and what to do.

use crate::scratch::Scratch;

#[test]
fn an_interpreter_that_is_not_there() {
    let mut scratch = Scratch::new();
    scratch.use_python("/nowhere/python");
    let message = scratch.refusal();
    assert!(
        message.starts_with("error: AHV_PYTHON names \"/nowhere/python\""),
        "{message}"
    );
    assert!(
        message.contains("No such file") && message.contains("unset AHV_PYTHON"),
        "{message}"
    );
}

#[test]
fn an_interpreter_that_is_too_old() {
    let mut scratch = Scratch::new();
    scratch.use_python(scratch.interpreter("3 9", "casadi pint", "exit 1"));
    let message = scratch.refusal();
    assert!(
        message.contains("which is Python 3.9; generation needs 3.11"),
        "{message}"
    );
}

#[test]
fn an_interpreter_without_casadi() {
    let mut scratch = Scratch::new();
    scratch.use_python(scratch.interpreter("3 12", "casadi", "exit 1"));
    let message = scratch.refusal();
    assert!(message.contains("which has no casadi\n"), "{message}");
    assert!(message.contains("casadi and pint"), "{message}");
}

#[test]
fn a_program_that_is_no_python() {
    let mut scratch = Scratch::new();
    scratch.use_python("/bin/echo");
    assert!(scratch.refusal().contains("it is no Python"));
    scratch.use_python("/bin/false");
    assert!(
        scratch
            .refusal()
            .contains("which cannot be run: exit status: 1")
    );
}
