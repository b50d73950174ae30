//! `ahv disperse` and `ahv covariance`, through the real binary.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::command::{ahv as run, fail, json, number, text};

const FEW: [&str; 1] = ["disperse --model dcom --members 60"];

#[test]
fn the_spread_is_told_in_numbers() {
    let outcome = json(&FEW);
    assert_eq!(outcome["distribution"], "uniform");
    let failed = outcome["failed"].as_object().expect("reasons");
    let failed: f64 = failed.values().map(number).sum();
    assert_eq!(number(&outcome["trimmed"]) + failed, 60.0);
    let share = &outcome["shares"]["trims"];
    assert!((number(&share["value"]) - number(&outcome["trimmed"]) / 60.0).abs() < 1e-12);
    let quantities = outcome["quantities"].as_array().expect("a list");
    let alpha = &quantities[0];
    assert_eq!(
        (&alpha["name"], &alpha["unit"]),
        (&"alpha".into(), &"rad".into())
    );
    assert!((number(&alpha["nominal"]).to_degrees() - 1.5018).abs() < 1e-4);
    assert_eq!(alpha["spread"]["count"], outcome["trimmed"]);
    assert!(number(&alpha["linear_std"]) > 0.0);
    let effects = alpha["sensitivities"].as_array().expect("a list");
    let sizes: Vec<f64> = effects
        .iter()
        .map(|it| number(&it["effect"]).abs())
        .collect();
    assert!(sizes.is_sorted_by(|a, b| a >= b) && !sizes.is_empty());
    let zeros = quantities
        .iter()
        .filter(|it| it["kind"] == "zero" && it["part"] == "real");
    // Nine zeros, three of them pairs.
    assert_eq!(zeros.count(), 6);
}

#[test]
fn what_varies_and_what_moves_together_is_chosen() {
    let lift = json(&[&FEW[..], &["--vary", "C_L"]].concat());
    // Parameters without effect are left out: the noise does not move a trim.
    let stochastic = ["disperse --model sdcom --members 30"];
    let effects = [&stochastic[..], &["--vary", "sigma,C_L", "--top", "99"]].concat();
    let told = text(&effects);
    let effects: Vec<&str> = told
        .lines()
        .filter(|it| it.starts_with("    "))
        .map(str::trim)
        .collect();
    assert!(
        effects.iter().any(|it| it.starts_with("c_l_alpha ")),
        "{told}"
    );
    assert!(!effects.iter().any(|it| it.starts_with("sigma")), "{told}");
    let names = |outcome: &Value| -> Vec<String> {
        let effects = outcome["quantities"][0]["sensitivities"]
            .as_array()
            .cloned();
        let effects = effects.unwrap_or_default();
        effects
            .iter()
            .map(|it| it["parameter"].as_str().unwrap_or_default().to_owned())
            .collect()
    };
    assert!(names(&lift).iter().all(|name| name.starts_with("c_l_")));
    let vary = ["--vary", "c_l_alpha,c_l_delta_e"];
    let apart = json(&[&FEW[..], &vary].concat());
    let joined = json(
        &[
            &FEW[..],
            &vary,
            &["--group", "lift=c_l_alpha,c_l_delta_e:0.5"],
        ]
        .concat(),
    );
    let std = |outcome: &Value| number(&outcome["quantities"][0]["linear_std"]);
    let effects: Vec<f64> = apart["quantities"][0]["sensitivities"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|it| number(&it["effect"]))
        .collect();
    let [a, b] = effects[..] else {
        panic!("two parameters")
    };
    assert!((std(&apart) - a.hypot(b)).abs() < 1e-12);
    assert!((std(&joined) - (a * a + b * b + a * b).sqrt()).abs() < 1e-12);
}

#[test]
fn pictures_and_members_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("new");
    let path = out.to_str().expect("text");
    let printed = text(&[&FEW[..], &["--out", path]].concat());
    for word in [
        "% of the members",
        "alpha [deg]",
        "first order",
        "pole short period 1, real",
    ] {
        assert!(printed.contains(word), "no {word:?} in: {printed}");
    }
    for picture in ["trim.svg", "roots.svg", "sensitivities.svg"] {
        let svg = fs::read_to_string(out.join(picture)).expect("a picture");
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"), "{picture}");
    }
    let members = fs::read_to_string(out.join("members.csv")).expect("a table");
    assert_eq!(members.lines().count(), 61);
    assert!(
        !members.contains("NaN") && members.contains("bound of delta_e"),
        "{members}"
    );
    text(&[&FEW[..], &["--out", path]].concat());
    assert_eq!(
        fs::read_to_string(out.join("members.csv")).expect("a table"),
        members
    );
}

/// A table's own uncertainties take the place of those that the models were generated with.
#[test]
fn a_table_brings_its_uncertainties() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let table = fs::read_to_string(root.join("generator/tables/dcom.toml")).expect("a table");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("dcom.toml");
    let halved = table.replacen("uncertainty = 0.4", "uncertainty = 0.2", 1);
    assert_ne!(halved, table);
    fs::write(&path, halved).expect("written");
    let with_table = ["--table", path.to_str().expect("text")];
    let std = |outcome: Value| number(&outcome["quantities"][0]["linear_std"]);
    let (whole, half) = (
        std(json(&FEW)),
        std(json(&[&FEW[..], &with_table].concat())),
    );
    assert!((half / whole - 0.5).abs() < 1e-9, "{half} {whole}");
}

