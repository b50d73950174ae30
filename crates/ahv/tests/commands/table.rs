//! `--table`.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::command::{fail, json, number, text};

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../generator/tables")
        .join(name)
}

/// The project's own table with a replacement.
struct Edited {
    folder: TempDir,
}

impl Edited {
    fn new(name: &str, from: &str, to: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let text = fs::read_to_string(own(name)).expect("the table is there");
        assert!(text.contains(from), "{from}");
        fs::write(folder.path().join("table.toml"), text.replacen(from, to, 1)).expect("writable");
        Self { folder }
    }

    fn path(&self) -> String {
        self.folder
            .path()
            .join("table.toml")
            .to_string_lossy()
            .into_owned()
    }
}

#[test]
fn the_own_table_changes_nothing() {
    for (model, table) in [
        ("com", "com.toml"),
        ("com_rigid", "com.toml"),
        ("dcom", "dcom.toml"),
        ("sdcom", "dcom.toml"),
    ] {
        for set in ["section5.1", "section5.3"] {
            let words = ["trim --model", model, "--set", set];
            let path = own(table);
            let path = path.to_str().expect("UTF-8");
            let mut found = json(&[&words[..], &["--table", path]].concat());
            assert_eq!(found["table"].take(), path);
            assert_eq!(found, json(&words), "{model} {set}");
        }
    }
}

#[test]
fn values_choices_and_box_are_those_of_the_file() {
    let heavy = Edited::new("dcom.toml", "m = { value = 300.0", "m = { value = 310.0");
    let trim = json(&["trim --model dcom --table", &heavy.path()]);
    assert!(number(&trim["alpha_deg"]) > 1.51, "{trim}");
    let further = json(&[
        "trim --model dcom --table",
        &heavy.path(),
        "--set",
        "section5.3",
    ]);
    assert!(
        (number(&further["alpha_deg"]) - 0.606).abs() < 6e-4,
        "{further}"
    );

    let slaved = Edited::new("dcom.toml", "canard = \"none\"", "canard = \"slaved\"");
    let trim = json(&["trim --model dcom --table", &slaved.path()]);
    assert_eq!(trim["choices"]["canard"], "slaved");
    assert!((number(&trim["alpha_deg"]) - 3.6558).abs() < 6e-5, "{trim}");

    let narrow = Edited::new(
        "com.toml",
        "phi = { min = 0.05, max = 1.2",
        "phi = { min = 0.05, max = 0.2",
    );
    fail(
        &["trim --model com --table", &narrow.path()],
        3,
        &["no trim with phi <= 0.2"],
    );

    let bare = Edited::new(
        "dcom.toml",
        "\"eta_1\" = { value = 8.9e-4",
        "# \"eta_1\" = { value = 8.9e-4",
    );
    let named = Edited::new(
        "dcom.toml",
        "\"eta_1\" = { value = 8.9e-4",
        "\"eta_1\" = { value = 0.0",
    );
    let [bare, zero] =
        [bare, named].map(|table| json(&["trim --model dcom --table", &table.path()]));
    assert_eq!(bare["state"], zero["state"]);

    let flight = ["simulate --model com --t-end 0.1 --dt 0.01"];
    let out = narrow
        .folder
        .path()
        .join("run.csv")
        .to_string_lossy()
        .into_owned();
    let told = text(&[&flight[..], &["--table", &narrow.path(), "--out", &out]].concat());
    assert!(told.contains("table.toml, set section5.1"), "{told}");
}

