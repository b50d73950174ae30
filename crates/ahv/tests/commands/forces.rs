//! `ahv forces`, and the first-principles model in the commands that all models have.

use std::fs;

use serde_json::Value;

use crate::command::{ahv, fail, json, number, numbers, stderr, text};

/// The trim of Table 2 as a state that is given.
const TABLE_2: [&str; 4] = [
    "--state",
    "velocity=7702.08,altitude=85000,alpha=1.5153deg",
    "--input",
    "phi=0.2514,delta_e=11.4635deg",
];

/// The sum of the parts of a force.
fn sum(forces: &Value, name: &str) -> f64 {
    let parts = forces["parts"].as_array().expect("parts");
    parts.iter().map(|part| number(&part[name])).sum()
}

#[test]
fn parts_add_up() {
    for (model, by) in [
        ("fpm", "surface"),
        ("com", "coefficient"),
        ("dcom", "coefficient"),
    ] {
        let forces = json(&[&["forces", "--model", model][..], &TABLE_2].concat());
        assert_eq!(forces["by"], by);
        let totals = forces["forces"].as_object().expect("forces");
        assert!(totals.contains_key("pitching_moment"));
        for (name, total) in totals {
            let total = number(total);
            assert!(
                (sum(&forces, name) - total).abs() < 1e-9 * total.abs() + 1e-6,
                "{model} {name}"
            );
        }
    }
}

/// The normal force of the forebody at this point is that of the oracle.
#[test]
fn surfaces_are_named() {
    let forces = json(&[&["forces", "--model", "fpm"][..], &TABLE_2].concat());
    let parts = forces["parts"].as_array().expect("parts");
    let forebody = parts
        .iter()
        .find(|part| part["name"] == "forebody")
        .expect("a forebody");
    assert!((number(&forebody["normal_force"]) - 5881.42).abs() < 0.01);
    assert_eq!(parts.len(), 8);
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let told = text(&[&["forces", "--model", "fpm", "--out", out][..], &TABLE_2].concat());
    assert!(
        told.contains("elevator_lower") && told.contains("total"),
        "{told}"
    );
    let csv = fs::read_to_string(folder.path().join("forces.csv")).expect("a file");
    assert_eq!(csv.lines().count(), 10, "{csv}");
}

#[test]
fn a_state_without_flow_names_the_surface() {
    let steep = "velocity=7702.08,altitude=85000,alpha=40deg";
    let words = ["forces", "--model", "fpm", "--state", steep];
    fail(&words, 2, &["fpm", "forebody", "detached", "Mach 7.85"]);
    let fuel = [
        "forces", "--model", "fpm", TABLE_2[0], TABLE_2[1], "--input", "phi=30",
    ];
    fail(&fuel, 2, &["combustor", "thermal choking"]);
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("vehicle.svg");
    let out = out.to_str().expect("UTF-8");
    fail(
        &["draw", "--alpha", "40", "--out", out],
        2,
        &["alpha", "outside its validity"],
    );
    text(&["draw", "--out", out]);
    let picture = fs::read_to_string(out).expect("a picture");
    for words in [
        "forebody: turn 7.72°, Mach 6.171",
        "spillage",
        "cowl: turn 6.20°, Mach 5.285",
    ] {
        assert!(picture.contains(words), "{words}");
    }
}

/// It trims near Table 2, whose first column it is, and its airframe is unstable as that of the others.
#[test]
fn the_first_principles_model_is_like_the_others() {
    let trim = json(&["trim", "--model", "fpm"]);
    assert!((number(&trim["state"]["alpha"]).to_degrees() - 1.5153).abs() < 1.5);
    let poles = json(&["poles", "--model", "fpm"]);
    let found = poles["poles"].as_array().expect("poles");
    assert_eq!(found.len(), 9);
    assert_eq!(poles["zeros"].as_array().map(Vec::len), Some(7));
    assert!(found.iter().any(|pole| numbers(pole)[0] > 1.0));
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../ahv-fpm/vehicle.toml");
    let same = json(&["trim", "--model", "fpm", "--table", own]);
    assert_eq!(same["state"], trim["state"]);
    let si = json(&["trim", "--model", "fpm", "--units", "si"]);
    let [alpha, there] = [&trim, &si].map(|it| number(&it["state"]["alpha"]));
    assert!((alpha - there).abs() < 1e-9);
}

#[test]
fn the_comparison_has_its_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let found = json(&["compare", "--out", out]);
    assert_eq!(found["points"].as_array().map(Vec::len), Some(140));
    let share = |name: &str| number(&found[name]["difference"]) / number(&found[name]["size"]);
    assert!(share("normal_force") < 0.25);
    assert!(share("pitching_moment") < 0.5 && share("axial_force") < 1.0);
    assert!(folder.path().join("compare.svg").exists());
    assert_eq!(
        fs::read_to_string(folder.path().join("compare.csv"))
            .expect("a file")
            .lines()
            .count(),
        141
    );
}

/// Where a trim starts or a flight goes on without a flow, the surface is named.
#[test]
fn a_trim_and_a_flight_without_flow_name_the_surface() {
    let slow = ["trim", "--model", "fpm", "--velocity", "3000"];
    let trim = ahv(&slow);
    assert_eq!(trim.status.code(), Some(3));
    let why = stderr(&trim);
    assert!(why.contains("combustor: thermal choking"), "{why}");
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("flight.csv");
    let out = out.to_str().expect("UTF-8");
    let words = [
        "simulate", "--model", "fpm", "--t-end", "1", "--dt", "0.01", "--input", "phi=30", "--out",
        out,
    ];
    fail(
        &words,
        3,
        &[
            "became not a number: combustor: thermal choking",
            "the last good state",
        ],
    );
}

/// What the page says of the deviations is what the command prints.
#[test]
fn the_page_has_the_variations() {
    let page = include_str!("../../../../docs/first-principles.md");
    let told = text(&["compare", "--variations"]);
    assert!(told.lines().count() == 10, "{told}");
    for line in told.lines().skip(1) {
        assert!(page.contains(line.trim_end()), "{line}");
    }
}
