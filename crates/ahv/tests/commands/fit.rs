//! `ahv fit`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::command::{fail, json, number, text};

const TABLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../generator/tables");

fn structure(name: &str) -> String {
    format!("{TABLES}/{name}.toml")
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Samples of the lift and the drag of COM's table at a grid, written with degrees.
fn samples(folder: &Path, changed: impl Fn(String) -> String) -> PathBuf {
    let mut csv = "alpha [deg],delta_e [rad],C_L [1],C_D\n".to_owned();
    for row in 0..=20 {
        for column in 0..=10 {
            let (degrees, delta_e) = (f64::from(row) / 2.0 - 4.0, f64::from(column) / 20.0 - 0.25);
            let alpha = degrees.to_radians();
            let lift = 4.6773 * alpha + 0.76224 * delta_e - 0.018714;
            let drag = 5.8224 * alpha * alpha - 0.045315 * alpha
                + 0.81993 * delta_e * delta_e
                + 2.7699e-4 * delta_e
                + 0.010131;
            writeln!(csv, "{degrees},{delta_e},{lift},{drag}").expect("a text");
        }
    }
    let path = folder.join("samples.csv");
    fs::write(&path, changed(csv)).expect("a file");
    path
}

fn quantity<'a>(report: &'a Value, section: &str) -> &'a Value {
    let all = report["quantities"].as_array().expect("quantities");
    all.iter()
        .find(|it| it["section"] == section)
        .expect("a quantity")
}

fn coefficient(report: &Value, section: &str, monomial: &str) -> f64 {
    let all = quantity(report, section)["coefficients"]
        .as_array()
        .expect("coefficients");
    let found = all
        .iter()
        .find(|it| it["monomial"] == monomial)
        .expect("a monomial");
    number(&found["value"])
}

/// The number of an entry of a table.
fn entry(table: &str, section: &str, key: &str) -> f64 {
    let section = table
        .split(&format!("\n[{section}]\n"))
        .nth(1)
        .expect("a section");
    let line = section
        .lines()
        .find(|it| it.starts_with(&format!("\"{key}\" ")))
        .expect("an entry");
    let value = line
        .split("value =")
        .nth(1)
        .and_then(|it| it.split(',').next())
        .expect("a value");
    value.trim().parse().expect("a number")
}

#[test]
fn samples_of_a_table_give_the_table_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, picture) = (
        folder.path().join("out.toml"),
        folder.path().join("out.svg"),
    );
    let data = samples(folder.path(), |csv| csv);
    let com = structure("com");
    let words = [
        "fit",
        "--data",
        shown(&data),
        "--structure",
        &com,
        "--out",
        shown(&out),
        "--picture",
        shown(&picture),
    ];
    let report = json(&words);
    let own = fs::read_to_string(&com).expect("a table");
    let fitted = fs::read_to_string(&out).expect("a table");
    for (section, keys) in [
        ("C_L", &["alpha", "delta_e", "1"][..]),
        ("C_D", &["alpha^2", "alpha", "delta_e^2", "delta_e", "1"]),
    ] {
        for key in keys {
            let wanted = entry(&own, section, key);
            let room = 1e-13 * wanted.abs().max(1e-2);
            assert!(
                (entry(&fitted, section, key) - wanted).abs() < room,
                "{section} {key}"
            );
            assert!(
                (coefficient(&report, section, key) - wanted).abs() < room,
                "{section} {key}"
            );
        }
        assert!(number(&quantity(&report, section)["r_squared"]) > 1.0 - 1e-12);
    }
    // What has no column stays, and the box is that of the samples.
    assert_eq!(entry(&fitted, "C_M", "alpha"), 2.1335);
    assert!(fitted.contains("alpha      = { min =    -4.0"), "{fitted}");
    assert!(
        fs::read_to_string(&picture)
            .expect("a picture")
            .contains("drag coefficient")
    );
    // The models of this program take it.
    text(&["trim", "--model", "com_rigid", "--table", shown(&out)]);
    let words = [
        "fit",
        "--data",
        shown(&data),
        "--structure",
        &com,
        "--out",
        "/dev/null",
    ];
    fail(
        &words,
        2,
        &["/dev/null: it exists and is not a regular file"],
    );
}