#[test]
fn a_table_in_si_is_the_same_vehicle() {
    let text = fs::read_to_string(own("com.toml")).expect("the table is there");
    // Values keep their meaning: those of the rigid body that have a dimension, and the modes taken off.
    let si = [
        ("ft-slug-s-rad\"", "si\""),
        (
            "models = [\"com\", \"com_rigid\"]",
            "models = [\"com_rigid\"]",
        ),
        (
            "300.0, unit = \"slug/ft\"",
            "14364.07769410075, unit = \"kg/m\"",
        ),
        (
            "5.0e5, unit = \"slug*ft\"",
            "2224110.80763025, unit = \"kg*m\"",
        ),
        (
            "S = { value = 17.0, unit = \"ft\"",
            "S = { value = 5.1816, unit = \"m\"",
        ),
        (
            "c_bar = { value = 17.0, unit = \"ft\"",
            "c_bar = { value = 5.1816, unit = \"m\"",
        ),
        ("8.36, unit = \"ft\"", "2.548128, unit = \"m\""),
        (
            "6.7429e-5, unit = \"slug/ft^3\"",
            "0.03475147834543482, unit = \"kg/m^3\"",
        ),
        ("85000.0, unit = \"ft\"", "25908.0, unit = \"m\""),
        ("21358.0, unit = \"ft\"", "6509.9184, unit = \"m\""),
        (
            "32.17405, unit = \"ft/s^2\"",
            "9.80665044, unit = \"m/s^2\"",
        ),
        ("20902231.0, unit = \"ft\"", "6371000.0088, unit = \"m\""),
        (
            "min = 7000.0, max = 11000.0, unit = \"ft/s\"",
            "min = 2133.6, max = 3352.8, unit = \"m/s\"",
        ),
        (
            "min = 80000.0, max = 110000.0, unit = \"ft\"",
            "min = 24384.0, max = 33528.0, unit = \"m\"",
        ),
    ];
    let mut converted = si.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    // The rigid body has no use for what belongs to the modes.
    for section in ["[modes]", "[N_1]", "[N_2]"] {
        let start = converted.find(section).expect("a section");
        let length = converted[start + 1..]
            .find("\n[")
            .map_or(converted.len() - start, |it| it + 1);
        converted.replace_range(start..start + length, "");
    }
    let thrust: Vec<String> = converted
        .lines()
        .filter(|line| !line.starts_with("eta"))
        .map(
            |line| match (line.split_once("value = "), line.contains("lb/ft")) {
                (Some((key, rest)), true) => {
                    let (value, rest) = rest.split_once(',').expect("a unit follows");
                    let newton: f64 =
                        value.parse::<f64>().expect("a number") * 4.448_221_615_260_5 / 0.3048;
                    format!("{key}value = {newton:?},{}", rest.replace("lb/ft", "N/m"))
                }
                _ => line.to_owned(),
            },
        )
        .collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("si.toml");
    fs::write(&path, thrust.join("\n")).expect("writable");
    let found = json(&[
        "trim --model com_rigid --table",
        path.to_str().expect("UTF-8"),
    ]);
    let expected = json(&["trim --model com_rigid"]);
    for key in ["alpha_deg", "phi", "delta_e_deg"] {
        let (found, expected) = (number(&found[key]), number(&expected[key]));
        assert!(
            (found - expected).abs() < 1e-9,
            "{key}: {found}, not {expected}"
        );
    }
}

