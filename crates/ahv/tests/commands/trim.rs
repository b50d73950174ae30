//! `ahv trim`.

use std::fs;

use crate::command::{fail, json, number, numbers, text};

/// The check point of the paper.
const PLACE: [&str; 4] = ["--velocity", "7702.0808", "--altitude", "85000"];

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() < tolerance,
        "{value}, not {expected}"
    );
}

#[test]
fn the_coms_trim_where_they_were_recomputed() {
    for (earth, alpha, phi, delta_e) in [
        ("flat", (1.64457, 6e-6), (0.26809, 6e-6), (12.53998, 6e-6)),
        ("spherical", (1.4056, 6e-5), (0.2505, 6e-5), (11.984, 6e-4)),
    ] {
        for model in ["com", "com_rigid"] {
            let words = [&["trim --model", model, "--earth", earth], PLACE.as_slice()].concat();
            let trim = json(&words);
            near(number(&trim["alpha_deg"]), alpha.0, alpha.1);
            near(number(&trim["phi"]), phi.0, phi.1);
            near(number(&trim["delta_e_deg"]), delta_e.0, delta_e.1);
            assert_eq!(trim["converged"], true);
            assert!(number(&trim["residual_max"]) < 1e-9, "{trim}");
            let modes = if model == "com" { 2 } else { 0 };
            assert_eq!(numbers(&trim["eta"]).len(), modes);
        }
    }
}

#[test]
fn the_modes_of_the_sdcom_rest_where_those_of_the_dcom_do() {
    let [full, reduced] = ["dcom", "sdcom"].map(|model| json(&["trim --model", model]));
    let (full, reduced) = (numbers(&full["eta"]), numbers(&reduced["eta"]));
    for ((full, reduced), expected) in full.iter().zip(&reduced).zip([0.6276, -0.0137, -0.0372]) {
        near(*full, *reduced, 1e-12);
        near(*full, expected, 6e-5);
    }
    let told = text(&["trim --model sdcom"]);
    for part in [
        "sdcom: trim, velocity 7702.0808 ft/s, altitude 85000 ft, gamma 0 deg",
        "set section5.1, canard none, earth flat, noise independent, reduction printed",
        "  eta_1        0.627555 (ft*slug)^0.5",
        "  eta_3        -0.037191 (ft*slug)^0.5",
        "inside the validity box",
        "residuals, per s:",
    ] {
        assert!(told.contains(part), "no {part:?} in: {told}");
    }
}

#[test]
fn a_climb_needs_more_fuel() {
    let level = json(&["trim --model dcom"]);
    let climb = json(&["trim --model dcom --gamma 2"]);
    assert!(
        number(&climb["phi"]) > number(&level["phi"]) + 0.04,
        "{climb}"
    );
    near(
        number(&climb["state"]["gamma"]),
        2.0_f64.to_radians(),
        1e-15,
    );
    near(number(&climb["residuals"]["altitude"]), 0.0, 1e-12);
}

#[test]
fn units_are_those_that_are_asked_for() {
    let feet = json(&["trim --model sdcom"]);
    let words = ["trim --model sdcom --units si"];
    let metres = json(
        &[
            &words[..],
            &["--velocity", "2347.59422784", "--altitude", "25908"],
        ]
        .concat(),
    );
    near(
        number(&metres["alpha_deg"]),
        number(&feet["alpha_deg"]),
        1e-10,
    );
    assert_eq!(metres["units"]["velocity"], "m/s");
    near(number(&json(&words)["velocity"]), 2_347.594_227_84, 1e-9);
}

#[test]
fn where_there_is_no_trim_the_nearest_point_and_the_bound_are_told() {
    let words = ["trim --model dcom --velocity 7000 --altitude 110000"];
    let parts = [
        "no trim with delta_e <= 20 deg",
        "without bounds the trim is at phi = ",
    ];
    let output = fail(&[&words[..], &["--json"]].concat(), 3, &parts);
    let trim: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(trim["converged"], false);
    assert_eq!(trim["blocking_bound"], "delta_e <= 20 deg");
    let bounds = trim["blocking_bounds"].as_array().expect("a list");
    assert_eq!(bounds[0], trim["blocking_bound"]);
    assert_eq!(number(&trim["delta_e_deg"]), 20.0);
    assert!(
        trim["reason"]
            .as_str()
            .is_some_and(|reason| reason.contains("nearest point"))
    );
    assert!(number(&trim["residual_max"]) > 0.01, "{trim}");
    let output = fail(&words, 3, &parts);
    let told = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(
        told.contains("dcom: no trim") && told.contains("at the nearest point:"),
        "{told}"
    );
}

#[test]
fn flight_conditions_without_steady_flight_are_refused_everywhere() {
    let commands: [&[&str]; 6] = [
        &["trim"],
        &["linearize"],
        &["poles"],
        &["lqr"],
        &["covariance --t-end 1"],
        &["montecarlo --members 8 --t-end 1"],
    ];
    for command in commands {
        for (option, word) in [
            ("--velocity=-7702", "above 0"),
            ("--velocity=0", "above 0"),
            ("--gamma=180", "between -90 deg and 90 deg"),
            ("--gamma=-90", "between -90 deg and 90 deg"),
        ] {
            let words = [command, &["--model", "sdcom", option]].concat();
            let output = fail(&words, 2, &["outside the domain of steady states", word]);
            assert!(output.stdout.is_empty(), "{words:?}");
        }
    }
    let words = ["trim --model dcom --velocity 1e-300"];
    let output = fail(&words, 3, &["the derivative of gamma is still -"]);
    assert!(output.stderr.len() < 300);
}

