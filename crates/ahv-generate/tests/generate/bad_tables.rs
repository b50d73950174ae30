//! Tables that cannot be used: one clear message with file, line and column, and an unchanged tree.

use crate::scratch::Scratch;
use std::fs;

const COM: &str = "generator/tables/com.toml";

#[test]
fn text_that_is_not_toml() {
    let scratch = Scratch::new();
    scratch.edit(COM, "\"alpha\" = {", "\"alpha\" = [");
    let message = scratch.refusal();
    let line = 1 + scratch
        .read(COM)
        .lines()
        .position(|line| line.contains("\"alpha\" = ["))
        .expect("there");
    assert!(
        message.contains(&format!("generator/tables/com.toml:{line}:")),
        "{message}"
    );
    assert!(message.contains("\"alpha\" = ["), "{message}");
    assert!(
        message.starts_with("error:") || message.starts_with("  error:"),
        "{message}"
    );
}

/// A line that nobody could read is cut about the place; line and column are those of the whole.
#[test]
fn a_line_without_end_is_cut() {
    let scratch = Scratch::new();
    let long = format!("[C_L] # {}", "x".repeat(1_000_000));
    scratch.edit(COM, "[C_L]", &long);
    let comment = format!(
        "\"alpha\" = {{ unit = \"{}\", unit = 1 }} # ",
        "y".repeat(1_000_000)
    );
    scratch.edit(COM, "\"alpha\" = {", &format!("{comment}{{"));
    let message = scratch.refusal();
    assert!(
        message.len() < 2000 && message.contains("yyy...") | message.contains("...yyy"),
        "{message}"
    );
    let column = comment.find("unit = 1").expect("there") + 1;
    let lines = scratch.read(COM);
    let line = 1 + lines
        .lines()
        .position(|line| line.starts_with("\"alpha\" = { unit"))
        .expect("there");
    assert!(
        message.contains(&format!("com.toml:{line}:{column}]")),
        "{message}"
    );
}

#[test]
fn an_entry_that_stands_twice() {
    let scratch = Scratch::new();
    scratch.edit(
        COM,
        "[C_L]\n\"alpha\"",
        "[C_L]\n\"alpha\" = { value = 1.0, unit = \"1/rad\" }\n\"alpha\"",
    );
    let message = scratch.refusal();
    assert!(message.contains("duplicate key"), "{message}");
    let line = 3 + scratch
        .read(COM)
        .lines()
        .position(|line| line == "[C_L]")
        .expect("there");
    assert!(message.contains(&format!("com.toml:{line}:1")), "{message}");
}

#[test]
fn all_faulty_tables_are_named() {
    let scratch = Scratch::new();
    scratch.edit(COM, "[C_L]", "[C_L");
    scratch.edit("generator/tables/dcom.toml", "[C_D]", "[C_D");
    let message = scratch.refusal();
    assert!(
        message.contains("com.toml:") && message.contains("dcom.toml:"),
        "{message}"
    );
}

#[test]
fn bytes_that_are_not_text() {
    let scratch = Scratch::new();
    scratch.write(COM, b"[table]\nname = \"\xff\"\n");
    let message = scratch.refusal();
    assert!(
        message.contains("not UTF-8") && message.contains("com.toml:2:9"),
        "{message}"
    );
}

#[test]
fn a_file_that_cannot_be_read() {
    // A folder, for permissions do not bind whoever runs tests as root.
    let scratch = Scratch::new();
    fs::remove_file(scratch.path(COM)).expect("removed");
    fs::create_dir(scratch.path(COM)).expect("made");
    let message = scratch.refusal();
    assert!(
        message.starts_with("error: cannot read generator/tables/com.toml: "),
        "{message}"
    );
}

#[test]
fn the_package_does_not_go_among_the_tables() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generator/tables");
    let refused = scratch.generate(&["--out", "generator/tables"]).err();
    let message = refused.expect("refused").to_string();
    assert!(message.contains("needs a folder of its own"), "{message}");
    assert!(before == scratch.snapshot("generator/tables"));
}

/// A pipe has no end until somebody writes to it: whoever reads it waits.
#[test]
fn a_pipe_is_no_table() {
    let scratch = Scratch::new();
    fs::remove_file(scratch.path(COM)).expect("removed");
    scratch.make_pipe(COM);
    let message = scratch.refusal();
    assert!(
        message.starts_with("error: cannot read generator/tables/com.toml: it is a pipe"),
        "{message}"
    );
}

#[test]
fn a_text_of_a_table_does_not_act_on_a_terminal() {
    let scratch = Scratch::new();
    let hostile = "[C_L # \u{1b}[2J\u{85}\u{202e}";
    scratch.edit(COM, "[C_L]", hostile);
    let message = scratch.refusal();
    assert!(message.contains("[C_L # ?[2J\u{bf}\u{fffd}"), "{message}");
    assert!(
        !message.contains(['\u{1b}', '\u{85}', '\u{202e}']),
        "{message}"
    );
}