#[test]
fn constraints_hold() {
    let folder = tempfile::tempdir().expect("a folder");
    let data = samples(folder.path(), |csv| csv);
    let com = structure("com");
    let fit = |constraints: &[&str]| {
        let flags = constraints.iter().flat_map(|it| ["--constrain", it]);
        let words: Vec<&str> = ["fit", "--data", shown(&data), "--structure", &com]
            .into_iter()
            .chain(flags)
            .collect();
        json(&words)
    };
    let report = fit(&[
        "C_L.delta_e=0.5*C_L.alpha",
        "C_D.alpha>=0",
        "C_D.delta_e=0.01",
    ]);
    let of = |section, key| coefficient(&report, section, key);
    assert!((of("C_L", "delta_e") - 0.5 * of("C_L", "alpha")).abs() < 1e-12);
    assert_eq!((of("C_D", "alpha"), of("C_D", "delta_e")), (0.0, 0.01));
    let words = |constraint| {
        [
            "fit",
            "--data",
            shown(&data),
            "--structure",
            &com,
            "--constrain",
            constraint,
        ]
    };
    fail(&words("C_L.alpa=1"), 2, &["`alpa`", "did you mean `alpha`"]);
    fail(&words("C_L.alpha>=1"), 2, &["compares with 0"]);
    fail(&words("C_L.alpha=C_D.alpha"), 2, &["of its section"]);
}

#[test]
fn bad_samples_name_line_and_column() {
    let folder = tempfile::tempdir().expect("a folder");
    let com = structure("com");
    let refused = |from: &str, to: &str, words: &[&str]| {
        let data = samples(folder.path(), |csv| csv.replacen(from, to, 1));
        fail(
            &["fit", "--data", shown(&data), "--structure", &com],
            2,
            words,
        );
    };
    refused(
        "-4,-0.25,",
        "-4,nan,",
        &["samples.csv", "line 2", "`delta_e [rad]`", "`nan`"],
    );
    refused(
        "-4,-0.2,",
        "-4,,",
        &["line 3", "`delta_e [rad]`", "not a finite number"],
    );
    refused(
        "delta_e [rad]",
        "delta_f [rad]",
        &["`delta_e [rad]`", "missing", "delta_f"],
    );
    refused("alpha [deg]", "alpha [ft]", &["`alpha [ft]`", "`rad`"]);
    refused("alpha [deg]", "alpha", &["`alpha`", "no unit"]);
    refused(
        "C_L [1],C_D",
        "lift,drag",
        &["none of the table's quantities", "C_L"],
    );
    let flat = samples(folder.path(), |csv| {
        let row = |line: &str| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if cells[1] != "delta_e [rad]" {
                cells[1] = "0.1";
            }
            cells.join(",") + "\n"
        };
        csv.lines().map(row).collect()
    });
    fail(
        &["fit", "--data", shown(&flat), "--structure", &com],
        2,
        &["C_L", "do not tell `delta_e`, `1` apart"],
    );
    fail(
        &["fit", "--data", "none.csv", "--structure", &com],
        2,
        &["none.csv", "cannot be read"],
    );
    fail(
        &["fit", "--from", "fpn", "--structure", &com],
        2,
        &["`fpn`", "did you mean `fpm`"],
    );
    fail(
        &[
            "fit",
            "--from",
            "fpm",
            "--structure",
            &com,
            "--box",
            "alpha=-1:5",
        ],
        2,
        &["--box", "deg or rad"],
    );
}

/// The coefficients that the geometry gives are near the published ones, and a table of them trims.
#[test]
fn geometry_gives_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.toml");
    for (name, model) in [("com", "com"), ("dcom", "dcom")] {
        let table = structure(name);
        let words = [
            "fit",
            "--from",
            "fpm",
            "--structure",
            &table,
            "--samples",
            "4000",
            "--out",
            shown(&out),
        ];
        let report = json(&words);
        assert_eq!(report["uncertainty"], "misfit");
        for (section, key, wanted, room) in [
            ("C_L", "alpha", 4.6773, 0.2),
            ("C_L", "delta_e", 0.76224, 0.2),
            ("C_M", "delta_e", -1.2897, 0.2),
            ("C_D", "delta_e^2", 0.81993, 0.2),
        ] {
            let found = coefficient(&report, section, key);
            assert!(
                (found / wanted - 1.0).abs() < room,
                "{name} {section} {key}: {found}"
            );
        }
        text(&["trim", "--model", model, "--table", shown(&out)]);
        // The same seed gives the same table.
        let first = fs::read_to_string(&out).expect("a table");
        json(&words);
        assert_eq!(first, fs::read_to_string(&out).expect("a table"));
    }
}

#[test]
fn the_search_says_what_a_monomial_buys() {
    let com = structure("com");
    let told = text(&[
        "fit",
        "--from",
        "fpm",
        "--structure",
        &com,
        "--samples",
        "2000",
        "--search",
    ]);
    assert!(
        told.contains("worth trying: add `alpha*delta_e`: cross-validated residual"),
        "{told}"
    );
}
