//! `ahv diff`: what it finds between tables, folders and revisions, beside what the other commands say of each table.
#![forbid(unsafe_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn ahv(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_ahv"))
        .args(arguments)
        .output();
    output.expect("ahv starts")
}

fn json(arguments: &[&str]) -> Value {
    let output = ahv(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn own() -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../generator/tables/dcom.toml"
    );
    fs::read_to_string(path).expect("it is there")
}

/// Folders `old` and `new` with the table and with a changed one.
fn folders(root: &Path, from: &str, to: &str) -> [PathBuf; 2] {
    let own = own();
    assert!(own.contains(from), "no {from:?}");
    let texts = [own.clone(), own.replacen(from, to, 1)];
    let folders = ["old", "new"].map(|name| root.join(name));
    for (folder, text) in folders.iter().zip(texts) {
        fs::create_dir(folder).expect("made");
        fs::write(folder.join("dcom.toml"), text).expect("written");
    }
    folders
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn trim_and_poles_are_those_of_each_table() {
    let root = tempfile::tempdir().expect("a folder");
    let [old, new] = folders(
        root.path(),
        "\"alpha\" = { value = 4.6773",
        "\"alpha\" = { value = 4.7773",
    );
    let found = json(&["diff", "--json", text(&old), text(&new)]);
    let table = &found["tables"][0];
    assert_eq!(
        (&table["table"], &table["status"]),
        (&"dcom.toml".into(), &"changed".into())
    );
    assert_eq!(table["changes"].as_array().map(Vec::len), Some(1));
    assert_eq!(table["models"].as_array().map(Vec::len), Some(4));
    for effect in table["models"].as_array().expect("models") {
        let model = effect["model"].as_str().expect("a name");
        for (side, folder) in [("old", &old), ("new", &new)] {
            let path = folder.join("dcom.toml");
            let alone = ["--model", model, "--table", text(&path), "--json"];
            let trim = json(&[&["trim"], alone.as_slice()].concat());
            let shown = effect["trim"].as_array().expect("a trim");
            assert!(shown.iter().any(|it| it["name"] == "alpha"));
            for it in shown {
                let name = it["name"].as_str().expect("a name");
                let states = [
                    &trim["state"][name],
                    &trim["input"][name],
                    &trim["outputs"][name],
                ];
                assert!(
                    states.contains(&&it[side]),
                    "{model}, {name}: {} in {trim}",
                    it[side]
                );
            }
            let roots = json(&[&["poles"], alone.as_slice()].concat());
            let poles = roots["poles"].as_array().expect("poles");
            let zeros = roots["zeros"].as_array().expect("zeros");
            for root in effect["zeros"][side].as_array().expect("zeros") {
                let pair = serde_json::json!([root["re"], root["im"]]);
                assert!(zeros.contains(&pair), "{model}: {pair} in {zeros:?}");
            }
            for it in effect["poles"].as_array().expect("poles") {
                let root = &it[side];
                let pair = serde_json::json!([root["re"], root["im"]]);
                assert!(poles.contains(&pair), "{model}: {pair} in {poles:?}");
            }
        }
    }
}

#[test]
fn reports_name_the_change_in_words_and_in_markdown() {
    let root = tempfile::tempdir().expect("a folder");
    let [old, new] = folders(root.path(), "m = { value = 300.0", "m = { value = 310.0");
    fs::write(new.join("other.toml"), own()).expect("written");
    let output = ahv(&["diff", text(&old), text(&new)]);
    let said = String::from_utf8(output.stdout).expect("text");
    for part in [
        "dcom.toml\n",
        "vehicle.m",
        "300.0 slug/ft",
        "310.0 slug/ft",
        "+3.333 %",
        "+0.08",
        "other.toml: new",
    ] {
        assert!(said.contains(part), "no {part} in {said}");
    }
    let output = ahv(&["diff", "--format", "markdown", text(&old), text(&new)]);
    let said = String::from_utf8(output.stdout).expect("text");
    for part in [
        "### dcom.toml",
        "| vehicle.m | 300.0 slug/ft | 310.0 slug/ft |",
        "|---|",
        "**dcom at ",
    ] {
        assert!(said.contains(part), "no {part} in {said}");
    }
    let output = ahv(&["diff", text(&old), text(&old)]);
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "dcom.toml: the same\n"
    );
}

