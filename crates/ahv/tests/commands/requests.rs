//! Requests that cannot be met, or make no sense: what is said of them.

use std::fs::File;
use std::process::Command;

use crate::command::{fail, text};

fn refused(line: &str, words: &[&str]) {
    fail(&[line], 2, words);
}

fn told(line: &str) -> String {
    text(&[line])
}

/// Every command that steps says so, whichever flag is to blame, before it works.
#[test]
fn a_flight_of_too_many_steps_is_refused() {
    let out = env!("CARGO_TARGET_TMPDIR");
    let simulate = format!("simulate --model com --out {out}/never.csv --dt 1e-3 --t-end");
    for flight in [
        "covariance --model sdcom --t-end",
        "montecarlo --model sdcom --members 8 --dt 1e-3 --t-end",
        "rare --model sdcom --passes alpha=2deg --dt 1e-3 --t-end",
        "reduce --t-end",
        &simulate,
    ] {
        let words = ["--t-end 1e308", "--dt 0.0", "steps; 1 to 1e", "larger --dt"];
        refused(&format!("{flight} 1e308"), &words);
    }
    refused(
        "covariance --model sdcom --dt 1e-9",
        &["1.000e9 steps; 1 to 1e8"],
    );
    refused("reduce --dt 1e-300", &["--dt 1e-300 makes"]);
    refused("reduce --dt 1e300", &["makes 0 steps", "smaller --dt"]);
}

/// A model without noise flies where something else spreads; elsewhere those with noise are named.
#[test]
fn a_model_without_noise_needs_another_spread() {
    let noisy = "com has no noise; dcom, sdcom, sdcom_printed, sdcom_gust and flexible_mode have";
    for (command, spread) in [
        ("montecarlo --members 9 --t-end 0.1", Some("--disperse")),
        (
            "covariance --members 30 --t-end 0.1",
            Some("--state-std altitude=9ft"),
        ),
        ("rare --passes alpha=2deg --t-end 1", None),
    ] {
        let command = format!("{command} --model com");
        refused(&command, &["--model", noisy]);
        if let Some(spread) = spread {
            told(&format!("{command} {spread}"));
        }
    }
}

#[test]
fn nothing_flies_without_velocity() {
    let out = env!("CARGO_TARGET_TMPDIR");
    let simulate =
        format!("simulate --model com --t-end 1 --dt 0.1 --out {out}/still.csv --initial");
    for velocity in ["0ft/s", "-1ft/s"] {
        refused(
            &format!("{simulate} velocity={velocity}"),
            &["velocity must be above 0"],
        );
    }
    refused("trim --model com --velocity 0", &["--velocity", "above 0"]);
}

#[test]
fn an_input_without_effect_is_named() {
    let alone = told("poles --model sdcom --canard none --inputs delta_c");
    let words = "delta_c has no effect with the canard none; choose --canard free: no derivative of a state depends on it";
    assert!(
        alone.contains(words) && !alone.contains("rank 0"),
        "{alone}"
    );
    assert!(told("poles --model sdcom --canard none --inputs phi,delta_c").contains(words));
    assert!(!told("poles --model sdcom --canard free --inputs phi,delta_c").contains("no effect"));
}

/// Coloured noise that shares its channel with the mode cannot be split off.
#[test]
fn a_mode_flies_without_a_scheme_by_name() {
    told("montecarlo --model flexible_mode --members 9 --t-end 0.1");
    told("covariance --model flexible_mode --members 30 --t-end 0.1");
}

/// Damping so large that one decay rate is nothing beside the other: a sum holds both.
#[test]
fn a_mode_of_any_damping_is_reduced() {
    for zeta in ["1e8", "1e20", "1e100"] {
        for method in ["printed", "variance", "moment"] {
            told(&format!(
                "reduce --omega 20 --zeta {zeta} --sigma 100 --runs 30 --method {method}"
            ));
        }
    }
    let moment = told("reduce --omega 20 --zeta 1e8 --sigma 100 --runs 30 --method moment");
    assert!(moment.contains("decay 1.000000e-7 1/s"), "{moment}");
    assert!(
        moment.contains("keeps decay rate, variance and spectrum at zero frequency"),
        "{moment}"
    );
}

/// A help that nobody can read is a failure, as any other outcome is.
#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_a_failure_of_the_help_too() {
    for arguments in [&["--help"][..], &["--version"], &["trim", "--help"]] {
        let full = File::options()
            .write(true)
            .open("/dev/full")
            .expect("a full device");
        let mut command = Command::new(env!("CARGO_BIN_EXE_ahv"));
        let status = command.args(arguments).stdout(full).status();
        assert_eq!(status.expect("ahv starts").code(), Some(2), "{arguments:?}");
    }
}

/// Values stand in the unit in which they are asked for, and a unit of the other system is named.
#[test]
fn units_of_values_are_explained() {
    let flight = "covariance --model sdcom --members 30 --t-end 0.1";
    let members = "montecarlo --model sdcom --members 8 --t-end 0.1";
    for (line, words) in [
        (
            format!("{flight} --units si --state-std altitude=50ft"),
            ["`50ft`", "altitude is in m, not in ft", "altitude=50m"],
        ),
        (
            format!("{flight} --state-std altitude=1e3m"),
            ["`1e3m`", "altitude is in ft, not in m", "altitude=1e3ft"],
        ),
        (
            format!("{flight} --state-std alpha=-1deg"),
            ["--state-std", "alpha is -1 deg", "0 or more"],
        ),
        (
            format!("{members} --limit alpha=0..3deg"),
            ["--limit", "needs a unit", "alpha=0deg..3deg"],
        ),
        (
            format!("{flight} --state-std alpha=nan"),
            ["--state-std", "`nan`", "not a finite number"],
        ),
        (
            format!("{members} --limit alpha=3deg..2deg"),
            ["--limit", "lower limit 3 deg", "upper one 2 deg"],
        ),
    ] {
        refused(&line, &words);
    }
}
