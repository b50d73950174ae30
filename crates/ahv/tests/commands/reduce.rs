//! `ahv reduce`, through the real binary.

use std::process::Output;

use serde_json::Value;

use crate::command::{self, ahv, fail, numbers, stderr};

fn run(options: &[&str]) -> Output {
    ahv(&[&["reduce"], options].concat())
}

fn json(options: &[&str]) -> Value {
    command::json(&[&["reduce"], options].concat())
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= tolerance,
            "{found} is not {expected}"
        );
    }
}

/// σ/√(4ζω³) and √(ζσ²/(2ω³)), worked out by hand for (36), and the checked maxima of `science.md`.
#[test]
fn the_default_is_section_5_1() {
    let outcome = json(&[]);
    close(
        &numbers(&outcome["eta_std"]),
        &[0.68121, 0.19541, 0.07658],
        1e-5,
    );
    close(
        &numbers(&outcome["chi_std"]),
        &[0.67436, 0.16581, 0.05415],
        1e-5,
    );
    close(
        &numbers(&outcome["max_abs_std_error"]),
        &[0.3074, 0.0664, 0.0225],
        5e-5,
    );
    let modes = outcome["modes"].as_array().expect("a list");
    assert_eq!(modes.len(), 3);
    for (index, mode) in modes.iter().enumerate() {
        for key in ["eta_std", "chi_std", "max_abs_std_error"] {
            assert_eq!(mode[key], outcome[key][index]);
        }
        assert_eq!(mode["sigma"], 100.0);
        let sampled = &mode["monte_carlo"]["eta_std"];
        assert!(sampled["low"].as_f64() < sampled["value"].as_f64());
    }
    assert_eq!(modes[0]["damping"], "underdamped");
    assert_eq!(outcome, json(&[]), "equal seeds give equal numbers");
    assert_ne!(outcome, json(&["--seed", "1"]));
}

#[test]
fn a_method_gives_up_what_it_says() {
    let mode = [
        "--omega", "20.5", "--zeta", "0.02", "--sigma", "17", "--runs", "30",
    ];
    let of = |method| json(&[&mode[..], &["--method", method]].concat())["modes"][0].clone();
    let [printed, variance, moment] = ["printed", "variance", "moment"].map(of);
    let ratios = |mode: &Value| {
        [
            mode["variance_ratio"].as_f64(),
            mode["spectrum_ratio_at_zero"].as_f64(),
        ]
        .map(Option::unwrap)
    };
    close(&ratios(&printed), &[0.0008, 1.0], 1e-9);
    close(&ratios(&variance), &[1.0, 1250.0], 1e-6);
    close(&ratios(&moment), &[1.0, 1.0], 1e-9);
    close(
        &[moment["decay"].as_f64().expect("a number")],
        &[512.5],
        1e-9,
    );
    assert!(printed["max_abs_std_error_time"].is_null());
}

/// A mode of 20 rad/s and damping ratio 2 decays with 20 (2 - sqrt 3) = 5.359 1/s; a = zeta omega = 40 is not that rate.
#[test]
fn what_a_method_keeps_is_computed_for_the_mode() {
    let of = |zeta: &str, method| {
        let mode = [
            "--omega", "20", "--zeta", zeta, "--runs", "30", "--method", method,
        ];
        json(&mode)["modes"][0].clone()
    };
    let overdamped = of("2", "printed");
    close(
        &[
            overdamped["mode_decay"].as_f64().expect("a number"),
            overdamped["decay_ratio"].as_f64().expect("a number"),
        ],
        &[5.358_983_848_622_456, 7.464_101_615_137_754],
        1e-9,
    );
    for (zeta, method, keeps) in [
        ("2", "printed", &["spectrum_at_zero"][..]),
        ("2", "variance", &["variance"]),
        ("2", "moment", &["variance", "spectrum_at_zero"]),
        ("0.5", "printed", &["decay_rate", "spectrum_at_zero"]),
        ("0.5", "variance", &["decay_rate", "variance"]),
        (
            "0.7071067811865476",
            "printed",
            &["decay_rate", "variance", "spectrum_at_zero"],
        ),
    ] {
        let mode = of(zeta, method);
        assert_eq!(mode["keeps"], serde_json::json!(keeps), "{zeta} {method}");
        assert_eq!(
            mode["gives_up"].as_array().map(Vec::len),
            Some(3 - keeps.len())
        );
    }
}

