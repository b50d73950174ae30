//! What can be chosen by name: models, sets, choices.

use super::bench::{Bench, DCOM, json, with};

const TIMES: [&str; 4] = ["--t-end", "0.1", "--dt", "0.01"];
const MODELS: [(&str, usize, bool); 6] = [
    ("com", 9, false),
    ("com_rigid", 5, false),
    ("dcom", 11, false),
    ("sdcom", 8, true),
    ("sdcom_printed", 8, true),
    ("sdcom_gust", 9, true),
];

/// A short run of a model.
fn flight<'a>(model: &'a str, arguments: &[&'a str]) -> Vec<&'a str> {
    [&["--model", model], &TIMES[..], arguments].concat()
}

/// Angle of attack in deg of the trim of a model.
fn alpha(bench: &Bench, model: &str, arguments: &[&str]) -> f64 {
    bench.succeed(&flight(model, arguments));
    bench.rows()[0][4].to_degrees()
}

#[test]
fn every_model_flies() {
    let bench = Bench::new();
    for (model, states, stochastic) in MODELS {
        for name in [model.to_owned(), model.replace('_', "-")] {
            let arguments = with(&TIMES, &["--model", &name, "--json"]);
            let json = json(&bench.succeed(&arguments));
            assert_eq!(json["model"], model);
            assert_eq!(json["seed"].is_null(), !stochastic);
            assert!(bench.rows().iter().all(|row| row.len() == states + 1));
        }
    }
}

#[test]
fn who_picks_the_printed_form_is_told() {
    let bench = Bench::new();
    let told = |model| {
        let output = bench.succeed(&flight(model, &[]));
        String::from_utf8_lossy(&output.stderr).contains("leaves out Delta f")
    };
    assert!(told("sdcom_printed") && !told("sdcom"));
}

#[test]
fn the_set_decides_the_trim() {
    let bench = Bench::new();
    let own = alpha(&bench, "dcom", &[]);
    assert!((own - 1.5018).abs() < 1e-4);
    assert_eq!(alpha(&bench, "dcom", &["--set", "section5.1"]), own);
    let other = alpha(&bench, "sdcom", &["--set", "section5.3"]);
    assert!((other - 0.606).abs() < 1e-3, "{other}");
    let output = bench.succeed(&with(&DCOM, &["--set", "section5.3", "--json"]));
    assert_eq!(json(&output)["set"], "section5.3");
    for model in ["dcom", "com"] {
        let arguments = ["--model", model, "--set", "section5.2"];
        bench.fail(
            &with(&TIMES, &arguments),
            2,
            &[
                "--set: unknown set of parameters `section5.2`",
                "did you mean `section5.",
                "section5.1, section5.3",
            ],
        );
    }
    bench.fail(
        &with(&DCOM, &["--set", ""]),
        2,
        &["known: section5.1, section5.3"],
    );
}

#[test]
fn the_canard_decides_the_trim() {
    let bench = Bench::new();
    let none = alpha(&bench, "dcom", &["--canard", "none"]);
    assert_eq!(alpha(&bench, "dcom", &[]), none);
    let slaved = alpha(&bench, "dcom", &["--canard", "slaved"]);
    assert!((slaved - 3.6558).abs() < 1e-4);
    let free = |delta_c| {
        let input = format!("delta_c={delta_c}");
        alpha(&bench, "dcom", &["--canard", "free", "--input", &input])
    };
    assert_eq!(free("0rad"), none);
    assert_ne!(free("2deg"), none);
}

#[test]
fn a_canard_that_does_not_move_is_not_moved() {
    let bench = Bench::new();
    let input = ["--input", "delta_c=2deg"];
    for canard in [
        &[] as &[&str],
        &["--canard", "none"],
        &["--canard", "slaved"],
    ] {
        for model in ["dcom", "sdcom_printed"] {
            let arguments = flight(model, &with(&input, canard));
            bench.fail(&arguments, 2, &["choose --canard free"]);
        }
    }
    // What a report says is taken back.
    bench.succeed(&with(&DCOM, &["--input", "delta_c=0rad"]));
    bench.fail(
        &with(&TIMES, &["--model", "com", "--input", "delta_c=0rad"]),
        2,
        &["unknown name `delta_c`", "phi, delta_e"],
    );
}

#[test]
fn the_earth_decides_the_trim() {
    let bench = Bench::new();
    // The curvature carries 9.6 % of the weight.
    for (model, flat, spherical) in [("dcom", 1.5018, 1.25), ("com", 1.64457, 1.4056)] {
        assert!((alpha(&bench, model, &[]) - flat).abs() < 1e-4);
        assert!((alpha(&bench, model, &["--earth", "flat"]) - flat).abs() < 1e-4);
        let found = alpha(&bench, model, &["--earth", "spherical"]);
        assert!((found - spherical).abs() < 0.05, "{model}: {found} deg");
    }
}

#[test]
fn noise_and_reduction_decide_the_flight() {
    let bench = Bench::new();
    let fly = |model: &str, arguments: &[&str]| {
        bench.succeed(&flight(model, arguments));
        bench.text()
    };
    for model in ["sdcom", "sdcom_printed", "sdcom_gust"] {
        let own = fly(model, &[]);
        assert_eq!(fly(model, &["--noise", "independent"]), own);
        assert_ne!(fly(model, &["--noise", "shared"]), own);
        assert_eq!(fly(model, &["--reduction", "printed"]), own);
        let variance = fly(model, &["--reduction", "variance"]);
        assert_ne!(variance, own);
        assert_ne!(fly(model, &["--reduction", "moment"]), variance);
    }
    // After a step from rest, χ is its intensity times the one increment.
    fly("sdcom", &["--noise", "shared", "--reduction", "variance"]);
    let first = &bench.rows()[1];
    let intensities = [17.0 / 19.7437, 10.0 / 47.7851];
    assert!((first[6] / first[7] - intensities[0] / intensities[1]).abs() < 1e-12);
}

#[test]
fn the_dcom_flies_with_noise_when_told_to() {
    let bench = Bench::new();
    let fly = |arguments: &[&str]| {
        let output = bench.succeed(&with(&DCOM, &with(arguments, &["--json"])));
        (json(&output)["seed"].clone(), bench.text())
    };
    let (seed, calm) = fly(&["--seed", "3"]);
    assert!(seed.is_null());
    assert_eq!(
        fly(&["--noise", "shared"]).1,
        calm,
        "without noise it is not heard"
    );
    let (seed, noisy) = fly(&["--stochastic", "--seed", "3"]);
    assert_eq!(seed, 3);
    assert_ne!(noisy, calm);
    assert_eq!(fly(&["--stochastic", "--seed", "3"]).1, noisy);
    assert_ne!(fly(&["--stochastic", "--seed", "4"]).1, noisy);
    assert_ne!(
        fly(&["--stochastic", "--seed", "3", "--noise", "shared"]).1,
        noisy
    );
    let com = with(&TIMES, &["--model", "com", "--stochastic"]);
    bench.fail(
        &com,
        2,
        &["com has no noise; dcom, sdcom, sdcom_printed, sdcom_gust and flexible_mode have"],
    );
    bench.succeed(&with(&TIMES, &["--model", "sdcom", "--stochastic"]));
}

#[test]
fn a_choice_that_a_model_lacks_is_refused() {
    let bench = Bench::new();
    let stochastic = "sdcom, sdcom_printed, sdcom_gust and flexible_mode have it";
    let dcom = "dcom, sdcom, sdcom_printed and sdcom_gust have it";
    for (model, option, value, having) in [
        ("com", "--canard", "free", dcom),
        ("com_rigid", "--noise", "shared", dcom),
        ("com", "--reduction", "moment", stochastic),
        ("dcom", "--reduction", "printed", stochastic),
    ] {
        let arguments = with(&TIMES, &["--model", model, option, value]);
        let message = format!("{option}: {model} has no such choice; {having}");
        bench.fail(&arguments, 2, &[&message]);
    }
}

#[test]
fn unknown_options_are_listed() {
    let bench = Bench::new();
    for (option, value, known) in [
        ("--canard", "fixed", "free, slaved, none"),
        ("--earth", "round", "flat, spherical"),
        ("--noise", "white", "independent, shared"),
        ("--reduction", "exact", "printed, variance, moment"),
        ("--units", "metric", "ft-slug-s-rad, si"),
    ] {
        bench.fail(&with(&DCOM, &[option, value]), 2, &[value, known]);
        bench.fail(&with(&DCOM, &[option, ""]), 2, &[known]);
        bench.fail(&with(&DCOM, &[option]), 2, &[known]);
    }
    assert!(bench.files().is_empty());
}
