//! `ahv montecarlo`, through the real binary.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::command::{ahv as run, json};

const FEW: [&str; 1] = ["montecarlo --model sdcom --members 100 --t-end 0.1 --dt 0.01"];

#[test]
fn the_same_seed_gives_the_same_numbers_on_any_threads() {
    let one = json(&[&FEW[..], &["--threads", "1"]].concat());
    let two = json(&[&FEW[..], &["--threads", "2"]].concat());
    for key in ["members", "mean", "std", "digest", "snapshots"] {
        assert_eq!(one[key], two[key], "{key}");
    }
    assert_eq!(one["members"], 100);
    assert_eq!(one["threads"], 1);
    // No more than the machine runs at once, nor than there are batches of eight.
    let many = json(&[&FEW[..], &["--threads", "100000"]].concat());
    assert_eq!(many["digest"], one["digest"]);
    assert!(
        many["threads"]
            .as_u64()
            .is_some_and(|threads| (1..=13).contains(&threads))
    );
    assert!(
        one["member_steps_per_second"]
            .as_f64()
            .is_some_and(|rate| rate > 0.0)
    );
    assert_eq!(one["digest"].as_str().map(str::len), Some(64));
    assert!(one["std"]["alpha"].as_f64().is_some_and(|std| std > 0.0));
    let other = json(&[&FEW[..], &["--seed", "1"]].concat());
    assert_ne!(one["digest"], other["digest"]);
}

/// A hundred members have no rank for the ends of a 0.5 % quantile: the side is open, not the sample's end.
#[test]
fn a_side_of_a_quantile_without_a_rank_is_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let told = json(&[&FEW[..], &["--out", &out]].concat());
    let snapshots = told["snapshots"].as_array().expect("a list");
    let quantiles = &snapshots[10]["quantiles"]["alpha"];
    let (lowest, median, highest) = (&quantiles[0], &quantiles[3], &quantiles[6]);
    assert_eq!(
        (&lowest["share"], &lowest["low"]),
        (&0.005.into(), &Value::Null)
    );
    assert_eq!(highest["high"], Value::Null);
    for (quantile, ends) in [
        (lowest, &["value", "high"][..]),
        (median, &["low", "value", "high"]),
        (highest, &["low", "value"]),
    ] {
        let ends: Vec<f64> = ends
            .iter()
            .filter_map(|end| quantile[*end].as_f64())
            .collect();
        assert!(ends.len() >= 2 && ends.is_sorted(), "{quantile}");
    }
    let table = fs::read_to_string(folder.path().join("snapshots.csv")).expect("rows");
    let mut rows = csv(&table);
    let heading = rows.remove(0);
    let column = |name: &str| heading.iter().position(|it| it == name).expect("a column");
    let last = rows.iter().rfind(|row| row[2] == "alpha").expect("a row");
    assert_eq!(last[column("quantile_0.005_low")], "");
    assert_ne!(last[column("quantile_0.005_high")], "");
    assert_eq!(last[column("quantile_0.995_high")], "");
    let printed = String::from_utf8(run(&FEW).stdout).expect("text");
    let (row, note) = (alpha(&printed), "\n* the sample is too small");
    assert!(
        row.iter().rev().take(2).all(|it| it.ends_with('*')),
        "{printed}"
    );
    assert!(printed.contains(note), "{printed}");
}

/// The cells of the angle of attack in the printed table, which fits 100 columns.
fn alpha(printed: &str) -> Vec<&str> {
    let table = printed.lines().filter(|line| line.starts_with("  "));
    assert!(
        table.clone().all(|line| line.chars().count() <= 100),
        "{printed}"
    );
    let mut rows = table.map(|line| line.split_whitespace().collect::<Vec<_>>());
    rows.find(|row| row[0] == "alpha").expect("a row")
}

/// The pitching moment decides where an airframe without feedback goes, not the draw of another parameter.
#[test]
fn what_the_states_have_to_do_with_is_told() {
    let line = "montecarlo --model dcom --disperse --members 400 --t-end 0.5 --dt 0.02";
    let arguments: Vec<&str> = line.split(' ').collect();
    let found = &json(&arguments)["rank_correlations"];
    let of = |name: &str| {
        let mut causes = found.as_array().expect("a list").iter();
        causes.find(|it| it["of"] == name).expect("there")["correlations"].clone()
    };
    assert_eq!(of("lost"), serde_json::json!({}));
    let pitch = of("pitch_rate");
    let pitch = pitch.as_object().expect("names");
    assert!(
        pitch.keys().all(|name| !name.starts_with("rho_")),
        "{pitch:?}"
    );
    assert!(
        pitch.keys().any(|name| name.starts_with("c_m")),
        "{pitch:?}"
    );
    let printed = String::from_utf8(run(&arguments).stdout).expect("text");
    assert!(printed.contains("\n  pitch_rate   c_m"), "{printed}");
    let plain = json(&FEW);
    assert!(plain["rank_correlations"].is_null());
}