#[test]
fn no_tables() {
    let scratch = Scratch::new();
    fs::remove_dir_all(scratch.path("generator/tables")).expect("removed");
    assert!(
        scratch
            .refusal()
            .contains("cannot read the folder of tables")
    );
    fs::create_dir(scratch.path("generator/tables")).expect("made");
    // A program may stand beside its tables.
    fs::write(scratch.path("generator/tables/Cargo.toml"), "[workspace]\n").expect("written");
    let message = scratch.refusal();
    assert!(
        message.contains("no table (*.toml) lies in generator/tables"),
        "{message}"
    );
}

#[test]
fn tables_need_names_of_their_own() {
    let scratch = Scratch::new();
    scratch.edit(COM, "name = \"com\"", "name = \"dcom\"");
    let message = scratch.refusal();
    assert!(
        message.contains("generator/tables/com.toml has the name \"dcom\" already"),
        "{message}"
    );
    scratch.edit(COM, "name = \"dcom\"\n", "");
    let message = scratch.refusal();
    assert!(
        message.contains("no name") && message.contains("com.toml:"),
        "{message}"
    );
}

#[test]
fn what_the_derivation_finds_is_shown_in_the_table() {
    let mut scratch = Scratch::new();
    scratch.edit(COM, "[C_L]\n\"alpha\"", "[C_L]\n\"alpah\"");
    let found = r#"{"diagnostics":[
        {"rule":"monomial","file":"com.toml","path":["C_L","alpah"],"part":"key","message":"no such variable","help":"did you mean `alpha`?"},
        {"rule":"range","file":"com.toml","path":["C_L","1","value"],"part":"value","message":"too large","help":null},
        {"rule":"missing","file":"com.toml","path":["vehicle","mass"],"part":"key","message":"`mass` is missing","help":null}]}"#;
    scratch.use_python(scratch.interpreter("3 11", "", &format!("echo '{found}'; exit 2")));
    let message = scratch.refusal();

    let text = scratch.read(COM);
    let at = |start: &str| {
        1 + text
            .lines()
            .position(|line| line.starts_with(start))
            .expect("there")
    };
    let coefficients = at("[C_L]");
    for expected in [
        "error: no such variable [monomial]\n".to_owned(),
        format!("com.toml:{}:1]", coefficients + 1),
        "did you mean `alpha`?".to_owned(),
        "error: too large [range]\n".to_owned(),
        // What is missing is shown where it ought to stand.
        format!("com.toml:{}:", at("[vehicle]")),
    ] {
        assert!(message.contains(&expected), "no {expected:?} in\n{message}");
    }
}

#[test]
fn what_the_derivation_finds_in_a_family_is_shown_at_its_line() {
    let mut scratch = Scratch::new();
    scratch.write(
        "generator/tables/own.py",
        "family = Family()\n    lift = 1\n",
    );
    let found = r#"{"diagnostics":[{"rule":"family","file":"own.py","path":[],"part":"key","message":"lift is no force","help":null,"line":2}]}"#;
    scratch.use_python(scratch.interpreter("3 11", "", &format!("echo '{found}'; exit 2")));
    let message = scratch.refusal();
    for expected in [
        "error: lift is no force [family]\n",
        "generator/tables/own.py:2:5]",
        "lift = 1",
    ] {
        assert!(message.contains(expected), "no {expected:?} in\n{message}");
    }
    // A family that comes along is not in the project.
    let found = found.replace("own.py", "ahv_generator/families/com.py");
    scratch.use_python(scratch.interpreter("3 11", "", &format!("echo '{found}'; exit 2")));
    let message = scratch.refusal();
    let expected = "error: ahv_generator/families/com.py:2: lift is no force";
    assert!(message.starts_with(expected), "{message}");
}

#[test]
fn a_derivation_that_breaks_down_is_shown() {
    let mut scratch = Scratch::new();
    for end in ["exit 1", "exit 2"] {
        let derive = format!("echo 'ImportError: no libcasadi' >&2; {end}");
        scratch.use_python(scratch.interpreter("3 11", "", &derive));
        let message = scratch.refusal();
        assert!(
            message.starts_with("error: the derivation failed (exit status: "),
            "{message}"
        );
        assert!(message.contains("ImportError: no libcasadi"), "{message}");
    }
    let traceback = "Traceback (most recent call last):\\n  File \"x.py\", line 1, in f\\n    f()\\nOverflowError: 34\\n";
    let derive = format!("printf '{traceback}' >&2; exit 1");
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    let message = scratch.refusal();
    assert!(
        message.ends_with("(exit status: 1)\n    OverflowError: 34"),
        "{message}"
    );
    scratch.use_python(scratch.interpreter("3 11", "", "true"));
    assert!(scratch.refusal().contains("left no IR for table \"com\""));
}