/// Text of com.toml, what takes its place, and words of the message; `\n` is an end of a line.
const BAD: &str = r#"
"alpha" = { value = 4.6773 | "alhpa" = { value = 4.6773 | :1: `alhpa` is not a variable of this quantity; did you mean `alpha`? | [monomial]
[T]\n | [T]\n"0" = { value = 1.0, unit = "lb/ft" }\n | `0` is not a variable of this quantity; known here: `phi`, `alpha` [monomial]
"alpha" = { value = 4.6773 | "alpha^2" = { value = 4.6773 | no coefficient of `alpha^2` in `[C_L]` | `ahv generate` | [needs-generation]
"alpha" = { value = 4.6773, unit = "1/rad" | "alpha^1" = { value = 9.9, unit = "1/rad" }\n"alpha" = { value = 4.6773, unit = "1/rad" | `alpha` is the same monomial as `alpha^1` [duplicate-monomial]
"alpha" = { value = 4.6773, unit = "1/rad" | "alpha" = { value = 4.6773, unit = "1/rad", uncertanty = 0.01 | unknown key `uncertanty`; did you mean `uncertainty`? [unknown-key]
S = { value = 17.0, unit = "ft" | S = { value = 5.18, unit = "m" | `m` measures the right thing, but the table is in ft-slug-s-rad | write the value in `ft` [unit]
4.6773, unit = "1/rad" | 4.6773, unit = "1" | the unit `1` does not fit | the unit here is `1/rad` [unit]
4.6773, unit = "1/rad" | 4.6773, unit = "furlong" | `furlong` is not a unit | ft, slug
value = 4.6773 | value = inf | `C_L.alpha.value` must be a finite number [not-finite]
value = 4.6773 | value = "4.6773" | `C_L.alpha.value` must be a number [not-a-number]
I_yy = { value = 5.0e5, unit = "slug*ft" } |  | `I_yy` (pitch moment of inertia) is missing in `[vehicle]` [missing]
m = { value = 300.0 | m = { value = -300.0 | `m` (vehicle mass) must be positive [positive]
value = 32.17405 | value = 0.0 | `g` ( | [positive]
psi_1 = { value = 401.86 | psi_1 = { value = 801.86 | mass matrix | [mass-matrix]
earth = "flat" | earth = "flta" | `flta` is not an option of `earth`; did you mean `flat`? [unknown-option]
min = 0.05, max = 1.2 | min = 1.2, max = 1.2 | `min` must be below `max` [range]
[sets."section5.3"] | [sets."section5.3".vehicle]\nmass = { value = 1.0, unit = "slug/ft" } | `[vehicle]` of the table has no `mass` to replace | [nothing-to-replace]
[choices] | [choices | table.toml: | [unreadable]
unit = "slug/ft" } | unit = "slug/ft", } | :38: a comma at the end of an inline table: this is TOML 1.1 | [unreadable]
"alpha" = { value = 4.6773 | "eta_18446744073709551615" = { value = 4.6773 | `eta_18446744073709551615` is not a variable
"alpha" = { value = 4.6773 | "al\u001b\u202epha" = { value = 4.6773 | `al\u{1b}\u{202e}pha` is not a variable
"#;

#[test]
fn faults_are_reported_with_place_and_rule() {
    for line in BAD.trim().lines() {
        let line = line.replace("\\n", "\n");
        let parts: Vec<&str> = line.split(" | ").collect();
        let edited = Edited::new("com.toml", parts[0], parts[1]);
        fail(
            &["trim --model com --table", &edited.path()],
            2,
            &parts[2..],
        );
    }
    let line = fs::read_to_string(own("com.toml")).expect("it is there");
    let line = line[..line.find("4.6773").expect("it is there")]
        .lines()
        .count();
    let edited = Edited::new(
        "com.toml",
        "4.6773, unit = \"1/rad\"",
        "4.6773, unit = \"1\"",
    );
    let place = format!("table.toml:{line}:36: the unit");
    fail(&["trim --model com --table", &edited.path()], 2, &[&place]);
    let path = own("com.toml");
    fail(
        &["trim --model dcom --table", path.to_str().expect("UTF-8")],
        2,
        &["not for dcom", "com.toml:7:"],
    );
    fail(
        &["trim --model com --table missing.toml"],
        2,
        &["cannot read missing.toml"],
    );
    let words = [
        "trim --model com --set section5.2 --table",
        path.to_str().expect("UTF-8"),
    ];
    fail(
        &words,
        2,
        &[
            "--set: unknown set of parameters `section5.2`; did you mean `section5.",
            "com.toml",
        ],
    );
}

/// A pipe has no end until somebody writes to it: whoever reads it waits.
#[cfg(unix)]
#[test]
fn a_pipe_is_no_table() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pipe = folder.path().join("com.toml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo runs").success());
    let pipe = pipe.to_str().expect("UTF-8");
    fail(
        &["trim --model com --table", pipe],
        2,
        &["com.toml: it is a pipe, a socket or a device, not a file"],
    );
}

#[test]
fn the_name_of_a_set_has_plain_letters() {
    let from = "set = \"section5.1\"";
    let edited = Edited::new("com.toml", from, "set = \"</text>\\u001b[31m\"");
    fail(
        &["trim --model com --table", &edited.path()],
        2,
        &["`set` must name the table's own parameter set"],
    );
}

/// The text of a unit neither ends the program nor fills the screen.
#[test]
fn a_unit_of_many_brackets_is_refused() {
    let unit = format!("{}ft{}", "(".repeat(40_000), ")".repeat(40_000));
    let from = "S = { value = 17.0, unit = \"ft\"";
    let edited = Edited::new(
        "com.toml",
        from,
        &from.replace("\"ft\"", &format!("{unit:?}")),
    );
    let words = ["trim --model com --table", &edited.path()];
    let output = fail(&words, 2, &["(((...` is not a unit; known are ft"]);
    assert!(output.stderr.len() < 500);
}

/// A table lists the models that it is for, which decide what it must have.
#[test]
fn a_table_for_the_rigid_body_alone_has_no_modes() {
    let listed = "models = [\"com\", \"com_rigid\"]";
    let edited = Edited::new("com.toml", listed, "models = [\"com_rigid\"]");
    let words = ["trim --model com_rigid --table", &edited.path()];
    let parts = [
        "unknown section `modes`",
        "unknown key `eta_dot`",
        "unknown section `N_2`",
    ];
    fail(&words, 2, &parts);
}

#[test]
fn faults_are_listed_up_to_a_number() {
    let edited = Edited::new("com.toml", "units = \"ft-slug-s-rad\"", "units = \"si\"");
    let words = ["trim --model com --table", &edited.path()];
    let output = fail(&words, 2, &["the table is in si", "more faults"]);
    assert_eq!(String::from_utf8_lossy(&output.stderr).lines().count(), 21);
}