/// Two members or three have no kurtosis, and no interval of a standard deviation.
#[test]
fn the_deviation_of_a_few_members_is_open() {
    for (members, open) in [("2", true), ("3", true), ("4", false)] {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().display().to_string();
        let line = format!(
            "montecarlo --model sdcom --members {members} --t-end 0.1 --dt 0.01 --out {out}"
        );
        let arguments: Vec<&str> = line.split(' ').collect();
        let std = json(&arguments)["snapshots"][10]["std"]["alpha"].clone();
        assert!(
            std["value"].as_f64().is_some_and(|value| value > 0.0),
            "{std}"
        );
        assert_eq!(
            [std["low"].is_null(), std["high"].is_null()],
            [open; 2],
            "{std}"
        );
        let printed = String::from_utf8(run(&arguments).stdout).expect("text");
        assert_eq!(alpha(&printed)[5..7] == ["open", "open"], open, "{printed}");
        let table = fs::read_to_string(folder.path().join("snapshots.csv")).expect("rows");
        let rows = csv(&table);
        let column = rows[0]
            .iter()
            .position(|it| it == "std_low")
            .expect("a column");
        let row = rows.iter().rfind(|row| row[2] == "alpha").expect("a row");
        assert_eq!(row[column].is_empty(), open);
    }
}

/// Members that left the box make the moments: said, with what they are without them. The normal spread of chi is no such case.
#[test]
fn members_that_swamp_the_moments_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let gains = folder.path().join("gains.json").display().to_string();
    assert!(run(&["lqr --model dcom --out", &gains]).status.success());
    let line = format!(
        "montecarlo --model dcom --members 400 --t-end 2 --dt 0.005 --feedback {gains} --json"
    );
    let arguments: Vec<&str> = line.split(' ').collect();
    let calm = run(&arguments);
    assert!(!String::from_utf8_lossy(&calm.stderr).contains("warning"));
    let wild = run(&[&arguments[..], &["--disperse"]].concat());
    let message = String::from_utf8_lossy(&wild.stderr);
    for words in [
        "members that fly at the end had left the validity box",
        "pitch_rate",
        "quantiles",
    ] {
        assert!(message.contains(words), "{message}");
    }
    let told: Value = serde_json::from_slice(&wild.stdout).expect("JSON");
    let std = |key: &str| told[key]["pitch_rate"].as_f64().expect("a number");
    assert!(std("std") > 3.0 * std("std_inside_validity_box"));
}

fn csv(text: &str) -> Vec<Vec<String>> {
    let row = |line: &str| line.split(',').map(str::to_owned).collect();
    text.lines().map(row).collect()
}

#[test]
fn files_hold_what_was_flown_and_feedback_follows_the_gains() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let gains = path("gains.json");
    assert!(run(&["lqr --model sdcom --out", &gains]).status.success());
    let out = path("out");
    let options = [
        "--feedback",
        &gains,
        "--disperse",
        "--state-std",
        "altitude=10ft",
        "--limit",
        "alpha=1deg..1.6deg",
        "--trajectories",
        "0,99",
        "--out",
        &out,
    ];
    let told = json(&[&FEW[..], &options].concat());
    assert_eq!(
        (&told["feedback"], &told["dispersed"]),
        (&true.into(), &true.into())
    );
    let summary = fs::read_to_string(Path::new(&out).join("summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(summary["digest"], told["digest"]);
    for name in [
        "montecarlo.svg",
        "snapshots.csv",
        "histograms.csv",
        "limits.csv",
    ] {
        assert!(Path::new(&out).join(name).is_file(), "{name}");
    }
    let trajectories = fs::read_to_string(Path::new(&out).join("trajectories.csv")).expect("rows");
    assert_eq!(trajectories.lines().count(), 1 + 2 * 11);
    assert!(trajectories.starts_with("member,time [s],velocity [ft/s]"));
    #[cfg(feature = "parquet")]
    {
        let parquet = [&options[..], &["--trajectory-format", "parquet"]].concat();
        json(&[&FEW[..], &parquet].concat());
        let bytes = fs::read(Path::new(&out).join("trajectories.parquet")).expect("a file");
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    }
}

#[test]
fn bad_requests_are_refused_with_a_reason() {
    for (options, words) in [
        (&["--scheme", "milstein"][..], "do not commute"),
        (&["--limit", "alpha=3"], "NAME=LOW..HIGH"),
        (&["--limit", "alpha=3deg..2deg"], "not below"),
        (&["--state-std", "alpah=1deg"], "alpha"),
        (&["--feedback", "no-such-file.json"], "no-such-file.json"),
        (
            &[
                "--trajectories",
                "100",
                "--out",
                env!("CARGO_TARGET_TMPDIR"),
            ],
            "no member 100",
        ),
        (&["--trajectories", "0"], "--out"),
    ] {
        let output = run(&[&FEW[..], options].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{options:?}: {message}");
        assert!(message.contains(words), "{message}");
    }
    let com = run(&["montecarlo --model com --members 9 --t-end 1"]);
    assert_eq!(com.status.code(), Some(2));
}

/// Flights that end elsewhere than asked, and files of an earlier run beside new ones, are told.
#[test]
fn another_end_and_earlier_files_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let told = |rest: &str| {
        let line = format!("montecarlo --model sdcom --members 4 --dt 0.1 --out {out} {rest}");
        let arguments: Vec<&str> = line.split_whitespace().collect();
        String::from_utf8(run(&arguments).stderr).expect("text")
    };
    let whole = told("--t-end 0.3 --trajectories 0");
    assert!(!whole.contains("the flights end at"), "{whole}");
    let other = told("--t-end 0.35");
    assert!(
        other.contains("note: the flights end at 0.3 s") || other.contains("at 0.4 s"),
        "{other}"
    );
    assert!(
        other.contains("trajectories.csv is of an earlier run"),
        "{other}"
    );
    assert!(folder.path().join("trajectories.csv").exists());
}
