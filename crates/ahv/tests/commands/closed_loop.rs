//! `ahv lqr` and `ahv track`: what the binary prints and writes.

use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::{Complex, DMatrix};
use serde_json::Value;

use crate::command::{ahv, fail, text};

fn json(told: &str) -> Value {
    serde_json::from_str(told).expect("JSON")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn gains_are_labelled_and_stabilise() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("gains.json");
    let printed = json(&text(&["lqr --model dcom --json --out", path(&file)]));
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

/// Eigenvalues of A − B K, rightmost first.
fn closed(system: &Value, gains: &Value) -> Vec<Complex<f64>> {
    let matrix = |value: &Value| {
        let rows: Vec<Vec<f64>> = serde_json::from_value(value.clone()).expect("a matrix");
        DMatrix::from_row_slice(rows.len(), rows[0].len(), &rows.concat())
    };
    let (a, b, k) = (
        matrix(&system["A"]),
        matrix(&system["B"]),
        matrix(&gains["gain"]),
    );
    let mut poles = (a - b * k).complex_eigenvalues().as_slice().to_vec();
    poles.sort_by(|a, b| b.re.total_cmp(&a.re));
    poles
}

/// One order of inputs: what the two commands write with their default flags fits together.
#[test]
fn a_minus_b_k_has_the_poles_of_the_regulator() {
    let folder = tempfile::tempdir().expect("a folder");
    let [system, gains] = ["linearize", "lqr"].map(|command| {
        let file = folder.path().join(format!("{command}.json"));
        text(&[command, "--model", "dcom", "--out", path(&file)]);
        json(&fs::read_to_string(&file).expect("the file"))
    });
    assert_eq!(system["inputs"], gains["inputs"]);
    assert_eq!(system["states"], gains["states"]);
    let poles = gains["poles"].as_array().expect("a list");
    let found = closed(&system, &gains);
    assert_eq!(found.len(), poles.len());
    for (found, pole) in found.iter().zip(poles) {
        let real = pole[0].as_f64().expect("a number");
        assert!(
            (found.re - real).abs() < 1e-6 * (1.0 + real.abs()),
            "{found} {pole}"
        );
    }
}

/// What a short flight with gains at `file` says, and its exit code.
fn fly(file: &Path, options: &[&str]) -> (Option<i32>, String) {
    let words = ["montecarlo --model sdcom --members 8 --t-end 0.02 --json"];
    let output = ahv(&[&words[..], &["--feedback", path(file)], options].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

/// Gains of SDCOM as `ahv lqr` writes them with these options.
fn designed(folder: &Path, options: &[&str]) -> (PathBuf, Value) {
    let file = folder.join("gains.json");
    let words = ["lqr --model sdcom --out", path(&file)];
    text(&[&words[..], options].concat());
    let gains = json(&fs::read_to_string(&file).expect("the file"));
    (file, gains)
}

#[test]
fn files_of_gains_are_read_strictly() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, gains) = designed(folder.path(), &[]);
    assert_eq!(fly(&file, &[]).0, Some(0));
    let no_velocity = "missing field `velocity`";
    type Change = fn(&mut Value);
    let cases: [(Change, &str); 16] = [
        (|it| it["states"][2] = Value::Null, "invalid type: null"),
        (|it| it["states"][2] = "alpha".into(), "for the states"),
        (
            |it| it["states"] = json(r#"["velocity", "altitude"]"#),
            "for the states",
        ),
        (
            |it| it["inputs"] = json(r#"["delta_e", "phi"]"#),
            "in this order",
        ),
        (|it| it["inputs"] = json(r#"["phi", "phi"]"#), "each once"),
        (|it| it["inputs"] = json("[]"), "its inputs are"),
        (
            |it| it["gain"] = json("[[0, 0, 0, 0, 0, 0, 0, 0]]"),
            "rows of its gain: 1; there must be 2",
        ),
        (
            |it| it["gain"].as_array_mut().expect("rows").push(json("[0]")),
            "rows of its gain: 3",
        ),
        (
            |it| it["gain"][1] = json("[0, 0]"),
            "gains of its row delta_e: 2; there must be 8",
        ),
        (|it| it["gain"][0][0] = Value::Null, "invalid type: null"),
        (
            |it| it["law"] = "u = gain x".into(),
            "its law is `u = gain x`",
        ),
        (|it| it["extra"] = 1.into(), "unknown field `extra`"),
        (
            |it| it["units"]["gamma"] = "deg".into(),
            "its unit of gamma is `deg`",
        ),
        (
            |it| it["state"]["gamma"] = 0.1.into(),
            "its `state` is not of its flight condition: gamma",
        ),
        (
            |it| it["state"]["speed"] = 1.into(),
            "its `state` has the names",
        ),
        (
            |it| {
                it.as_object_mut().expect("an object").remove("velocity");
            },
            no_velocity,
        ),
    ];
    let write = |text: &str| fs::write(&file, text).expect("it is written");
    let refused = |words: &str| {
        let (code, said) = fly(&file, &[]);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "no {words:?} in: {said}");
        let command = "ahv lqr --model sdcom --set section5.1 --units ft-slug-s-rad --canard none";
        assert!(said.contains(command), "{said}");
    };
    for (change, words) in cases {
        let mut changed = gains.clone();
        change(&mut changed);
        write(&changed.to_string());
        refused(words);
    }
    let text = gains.to_string();
    write(&text.replacen("\"gamma\":", "\"alpha\":0,\"alpha\":", 1));
    refused("`alpha` stands there twice");
    write(&text.replacen("\"residual\":", "\"residual\":1e999, \"no\":", 1));
    refused("number out of range");
    #[cfg(unix)]
    {
        fs::remove_file(&file).expect("it is there");
        let made = std::process::Command::new("mkfifo").arg(&file).status();
        assert!(made.expect("mkfifo runs").success());
        let (code, said) = fly(&file, &[]);
        assert_eq!(code, Some(2), "{said}");
        assert!(
            said.contains("it is a pipe, a socket or a device"),
            "{said}"
        );
    }
}

#[test]
fn gains_of_another_vehicle_or_flight_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases: [(&[&str], &str); 5] = [
        (
            &["--set", "section5.3"],
            "set section5.3, the flights section5.1",
        ),
        (
            &["--earth", "spherical"],
            "earth spherical, the flights flat",
        ),
        (
            &["--velocity", "7800"],
            "velocity 7800, the flights 7702.0808",
        ),
        (
            &["--altitude", "86000"],
            "altitude 86000, the flights 85000",
        ),
        (&["--gamma", "1"], "gamma in deg 1, the flights 0"),
    ];
    for (options, words) in cases {
        let (file, _) = designed(folder.path(), options);
        let (code, said) = fly(&file, &[]);
        assert_eq!(code, Some(2), "{said}");
        assert!(
            said.contains(words) && said.contains("ahv lqr --model sdcom"),
            "{said}"
        );
        let (code, said) = fly(&file, &["--feedback-mismatch", "allow"]);
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("note: ") && said.contains(words), "{said}");
    }
    // The same words, other values.
    let (file, gains) = designed(folder.path(), &[]);
    let mut other = gains.clone();
    other["parameters_sha256"] = "0".repeat(64).into();
    fs::write(&file, other.to_string()).expect("it is written");
    let (code, said) = fly(&file, &[]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("parameters that the models were generated with (SHA-256 000"),
        "{said}"
    );
    // Another model with the same states; with others, nothing can be allowed.
    let printed = folder.path().join("printed.json");
    text(&["lqr --model sdcom_printed --out", path(&printed)]);
    assert!(
        fly(&printed, &[])
            .1
            .contains("model sdcom_printed, the flights sdcom")
    );
    let rigid = folder.path().join("rigid.json");
    text(&["lqr --model com_rigid --out", path(&rigid)]);
    let (code, said) = fly(&rigid, &["--feedback-mismatch", "allow"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("its gains of com_rigid are for the states"),
        "{said}"
    );
}

/// In a climb the altitude of the reference moves with the flight, so that the path stays.
#[test]
fn a_climb_is_held() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, gains) = designed(folder.path(), &["--gamma", "1"]);
    let rate = |name: &str| gains["state_rate"][name].as_f64().expect("a number");
    assert!((rate("altitude") - 134.42).abs() < 0.01, "{gains}");
    assert_eq!((rate("velocity"), rate("gamma")), (0.0, 0.0));
    let words =
        ["montecarlo --model sdcom --gamma 1 --members 64 --t-end 20 --dt 0.01 --json --feedback"];
    let flown = json(&text(&[&words[..], &[path(&file)]].concat()));
    let gamma = flown["mean"]["gamma"]
        .as_f64()
        .expect("a number")
        .to_degrees();
    assert!((gamma - 1.0).abs() < 0.1, "{gamma}");
    // A reference that stands still, or one whose velocity grows, is no equilibrium.
    for (state, value) in [("altitude", 0.0), ("velocity", 5.0)] {
        let mut changed = gains.clone();
        changed["state_rate"][state] = value.into();
        fs::write(&file, changed.to_string()).expect("it is written");
        let (code, said) = fly(&file, &["--gamma", "1"]);
        assert_eq!(code, Some(2), "{said}");
        let words =
            format!("a reference that is no equilibrium of the flights: {state} changes by");
        assert!(said.contains(&words), "{said}");
    }
}

#[test]
fn the_canard_is_moved_when_asked_for_and_weights_have_units() {
    let printed = json(&text(&[
        "lqr --model dcom --canard free --json --input-deviation delta_c=2deg --state-deviation altitude=50ft",
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
        let printed = json(&text(&["lqr --model com_rigid --json --units", units]));
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
        &["lqr --model dcom --state-deviation altitude=0ft"],
        2,
        &["altitude", "above 0"],
    );
    fail(
        &["lqr --model dcom --state-deviation altitute=5ft"],
        2,
        &["altitude"],
    );
    fail(&["track --runs 1 --out nowhere"], 2, &["--runs"]);
    fail(
        &["track --runs 2 --out /dev/null/folder --controller lqr"],
        2,
        &["cannot make the folder"],
    );
}

#[test]
fn tracking_writes_its_parts_and_repeats() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("track");
    let run = |seed: &str| {
        json(&text(&[
            "track --runs 2 --seed",
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
    // One controller leaves the other's flight of an earlier run, and says so.
    let alone = ["--runs", "2", "--controller", "lqr", "--out", path(&out)];
    let output = ahv(&[&["track"], &alone[..]].concat());
    let [told, warned] = [&output.stdout, &output.stderr].map(|it| String::from_utf8_lossy(it));
    assert!(
        warned.contains("backstepping.csv is of an earlier run"),
        "{warned}"
    );
    assert!(!told.contains("for each controller"), "{told}");
}