#[test]
fn a_revision_is_compared_with_the_table_as_it_is() {
    let root = tempfile::tempdir().expect("a folder");
    let [old, _] = folders(root.path(), "m = { value = 300.0", "m = { value = 310.0");
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        git.arg("-C")
            .arg(&old)
            .args(["-c", "user.name=a", "-c", "user.email=a@b"]);
        assert!(
            git.args(arguments).output().expect("git").status.success(),
            "{arguments:?}"
        );
    };
    git(&["init", "-q"]);
    git(&["add", "."]);
    git(&["commit", "-q", "-m", "first"]);
    let path = old.join("dcom.toml");
    fs::write(
        &path,
        own().replacen("m = { value = 300.0", "m = { value = 310.0", 1),
    )
    .expect("written");
    for new in [&old, &path] {
        let found = json(&["diff", "--json", "HEAD", text(new)]);
        assert_eq!(
            found["tables"][0]["changes"][0]["path"], "vehicle.m",
            "{found}"
        );
    }
    for revision in ["nowhere", "--output=x"] {
        let output = ahv(&["diff", "--", revision, text(&path)]);
        assert_eq!(output.status.code(), Some(2), "{revision}");
    }
}

#[test]
fn a_table_without_a_trim_says_so() {
    let root = tempfile::tempdir().expect("a folder");
    let [old, new] = folders(root.path(), "m = { value = 300.0", "m = { value = 30000.0");
    let found = json(&["diff", "--json", text(&old), text(&new)]);
    let missing = found["tables"][0]["models"][0]["missing"]
        .as_str()
        .expect("a reason");
    assert!(
        missing.starts_with("with the new table: dcom: "),
        "{missing}"
    );
}

/// The margins with the gains of the old table: of a regulator on its own vehicle they are at least half the gain and 60 deg.
#[test]
fn the_effects_of_a_change_are_compared() {
    let root = tempfile::tempdir().expect("a folder");
    let [old, new] = folders(
        root.path(),
        "\"alpha\" = { value = 4.6773",
        "\"alpha\" = { value = 5.1450",
    );
    let pictures = root.path().join("pictures");
    let flags = ["--flights", "16", "--pictures", text(&pictures)];
    let found = json(
        &[
            ["diff", "--json", text(&old), text(&new)].as_slice(),
            &flags,
        ]
        .concat(),
    );
    let models = found["tables"][0]["models"].as_array().expect("models");
    for effect in models {
        let model = effect["model"].as_str().expect("a name");
        let loops = effect["regulated"]["loops"].as_array().expect("loops");
        assert!(!loops.is_empty(), "{effect}");
        for it in loops {
            let most = &it["old"]["most_gain"];
            assert!(most.is_null(), "{model}: {it}");
            let phase = it["old"]["phase"].as_f64();
            assert!(phase.is_none_or(|phase| phase > 59.99), "{model}: {it}");
        }
        let trims = &effect["trims"];
        let count = |name: &str| trims[name].as_u64().expect("a number");
        assert_eq!(count("new"), count("old") + count("gained") - count("lost"));
        if model == "dcom" {
            let outputs = effect["outputs"].as_array().expect("outputs");
            let lift = outputs
                .iter()
                .find(|it| it["name"] == "lift")
                .expect("lift");
            // Lift is linear in the slope: at its largest angle a tenth more of this part.
            assert!(
                lift["share"]
                    .as_f64()
                    .is_some_and(|it| it > 0.01 && it < 0.1),
                "{lift}"
            );
            let slopes = effect["slopes"].as_array().expect("slopes");
            let is_stiffness = |it: &&Value| it["output"] == "lift" && it["state"] == "alpha";
            assert!(
                slopes.iter().any(|it| is_stiffness(&it)),
                "{model}: {slopes:?}"
            );
        }
        for side in ["old", "new"] {
            let left = &effect["flights"][side];
            let [low, value, high] = ["low", "value", "high"].map(|it| left[it].as_f64());
            assert!(low <= value && value <= high && low.is_some(), "{left}");
        }
        let picture = fs::read_to_string(pictures.join(format!("dcom-{model}.svg")));
        assert!(picture.expect("a picture").starts_with("<svg"));
    }
    let line = ["diff", "--format", "markdown", text(&old), text(&new)];
    let output = ahv(&[line.as_slice(), &flags[2..]].concat());
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(
        said.contains("![Poles and trims of dcom](<") && !said.contains("NaN"),
        "{said}"
    );
}
