//! What the tools say of bad input: `messages.txt`, a session at a shell that a person reads from top to bottom.
//!
//! A line that begins with `$` is a command; what it prints, on stdout and then on stderr, follows, and its exit code unless that
//! is 0. `cargo xtask messages` runs the commands again and writes what they print.
#![cfg(unix)]
#![forbid(unsafe_code)]

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::{env, fs};

/// The tables that the session begins with.
const TABLES: [&str; 2] = ["dcom.toml", "com.toml"];
/// Set to anything, it lets this program write the session.
const WRITE: &str = "AHV_WRITE_MESSAGES";

fn session() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages.txt")
}

/// Runs a line of the shell, which finds `ahv`, in a folder.
fn shell(line: &str, folder: &Path) -> Output {
    let ahv = Path::new(env!("CARGO_BIN_EXE_ahv"));
    let mut path = OsString::from(ahv.parent().expect("a folder"));
    path.push(":");
    path.push(env::var_os("PATH").unwrap_or_default());
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).current_dir(folder);
    shell.env("PATH", path).env("LC_ALL", "C");
    shell.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
    shell.stdin(Stdio::null()).output().expect("sh starts")
}

/// A folder with the tables.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let tables = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../generator/tables");
    for name in TABLES {
        fs::copy(tables.join(name), folder.path().join(name)).expect("a table");
    }
    folder
}

/// A command and what it prints.
fn told(line: &str, folder: &Path) -> String {
    let output = shell(line, folder);
    let printed = [output.stdout, output.stderr].concat();
    let printed = String::from_utf8(printed).expect("UTF-8");
    assert!(!printed.contains("panicked"), "{line}: {printed}");
    let mut text = format!("$ {line}\n");
    for line in printed.trim_end().lines() {
        text += line.trim_end();
        text.push('\n');
    }
    match output.status.code() {
        Some(0) => text,
        code => text + &format!("(exit code {})\n", code.expect("no signal")),
    }
}

#[test]
fn messages_are_those_of_the_session() {
    let written = fs::read_to_string(session()).expect("the session");
    let folder = folder();
    let mut text = String::new();
    for line in written.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            text += &told(command, folder.path());
        } else if line.starts_with("# ") {
            let before = if text.is_empty() { "" } else { "\n" };
            text += &format!("{before}{line}\n\n");
        }
    }
    if env::var_os(WRITE).is_some() {
        return fs::write(session(), text).expect("the session is written");
    }
    let differs = text
        .lines()
        .zip(written.lines())
        .find(|(now, then)| now != then);
    assert_eq!(text, written, "{differs:?}; run:  cargo xtask messages");
}

#[test]
fn quiet_leaves_out_warnings_alone() {
    let folder = folder();
    let flight = "ahv simulate --model dcom --t-end 60 --dt 0.01 --out flight.csv";
    let [loud, quiet] =
        ["", " --quiet"].map(|flag| shell(&format!("{flight}{flag}"), folder.path()));
    assert!(String::from_utf8_lossy(&loud.stderr).starts_with("warning: at "));
    assert!(quiet.stderr.is_empty() && quiet.status.success());
    assert_eq!(quiet.stdout, loud.stdout);
    let wrong = shell("ahv --quiet trim --model dcom --set none", folder.path());
    assert!(String::from_utf8_lossy(&wrong.stderr).starts_with("error: --set"));
    assert_eq!(wrong.status.code(), Some(2));
}

/// A message of the command line, of a command, and the excerpt of a table.
#[test]
fn colours_are_those_that_are_asked_for() {
    let folder = folder();
    fs::write(folder.path().join("bad.toml"), "x = 1.0.0\n").expect("a table");
    for (line, is_error) in [
        ("trim --model dcmo", true),
        ("trim --model dcom --set none", true),
        ("table lint bad.toml", false),
        ("generate --tables . --out models", true),
    ] {
        for (color, coloured) in [("always", true), ("never", false), ("auto", false)] {
            let output = shell(&format!("ahv {line} --color {color}"), folder.path());
            let text = if is_error {
                output.stderr
            } else {
                output.stdout
            };
            assert!(!text.is_empty(), "{line}");
            assert_eq!(text.contains(&0x1b), coloured, "{line} --color {color}");
        }
    }
}

#[test]
fn shells_and_man_have_every_command() {
    let folder = folder();
    let script = shell(
        "ahv completions bash | tee ahv.bash && bash -n ahv.bash",
        folder.path(),
    );
    let script = String::from_utf8(script.stdout).expect("UTF-8");
    assert!(shell("ahv man pages", folder.path()).status.success());
    let help = shell("ahv --help", folder.path());
    let help = String::from_utf8(help.stdout).expect("UTF-8");
    let (_, commands) = help.split_once("Commands:\n").expect("commands");
    let commands = commands.lines().take_while(|line| !line.is_empty());
    let names = commands.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names: Vec<&str> = names
        .filter(|name| !name.is_empty() && *name != "help")
        .collect();
    assert!(
        names.contains(&"trim") && names.contains(&"reproduce"),
        "{names:?}"
    );
    for name in names {
        assert!(script.contains(&format!("ahv,{name})")), "{name}");
        let page = folder.path().join(format!("pages/ahv-{name}.1"));
        let page = fs::read_to_string(page).expect(name);
        assert!(page.contains(".SH SYNOPSIS"), "{page}");
    }
    let lint = fs::read_to_string(folder.path().join("pages/ahv-table-lint.1")).expect("a page");
    assert!(lint.contains("\\-\\-deny"), "{lint}");
}