/// A trim that misses its bound by less than the usual digits shows more of them.
#[test]
fn a_bound_and_the_trim_beyond_look_different() {
    let outcome = |altitude: &str| {
        let words = ["trim --model dcom --velocity 7702 --altitude", altitude];
        crate::command::ahv(&words)
    };
    let (mut low, mut high) = (85_000.0_f64, 130_000.0_f64);
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if outcome(&middle.to_string()).status.success() {
            low = middle;
        } else {
            high = middle;
        }
    }
    let output = outcome(&high.to_string());
    let message = crate::command::stderr(&output);
    assert!(
        message.contains("no trim with delta_e <= 20 deg"),
        "{message}"
    );
    assert!(!message.contains("delta_e = 20 deg"), "{message}");
    assert!(message.contains("delta_e = 20.000000"), "{message}");
}

#[test]
fn a_trim_outside_the_box_says_so() {
    let words = ["trim --model dcom --velocity 12000 --altitude 85000"];
    let trim = json(&words);
    assert_eq!(
        (&trim["converged"], &trim["in_validity_box"]),
        (&true.into(), &false.into())
    );
    assert_eq!(trim["outside_validity_box"]["name"], "velocity");
    let told = text(&words);
    let place = "velocity is 12000 ft/s, outside its validity box of 7000 ft/s to 11000 ft/s";
    assert!(told.contains(place), "{told}");
    let low = ["trim --model dcom --velocity 12000 --altitude 70000"];
    let (trim, told) = (json(&low), text(&low));
    assert_eq!(trim["outside_validity_box"]["name"], "velocity");
    for state in [
        "velocity is 12000 ft/s",
        "altitude is 70000 ft",
        "eta_1 is 3.031131",
    ] {
        assert!(told.contains(state), "{told}");
    }
}

#[test]
fn held_inputs_are_held_and_sought_ones_refused() {
    let words = ["trim --model dcom --canard free --input delta_c=2deg"];
    near(
        number(&json(&words)["input"]["delta_c"]),
        2.0_f64.to_radians(),
        1e-15,
    );
    fail(
        &["trim --model dcom --input phi=0.3"],
        2,
        &["phi is not held"],
    );
    fail(
        &["trim --model dcom --input delta_c=2deg"],
        2,
        &["no effect", "--canard free"],
    );
    fail(
        &["trim --model dcom --velocity nan"],
        2,
        &["not a finite number"],
    );
}

#[test]
fn a_map_is_a_table_and_a_picture() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("new").join("map");
    let words = [
        "trim --model com --map 5x4 --out",
        out.to_str().expect("UTF-8"),
    ];
    let map = json(&words);
    let (points, converged) = (number(&map["points"]), number(&map["converged"]));
    assert!(
        points == 20.0 && converged > 10.0 && converged < 20.0,
        "{map}"
    );
    let csv = fs::read_to_string(out.join("trim_map.csv")).expect("it is written");
    let head =
        "velocity [ft/s],altitude [ft],converged,alpha [rad],phi [1],delta_e [rad],blocking_bound";
    assert_eq!(csv.lines().next(), Some(head));
    assert_eq!(
        csv.lines().filter(|line| line.contains(",true,")).count() as f64,
        converged
    );
    assert_eq!(
        csv.lines()
            .filter(|line| line.ends_with("delta_e <= 20 deg"))
            .count() as f64,
        20.0 - converged
    );
    let svg = fs::read_to_string(out.join("trim_map.svg")).expect("it is written");
    for part in ["alpha [deg]", "delta_e &lt;= 20 deg", "altitude [ft]"] {
        assert!(svg.contains(part), "no {part:?}");
    }
    let told = text(&words);
    assert!(
        told.contains("of 20 points trim, gamma 0 deg, written"),
        "{told}"
    );
    // What is given elsewhere than at 0 is part of the result, wherever that is read.
    let climb = [&words[..], &["--gamma", "1"]].concat();
    assert_eq!(json(&climb)["gamma_deg"], 1.0);
    let told = text(&climb);
    assert!(
        told.contains("of 20 points trim, gamma 1 deg, written"),
        "{told}"
    );
    let csv = fs::read_to_string(out.join("trim_map.csv")).expect("it is written");
    assert!(
        csv.lines()
            .next()
            .is_some_and(|head| head.contains("gamma [rad]"))
    );
    let svg = fs::read_to_string(out.join("trim_map.svg")).expect("it is written");
    assert!(svg.contains("gamma 1 deg"));
    fail(&["trim --model com --map 20 --out x"], 2, &["20x20"]);
    fail(&["trim --model com --map 5x4"], 2, &["--out"]);
}
