//! Flights in metre, kilogram and second.

use super::bench::{Bench, json, with};
use crate::command::stderr;

const FOOT: f64 = 0.3048;
/// A modal coordinate: (ft slug)^0.5 in (m kg)^0.5, with a slug of 14.593902937206364 kg.
const MODAL: f64 = 2.109_080_751_242_232_5;

/// Size of a component in foot and slug, to measure a difference by.
fn scale(name: &str) -> f64 {
    match name {
        "velocity" => 7702.0,
        "altitude" => 85_000.0,
        "gamma" | "alpha" | "pitch_rate" | "alpha_gust" => 0.1,
        _ => 1.0,
    }
}

/// Size of the unit of a column that is called `unit`, in the SI unit in its place.
fn converted(unit: &str) -> (&'static str, f64) {
    match unit {
        "s" => ("s", 1.0),
        "ft" => ("m", FOOT),
        "ft/s" => ("m/s", FOOT),
        "rad" => ("rad", 1.0),
        "rad/s" => ("rad/s", 1.0),
        "(ft*slug)^0.5" => ("(m*kg)^0.5", MODAL),
        "(ft*slug)^0.5/s" => ("(m*kg)^0.5/s", MODAL),
        other => panic!("an unknown unit: {other}"),
    }
}

/// Greatest difference of the flights in both systems, relative to [`scale`].
fn difference(arguments: &[&str]) -> f64 {
    let (feet, metres) = (Bench::new(), Bench::new());
    feet.succeed(arguments);
    metres.succeed(&with(arguments, &["--units", "si"]));
    let heads = |bench: &Bench| -> Vec<(String, String)> {
        let head = bench.text().lines().next().expect("a header").to_owned();
        let split = |column: &str| {
            let (name, unit) = column.split_once(" [").expect("name [unit]");
            (name.to_owned(), unit.trim_end_matches(']').to_owned())
        };
        head.split(',').map(split).collect()
    };
    let (heads, heads_in_si) = (heads(&feet), heads(&metres));
    let (rows, rows_in_si) = (feet.rows(), metres.rows());
    assert_eq!(rows.len(), rows_in_si.len());
    let mut worst = 0.0_f64;
    for (column, (name, unit)) in heads.iter().enumerate() {
        let (si_unit, factor) = converted(unit);
        assert_eq!(heads_in_si[column], (name.clone(), si_unit.to_owned()));
        for (row, row_in_si) in rows.iter().zip(&rows_in_si) {
            let difference = row_in_si[column] / factor - row[column];
            worst = worst.max(difference.abs() / scale(name));
        }
    }
    worst
}

/// Rounding differs, and the airframe is unstable: 3 s multiply a difference by a hundred. Observed: below 1e-13.
#[test]
fn flights_agree_to_rounding() {
    for arguments in [
        &["--model", "dcom"] as &[_],
        &["--model", "dcom", "--initial", "alpha=1.51deg"],
        &["--model", "dcom", "--stochastic", "--seed", "7"],
        &["--model", "sdcom", "--seed", "7"],
        &["--model", "sdcom_printed", "--seed", "7"],
        &[
            "--model",
            "sdcom_gust",
            "--seed",
            "7",
            "--reduction",
            "moment",
        ],
        &["--model", "com", "--earth", "spherical"],
        &["--model", "com_rigid"],
    ] {
        let arguments = with(arguments, &["--t-end", "3", "--dt", "0.002"]);
        let difference = difference(&arguments);
        assert!(difference < 1e-12, "{arguments:?}: {difference:e}");
    }
}

/// The short period of this set multiplies what the two trims leave by 1e5. Observed: 1.3e-11.
#[test]
fn the_faster_set_agrees_to_what_its_instability_leaves() {
    let arguments = ["--model", "dcom", "--set", "section5.3"];
    let difference = difference(&with(&arguments, &["--t-end", "3", "--dt", "0.01"]));
    assert!(difference < 1e-9, "{difference:e}");
}

#[test]
fn inputs_and_results_are_in_si() {
    let bench = Bench::new();
    let flight = ["--model", "dcom", "--t-end", "0.1", "--dt", "0.01"];
    let si = with(&flight, &["--units", "si"]);
    let output = bench.succeed(&with(&si, &["--initial", "velocity=2400m/s", "--json"]));
    assert_eq!(bench.rows()[0][1], 2400.0);
    let json = json(&output);
    assert_eq!(json["unit_system"], "si");
    assert_eq!(json["units"]["altitude"], "m");
    assert_eq!(json["initial_state"]["altitude"], 25_908.0);
    assert_eq!(json["initial_state"]["velocity"], 2400.0);

    let output = bench.succeed(&si);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for shown in ["2347.594228 m/s", "25908 m", "13.100555 deg"] {
        assert!(text.contains(shown), "no {shown} in: {text}");
    }
    let fast = with(&si, &["--initial", "velocity=3500"]);
    let message = stderr(&bench.succeed(&fast));
    assert!(
        message
            .contains("velocity is 3500 m/s, outside its validity box of 2133.6 m/s to 3352.8 m/s"),
        "{message}"
    );

    let feet = with(&si, &["--initial", "velocity=7702ft/s"]);
    bench.fail(&feet, 2, &["`7702ft/s`", "velocity=7702m/s"]);
    let far = with(&si, &["--canard", "free", "--input", "delta_c=1e300rad"]);
    bench.fail(&far, 3, &["2347.59", "m/s, altitude 25908 m"]);
}
