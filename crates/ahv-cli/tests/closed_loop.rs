//! `ahv lqr` and `ahv track`: what the binary prints and writes.
#![forbid(unsafe_code)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn ahv(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ahv"));
    command.args(arguments).output().expect("ahv starts")
}

fn succeed(arguments: &[&str]) -> String {
    let output = ahv(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn fail(arguments: &[&str], code: i32, words: &[&str]) {
    let output = ahv(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "no {word:?} in: {said}");
    }
    assert!(output.stdout.is_empty());
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn gains_are_labelled_and_stabilise() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("gains.json");
    let printed = json(&succeed(&[
        "lqr",
        "--model",
        "dcom",
        "--json",
        "--out",
        path(&file),
    ]));
    let written = json(&fs::read_to_string(&file).expect("the file"));
    assert_eq!(printed, written);
    assert_eq!(written["inputs"], json(r#"["phi", "delta_e"]"#));
    let states = written["states"].as_array().expect("a list");
    let gain = written["gain"].as_array().expect("rows");
    assert_eq!((states.len(), gain.len()), (11, 2));
    assert!(
        gain.iter()
            .all(|row| row.as_array().is_some_and(|row| row.len() == 11))
    );
    for pole in written["poles"].as_array().expect("a list") {
        assert!(pole[0].as_f64().expect("a number") < 0.0);
    }
    // The trim of science.md, section 6.
    let alpha = written["state"]["alpha"]
        .as_f64()
        .expect("a number")
        .to_degrees();
    assert!((alpha - 1.5018).abs() < 1e-4, "{alpha}");
    assert_eq!(written["state_weight"]["eta_1"], 0.0);
    assert_eq!(written["units"]["gamma"], "rad");
}

#[test]
fn the_canard_is_moved_when_asked_for_and_weights_have_units() {
    let printed = json(&succeed(&[
        "lqr",
        "--model",
        "dcom",
        "--canard",
        "free",
        "--json",
        "--input-deviation",
        "delta_c=2deg",
        "--state-deviation",
        "altitude=50ft",
    ]));
    assert_eq!(printed["inputs"], json(r#"["phi", "delta_e", "delta_c"]"#));
    let weight = |kind: &str, name: &str| printed[kind][name].as_f64().expect("a number");
    assert!((weight("state_weight", "altitude") - 1.0 / 2500.0).abs() < 1e-15);
    let angle = 2.0_f64.to_radians();
    assert!((weight("input_weight", "delta_c") * angle * angle - 1.0).abs() < 1e-12);
}

#[test]
fn gains_in_si_are_the_same_law() {
    let gain = |units: &str| {
        let printed = json(&succeed(&[
            "lqr",
            "--model",
            "com_rigid",
            "--json",
            "--units",
            units,
        ]));
        let entry =
            |row: usize, column: usize| printed["gain"][row][column].as_f64().expect("a number");
        [entry(0, 0), entry(1, 1), entry(1, 3)]
    };
    let ([by_velocity, by_altitude, by_alpha], si) = (gain("ft-slug-s-rad"), gain("si"));
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7 * b.abs(), "{a} {b}");
    close(0.3048 * si[0], by_velocity);
    close(0.3048 * si[1], by_altitude);
    close(si[2], by_alpha);
}

#[test]
fn requests_without_sense_are_refused() {
    fail(
        &[
            "lqr",
            "--model",
            "dcom",
            "--state-deviation",
            "altitude=0ft",
        ],
        2,
        &["altitude", "above 0"],
    );
    fail(
        &[
            "lqr",
            "--model",
            "dcom",
            "--state-deviation",
            "altitute=5ft",
        ],
        2,
        &["altitude"],
    );
    fail(
        &["track", "--runs", "1", "--out", "nowhere"],
        2,
        &["--runs"],
    );
    fail(
        &[
            "track",
            "--runs",
            "2",
            "--out",
            "/dev/null/folder",
            "--controller",
            "lqr",
        ],
        2,
        &["cannot make the folder"],
    );
}

#[test]
fn tracking_writes_its_parts_and_repeats() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("track");
    let run = |seed: &str| {
        json(&succeed(&[
            "track",
            "--runs",
            "2",
            "--seed",
            seed,
            "--json",
            "--out",
            path(&out),
        ]))
    };
    let first = run("5");
    assert_eq!(first["runs"], 2);
    for (index, name) in ["backstepping", "lqr"].into_iter().enumerate() {
        let outcome = &first["controllers"][index];
        assert_eq!(outcome["controller"], name);
        assert_eq!(outcome["statistics"]["lost"]["flights"], 0);
        assert!(outcome["poles"][0][0].as_f64().expect("a number") < 0.0);
        let flight = fs::read_to_string(out.join(format!("{name}.csv"))).expect("the flight");
        // A heading, then every 0.25 s of 90 s.
        assert_eq!(flight.lines().count(), 1 + 361);
        let columns = flight.lines().next().expect("a heading").split(',').count();
        assert!(
            flight
                .lines()
                .all(|line| line.split(',').count() == columns)
        );
    }
    let table = fs::read_to_string(out.join("statistics.csv")).expect("the table");
    assert_eq!(table.lines().count(), 1 + 2 * (2 + 15));
    assert!(!table.contains("NaN") && !table.contains("inf"));
    let picture = fs::read_to_string(out.join("tracking.svg")).expect("the picture");
    assert!(picture.starts_with("<svg") && picture.contains("backstepping, median"));
    assert_eq!(run("5"), first);
    assert_ne!(run("6"), first);
}