#[test]
fn slips_are_explained() {
    let with = |more: &[&'static str]| [&FEW[..], more].concat();
    fail(
        &with(&["--group", "lift=c_l_alfa:0.5"]),
        2,
        &["--group: unknown parameter `c_l_alfa`; did you mean `c_l_alpha`?"],
    );
    fail(
        &with(&["--group", "c_l_alpha"]),
        2,
        &["NAME=PARAMETERS:CORRELATION"],
    );
    fail(
        &with(&["--group", "lift=c_l:high"]),
        2,
        &["correlation that is no number"],
    );
    fail(&with(&["--group", "lift=c_l:2"]), 2, &["between 0 and 1"]);
    fail(
        &with(&["--group", "a=c_l", "--group", "b=c_l_0"]),
        2,
        &["c_l_0", "second time"],
    );
    fail(
        &with(&["--vary", "weight"]),
        2,
        &["--vary: unknown parameter `weight`"],
    );
    fail(&with(&["--vary", "g"]), 2, &["nothing to draw"]);
    fail(&["covariance --model com"], 2, &["com has no noise"]);
}

#[test]
fn first_order_and_flights_stand_side_by_side() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("text");
    let arguments = [
        "covariance --model sdcom --t-end 0.4 --dt 0.01 --members 200 --out",
        out,
    ];
    let outcome = json(&arguments);
    let times = outcome["times"].as_array().expect("a list");
    assert_eq!(times.len(), 20);
    let last = &times[19];
    // The coloured noise by itself: b² (1 − exp(−2at))/(2a) with a = ζω and b = ζσ/ω of mode 1.
    let (zeta, omega, sigma) = (0.7_f64, 19.7437, 17.0);
    let (a, b): (f64, f64) = (zeta * omega, zeta * sigma / omega);
    let expected = (b * b * (1.0 - (-2.0 * a * 0.4).exp()) / (2.0 * a)).sqrt();
    assert!((number(&last["linear_std"]["chi_1"]) - expected).abs() < 1e-6);
    assert_eq!(last["members"], 200);
    assert!(number(&outcome["share_inside"]) > 0.7);
    let ratio = number(&last["ratio"]["alpha"]["value"]);
    let std = number(&last["sampled_std"]["alpha"]["value"]);
    assert!((ratio * std / number(&last["linear_std"]["alpha"]) - 1.0).abs() < 1e-12);
    // Of all states and times the ratio that is farthest from 1.
    let worst = number(&outcome["worst_ratio"]["value"]).ln().abs();
    let names = ["velocity", "alpha", "chi_3"];
    assert!(
        names
            .iter()
            .all(|name| number(&last["ratio"][name]["value"]).ln().abs() <= worst)
    );
    assert_eq!(outcome["scheme"], "splitting");
    let printed = text(&arguments);
    assert!(
        printed.contains("alpha")
            && printed.contains("deg [")
            && printed.contains("flights broke down")
            && printed.contains("farthest from 1")
    );
    let svg = fs::read_to_string(folder.path().join("covariance.svg")).expect("a picture");
    assert!(svg.contains("standard deviation [deg]") && !svg.contains("NaN"));
    let table = fs::read_to_string(folder.path().join("covariance.csv")).expect("a table");
    assert_eq!(table.lines().count(), 21);
}

/// The modes of the reduction that keeps the moments decay with 2625 1/s: the step need not resolve that.
#[test]
fn a_stiff_reduction_has_its_exact_deviation() {
    let arguments =
        ["covariance --model sdcom --set section5.3 --reduction moment --t-end 0.1 --members 1000"];
    for dt in ["0.0005", "0.002"] {
        let outcome = json(&[&arguments[..], &["--dt", dt]].concat());
        let last = &outcome["times"][19];
        let linear = number(&last["linear_std"]["chi_3"]);
        let sampled = number(&last["sampled_std"]["chi_3"]["value"]);
        assert!((linear - 0.0329).abs() < 5e-5, "{linear}");
        assert!((sampled / linear - 1.0).abs() < 0.08, "{sampled}");
    }
}

#[test]
fn a_regulated_flight_stays_and_an_unstable_one_has_no_stationary_covariance() {
    let folder = tempfile::tempdir().expect("a folder");
    let gains = folder.path().join("gains.json");
    let gains = gains.to_str().expect("text");
    text(&["lqr --model sdcom --out", gains]);
    let few = ["covariance --model sdcom --members 400 --dt 0.01 --stationary"];
    let output = run(&few);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(
        message.contains("the short period mode has the pole +1.67"),
        "{message}"
    );
    // All else is reported.
    let rest: Value = {
        let output = run(&[&few[..], &["--json"]].concat());
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    assert_eq!(rest["times"].as_array().map(Vec::len), Some(20));
    assert!(rest["stationary_std"].is_null());
    let climbing = run(&[&few[..], &["--gamma", "1"]].concat());
    let message = String::from_utf8_lossy(&climbing.stderr);
    let place = "not at rest, altitude changes by 134.419845 ft per s";
    assert!(message.contains(place), "{message}");
    let spread = [
        "--feedback",
        gains,
        "--state-std",
        "gamma=0.02deg",
        "--input-std",
        "phi=0.001",
    ];
    let outcome = json(&[&few[..], &spread].concat());
    assert_eq!(outcome["feedback"], true);
    let last = &outcome["times"][19];
    for state in ["velocity", "altitude", "gamma", "alpha", "pitch_rate"] {
        let linear = number(&last["linear_std"][state]);
        let sampled = number(&last["sampled_std"][state]["value"]);
        assert!(
            (linear / sampled - 1.0).abs() < 0.15,
            "{state}: {linear} {sampled}"
        );
        assert!(number(&outcome["stationary_std"][state]) > 0.0);
    }
    // At rest 1 s is enough for the angle of attack.
    let rest = number(&outcome["stationary_std"]["alpha"]);
    assert!((number(&last["linear_std"]["alpha"]) / rest - 1.0).abs() < 0.5);
}
