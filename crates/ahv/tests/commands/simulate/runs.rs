//! `ahv simulate` that succeeds.

use std::fs;
use std::path::PathBuf;

use super::bench::{Bench, DCOM, json, with};
use crate::command::stderr;
use serde_json::Value;

const SDCOM: [&str; 1] = ["--model sdcom --t-end 0.5 --dt 0.01"];

#[test]
fn a_trimmed_flight_stays_at_its_trim() {
    let bench = Bench::new();
    let output = bench.succeed(&with(&DCOM, &["--json"]));
    assert!(stderr(&output).is_empty(), "{}", stderr(&output));
    let text = bench.text();
    let header = text.lines().next().expect("a header");
    assert!(
        header.starts_with("time [s],velocity [ft/s],altitude [ft],gamma [rad],alpha [rad],pitch_rate [rad/s],eta_1 ["),
        "{header}"
    );
    let rows = bench.rows();
    assert_eq!(rows.len(), 51);
    assert!(rows.iter().all(|row| row.len() == 12));
    let (first, last) = (&rows[0], &rows[50]);
    assert_eq!((first[0], rows[35][0], last[0]), (0.0, 0.35, 0.5));
    assert_eq!(&first[1..3], [7702.0808, 85_000.0]);
    assert!((first[4].to_degrees() - 1.5018).abs() < 1e-4);
    assert!(
        first
            .iter()
            .zip(last)
            .skip(1)
            .all(|(a, b)| (a - b).abs() < 1e-6)
    );

    let json = json(&output);
    assert_eq!(json["model"], "dcom");
    assert_eq!(json["set"], "section5.1");
    assert_eq!(json["choices"]["canard"], "none");
    assert_eq!(json["unit_system"], "ft-slug-s-rad");
    assert_eq!(json["steps"], 50);
    assert_eq!(json["scheme"], "rk4");
    assert_eq!(json["seed"], Value::Null);
    assert_eq!(json["left_validity_box"], Value::Null);
    // serde_json reads back to a last digit.
    let alpha = json["final_state"]["alpha"].as_f64().expect("a number");
    assert!((alpha - last[4]).abs() < 1e-15);
    assert_eq!(json["units"]["alpha"], "rad");
    assert_eq!(json["out"], bench.out.display().to_string());
    assert_eq!(bench.files(), ["run.csv"]);
}

#[test]
fn the_seed_decides_the_noise() {
    let bench = Bench::new();
    let run = |seed| {
        let output = bench.succeed(&with(&SDCOM, &["--json", "--seed", seed]));
        assert_eq!(json(&output)["seed"].to_string(), seed);
        bench.text()
    };
    let (zero, one, again) = (run("0"), run("1"), run("0"));
    assert_eq!(zero, again);
    assert_ne!(zero, one);
    bench.succeed(&SDCOM);
    assert_eq!(bench.text(), zero, "the default seed is 0");
}

#[test]
fn inputs_and_initial_states_replace_those_of_the_trim() {
    let bench = Bench::new();
    let more = [
        "--input",
        "phi=0.3,delta_e=0.2rad",
        "--initial",
        "velocity=7800 ft/s,pitch_rate=-1deg/s",
        "--json",
    ];
    let output = bench.succeed(&with(&DCOM, &more));
    let first = &bench.rows()[0];
    assert_eq!(first[1], 7800.0);
    assert!((first[5].to_degrees() + 1.0).abs() < 1e-12);
    assert!(
        (first[4].to_degrees() - 1.5018).abs() < 1e-4,
        "the rest of the trim stays"
    );
    let json = json(&output);
    assert_eq!(
        (
            json["input"]["phi"].as_f64(),
            json["input"]["delta_e"].as_f64()
        ),
        (Some(0.3), Some(0.2))
    );
}

#[test]
fn the_last_step_ends_at_the_end() {
    let bench = Bench::new();
    let output = bench.succeed(&["--model dcom --t-end 0.1 --dt 0.03 --json"]);
    assert_eq!(json(&output)["steps"], 4);
    let times: Vec<f64> = bench.rows().iter().map(|row| row[0]).collect();
    assert_eq!((times.len(), times[3], times[4]), (5, 0.09, 0.1));
    let short = bench.succeed(&["--model dcom --t-end 0.1 --dt 2"]);
    let told = String::from_utf8_lossy(&short.stdout);
    assert!(
        told.starts_with("dcom: rk4, 1 step of 0.1 s to 0.1 s, written"),
        "{told}"
    );
}

#[test]
fn leaving_the_validity_box_is_a_warning() {
    let bench = Bench::new();
    let arguments = with(
        &DCOM,
        &["--initial", "alpha=11deg", "--input", "phi=1.5", "--json"],
    );
    let output = bench.succeed(&arguments);
    let message = stderr(&output);
    assert!(
        message.contains("at 0 s alpha is 11 deg, outside its validity box of -5"),
        "{message}"
    );
    assert!(message.contains("the input phi is 1.5"), "{message}");
    let json = json(&output);
    assert_eq!(json["left_validity_box"]["time"], 0.0);
    assert_eq!(json["left_validity_box"]["state"], "alpha");
    assert!(
        json["left_validity_box"]["value"]
            .as_f64()
            .is_some_and(|v| (v - 0.19199).abs() < 1e-5)
    );
    assert_eq!(json["input_outside_validity_box"]["input"], "phi");
}