/// Mode 3: eta overtakes chi and leads by more than chi did in the rise.
#[test]
fn the_place_of_the_greatest_error_is_reported() {
    let outcome = json(&["--runs", "30"]);
    let facts = |index: usize| {
        let mode = &outcome["modes"][index];
        (
            mode["max_abs_std_error_in_rise"] == true,
            mode["max_abs_std_error_chi_leads"] == true,
        )
    };
    assert_eq!(
        [0, 1, 2].map(facts),
        [(true, true), (true, true), (false, false)]
    );
    let third = &outcome["modes"][2];
    let number = |key: &str| third[key].as_f64().expect("a number");
    close(
        &[number("max_abs_std_error"), number("rise_abs_std_error")],
        &[0.02251, 0.01846],
        5e-6,
    );
    close(&[number("max_abs_std_error_time")], &[0.0316], 5e-5);
    let text = String::from_utf8(run(&["--runs", "30"]).stdout).expect("text");
    assert!(
        text.contains("by 0.022513 at most, at 0.0316 s, where eta has the larger; in the rise from rest by 0.018462 at most, at 0.0030 s, where chi has the larger"),
        "{text}"
    );
}

/// A mode of which the coloured noise is far faster than the step: 10/sqrt(4 3e-8 30^3) = 175.682.
#[test]
fn the_ensemble_has_the_law_of_a_very_fast_coloured_noise() {
    let outcome = json(&[
        "--omega", "30", "--zeta", "3e-8", "--sigma", "10", "--method", "moment",
    ]);
    close(&numbers(&outcome["chi_std"]), &[175.682], 1e-3);
    let sampled = &outcome["modes"][0]["monte_carlo"]["chi_std"];
    let sampled = sampled["value"].as_f64().expect("a number");
    // A thousand runs: 2.2 % standard error.
    assert!((sampled / 175.682 - 1.0).abs() < 0.09, "{sampled}");
}

#[test]
fn bad_lists_are_explained() {
    for (arguments, words) in [
        (
            &["--omega", "20", "--zeta", "0.5,0.6"][..],
            "each needs one value a mode",
        ),
        (&["--omega", "20"], "--omega has 1 values, --zeta 3"),
        (
            &["--omega", "20,30,40", "--zeta", "0.5,0,0.5"],
            "mode 2: zeta must be positive",
        ),
        (
            &["--omega", "-20", "--zeta", "0.5"],
            "mode 1: omega must be positive",
        ),
        (&["--sigma", "1,2,NaN"], "mode 3: sigma must be positive"),
        (&["--omega", "1e200", "--zeta", "0.5"], "mode 1: the"),
        (&["--t-end", "1e-9"], "steps"),
        (&["--method", "best"], "printed, variance, moment"),
        (&["--runs", "5"], "30"),
    ] {
        fail(&[&["reduce"], arguments].concat(), 2, &[words]);
    }
}

#[test]
fn picture_and_table_are_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("new");
    let output = run(&["--zeta", "0.3,1,2", "--out", &out.display().to_string()]);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(
        text.contains("keeps decay rate and spectrum at zero frequency; gives up variance (0.1800")
            && text.contains("mode 3: omega 94.8203 rad/s"),
        "{text}"
    );
    let svg = std::fs::read_to_string(out.join("reduce.svg")).expect("a picture");
    assert!(svg.contains("time [s]") && svg.contains("spectrum"));
    let mut table = csv::Reader::from_path(out.join("reduce.csv")).expect("a table");
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!(rows.len(), 3 * 101);
    assert!(
        rows.iter()
            .flatten()
            .all(|field| field.parse::<f64>().is_ok_and(f64::is_finite))
    );
}
