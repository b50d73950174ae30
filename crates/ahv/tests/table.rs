//! `ahv table`: what it finds, how it lays out, what it shows.
#![forbid(unsafe_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn table(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../{name}"))
}

fn ahv(arguments: &[&str], path: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ahv"));
    let output = command.arg("table").args(arguments).arg(path).output();
    output.expect("ahv starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// A copy of `dcom.toml` with a change.
fn changed(folder: &Path, from: &str, to: &str) -> PathBuf {
    let own = fs::read_to_string(table("generator/tables/dcom.toml")).expect("it is there");
    assert!(own.contains(from), "no {from:?}");
    let path = folder.join("dcom.toml");
    fs::write(&path, own.replacen(from, to, 1)).expect("written");
    path
}

#[test]
fn the_exit_code_says_whether_something_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["com", "dcom", "flexible_mode"] {
        let path = table(&format!("generator/tables/{name}.toml"));
        let output = ahv(&["lint", "--deny", "all"], &path);
        let said = text(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{name}: {said}");
        assert!(said.contains("0 errors, 0 warnings"), "{name}: {said}");
    }
    let path = changed(
        folder.path(),
        "\"alpha\" = { value = 4.6773",
        "\"alpha\" = { value = 0.081634",
    );
    let output = ahv(&["lint"], &path);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("warning: `alpha` = 0.081634 looks like a number in the other unit of angle"),
        "{said}"
    );
    assert!(
        said.contains("[degrees]") && said.contains("dcom.toml:96:21]"),
        "{said}"
    );
    for denied in ["degrees", "all"] {
        let output = ahv(&["lint", "--deny", denied], &path);
        assert_eq!(output.status.code(), Some(1), "{denied}");
    }
    let output = ahv(&["lint", "--deny", "degree"], &path);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("degrees"), "a suggestion");
    let output = ahv(&["lint"], &folder.path().join("none.toml"));
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn reports_are_for_people_programs_and_code_hosts() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = changed(folder.path(), "m = { value = 300.0", "m = { value = -300.0");
    for (arguments, pointer) in [
        (&["lint", "--json"][..], "/files/0/findings/0/rule"),
        (&["lint", "--format", "json"], "/files/0/findings/0/rule"),
        (&["lint", "--format", "sarif"], "/runs/0/results/0/ruleId"),
    ] {
        let output = ahv(arguments, &path);
        assert_eq!(output.status.code(), Some(1));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(json.pointer(pointer).expect("a finding"), "positive");
    }
    fs::write(&path, "[table]\nname = \"x\"\nname = \"y\"\n").expect("written");
    let output = ahv(&["lint"], &path);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("error: duplicate key [unreadable]") && said.contains("dcom.toml:3:1]"),
        "{said}"
    );
}

/// Tables whose models or sections this program does not have are given to their families.
#[test]
fn a_table_of_any_family_is_reviewed() {
    for name in [
        "two-mode/two_mode",
        "four-mode/four_mode",
        "van-der-pol/van_der_pol",
        "parker-canard/parker_canard",
    ] {
        let output = ahv(&["lint"], &table(&format!("examples/{name}.toml")));
        let said = text(&output.stdout);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{name}: {said}{}",
            text(&output.stderr)
        );
        let output = ahv(&["show"], &table(&format!("examples/{name}.toml")));
        assert!(
            output.status.success() && !output.stdout.is_empty(),
            "{name}"
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    let own =
        fs::read_to_string(table("examples/van-der-pol/van_der_pol.toml")).expect("it is there");
    let family = folder.path().join("van_der_pol.py");
    fs::copy(table("examples/van-der-pol/van_der_pol.py"), family).expect("copied");
    let path = folder.path().join("van_der_pol.toml");
    fs::write(&path, own.replacen("value =", "vlaue =", 1)).expect("written");
    let output = ahv(&["lint"], &path);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("unknown key `vlaue` [unknown-key]"), "{said}");
    assert!(said.contains("did you mean `value`?"), "{said}");
}

#[test]
fn a_layout_is_written_whole_and_never_through_a_link() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = changed(folder.path(), "m = { value = 300.0", "m={value=300.0");
    let before = fs::read_to_string(&path).expect("text");
    assert_eq!(ahv(&["fmt", "--check"], &path).status.code(), Some(1));
    assert_eq!(fs::read_to_string(&path).expect("text"), before);
    assert_eq!(ahv(&["fmt"], &path).status.code(), Some(0));
    let after = fs::read_to_string(&path).expect("text");
    assert!(after.contains("m     = { value = 300.0, "), "{after}");
    assert_eq!(ahv(&["fmt", "--check"], &path).status.code(), Some(0));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    #[cfg(unix)]
    {
        fs::write(&path, &before).expect("written");
        let link = folder.path().join("link.toml");
        std::os::unix::fs::symlink(&path, &link).expect("linked");
        let output = ahv(&["fmt"], &link);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("it is a link"));
        assert_eq!(fs::read_to_string(&path).expect("text"), before);
    }
}

#[test]
fn a_table_is_shown_as_text_json_and_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = table("generator/tables/dcom.toml");
    let shown = text(&ahv(&["show"], &own).stdout);
    for part in [
        "[C_L] lift coefficient, dimensionless",
        "[sets.\"section5.3\".vehicle]",
        "±40 %",
        "vehicle mass",
        "█",
    ] {
        assert!(shown.contains(part), "no {part} in {shown}");
    }
    let json: serde_json::Value =
        serde_json::from_slice(&ahv(&["show", "--json"], &own).stdout).expect("JSON");
    assert_eq!(json["groups"][0]["section"], "vehicle");
    let page = folder.path().join("dcom.html");
    let output = ahv(&["show", "--html", page.to_str().expect("UTF-8")], &own);
    assert!(output.status.success());
    assert!(
        fs::read_to_string(&page)
            .expect("a page")
            .starts_with("<!DOCTYPE html>")
    );
}