#[test]
fn a_file_in_the_working_folder_needs_no_path() {
    let mut bench = Bench::new();
    let out = std::mem::replace(&mut bench.out, PathBuf::from("run.csv"));
    let status = bench
        .command(&DCOM)
        .current_dir(bench.folder.path())
        .output()
        .expect("starts")
        .status;
    assert!(status.success());
    assert!(out.exists());
}

#[cfg(unix)]
#[test]
fn permissions_are_kept_and_links_are_not_followed() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let mut bench = Bench::new();
    let target = bench.out.clone();
    fs::write(&target, "old").expect("the folder is writable");
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("it is ours");
    for link in ["link.csv", "dangling.csv"] {
        bench.out = bench.folder.path().join(link);
        let lost = bench.folder.path().join("lost.csv");
        let leads_to = if link == "link.csv" { &target } else { &lost };
        symlink(leads_to, &bench.out).expect("the folder is writable");
        let output = bench.run(&DCOM);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains("it is a link"), "{stderr}");
        assert!(bench.out.is_symlink() && !lost.exists());
    }
    assert_eq!(fs::read_to_string(&target).expect("it is there"), "old");
    bench.out = target.clone();
    bench.succeed(&DCOM);
    assert!(
        fs::read_to_string(&target)
            .expect("it is there")
            .starts_with("time [s],")
    );
    let mode = fs::metadata(&target)
        .expect("it is there")
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o640);
}

/// The last row of a flight of DCOM with a ringing mode, by a stepper.
fn ringing(bench: &Bench, scheme: &str) -> Vec<f64> {
    let flight = ["--model", "dcom", "--t-end", "0.099", "--dt", "0.002"];
    let more = ["--initial", "eta_1=0.5,eta_2=-0.3", "--scheme", scheme];
    bench.succeed(&with(&flight, &more));
    bench.rows().pop().expect("rows")
}

#[test]
fn every_stepper_flies_without_noise_at_its_order() {
    let bench = Bench::new();
    let exact = ringing(&bench, "dormand-prince853");
    assert_eq!(exact[0], 0.099);
    for (scheme, bound) in [
        ("euler", 0.3),
        ("heun", 0.01),
        ("rk4", 1e-5),
        ("rodas4", 1e-4),
        ("exponential", 1e-5),
        ("dormand-prince54", 1e-7),
        ("tsit5", 1e-7),
    ] {
        let found = ringing(&bench, scheme);
        // eta_1, whose size is 0.5.
        let error = (found[6] - exact[6]).abs();
        println!("{scheme}: {error:.1e}");
        assert!(error < bound && error > 0.0, "{scheme}: {error:e}");
    }
    let rigid = ["--model", "com_rigid", "--t-end", "0.1", "--dt", "0.01"];
    bench.fail(
        &with(&rigid, &["--scheme", "exponential"]),
        2,
        &["exponential needs one to three flexible modes", "com_rigid"],
    );
}

#[test]
fn every_scheme_flies_with_noise_that_it_admits() {
    let bench = Bench::new();
    let mode = ["--model", "flexible_mode", "--t-end", "0.1", "--dt", "0.01"];
    for (flight, schemes) in [
        (
            &SDCOM[..],
            &[
                "splitting",
                "heun",
                "euler-maruyama",
                "stratonovich-heun",
                "dri1",
            ][..],
        ),
        (
            &mode,
            &["heun", "euler-maruyama", "milstein", "sra1", "dri1"],
        ),
    ] {
        let mut texts = Vec::new();
        for scheme in schemes {
            bench.succeed(&with(flight, &["--scheme", scheme]));
            let text = bench.text();
            bench.succeed(&with(flight, &["--scheme", scheme]));
            assert_eq!(bench.text(), text, "{scheme}");
            texts.push(text);
        }
        // Milstein's scheme is Euler and Maruyama's where noise is additive; the others differ.
        texts.sort();
        texts.dedup();
        let same = usize::from(schemes.contains(&"milstein"));
        assert_eq!(texts.len() + same, schemes.len());
    }
    for (flight, scheme, reason) in [
        (&SDCOM[..], "milstein", "w_gamma and w_alpha do not commute"),
        (
            &SDCOM,
            "sra1",
            "needs additive noise, but what w_gamma does",
        ),
        (&mode, "splitting", "xi drives it and eta_dot too"),
    ] {
        let told = format!("--scheme: {scheme} is not for this flight");
        bench.fail(&with(flight, &["--scheme", scheme]), 2, &[&told, reason]);
    }
    let noisy = with(&DCOM, &["--stochastic", "--scheme", "splitting"]);
    bench.fail(
        &noisy,
        2,
        &[
            "splitting needs coloured noise, which dcom does not have",
            "heun, euler-maruyama, stratonovich-heun and dri1 are for this one",
        ],
    );
}

#[test]
fn a_scheme_for_other_flights_is_refused_with_those_for_this_one() {
    let bench = Bench::new();
    bench.fail(
        &with(&SDCOM, &["--scheme", "tsit5"]),
        2,
        &[
            "--scheme: tsit5 is not for a flight with noise",
            "splitting, heun, euler-maruyama, stratonovich-heun and dri1 are for this one",
        ],
    );
    bench.fail(
        &with(&DCOM, &["--scheme", "dri1"]),
        2,
        &[
            "--scheme: dri1 is not for a flight without noise",
            "euler, heun, rk4, dormand-prince54, tsit5, dormand-prince853, rodas4 and exponential are",
        ],
    );
    bench.fail(
        &with(&DCOM, &["--scheme", "rk5"]),
        2,
        &["invalid value 'rk5'", "rk4", "dri1"],
    );
}
