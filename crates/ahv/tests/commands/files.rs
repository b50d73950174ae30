//! What commands write, and in which order.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::{ahv as run, stderr};

/// Commands that draw, with a figure that cannot be drawn or has a panel without data.
#[test]
fn a_picture_that_cannot_be_drawn_loses_no_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = |name: &str| folder.path().join(name).display().to_string();
    // No effect of the gust on trim and roots: no bars.
    let path = out("d");
    fs::create_dir(&path).expect("a folder");
    let picture = Path::new(&path).join("sensitivities.svg");
    fs::write(&picture, "of an earlier run").expect("written");
    let drawn = run(&[
        "disperse --model dcom --members 30 --vary gust_rms --out",
        &path,
    ]);
    assert_eq!(drawn.status.code(), Some(0), "{}", stderr(&drawn));
    assert!(stderr(&drawn).contains("sensitivities.svg is not drawn: no parameter that varies"));
    assert!(String::from_utf8_lossy(&drawn.stdout).contains("30 members"));
    let members = fs::read_to_string(Path::new(&path).join("members.csv")).expect("a list");
    assert_eq!(members.lines().count(), 31);
    assert!(Path::new(&path).join("trim.svg").is_file() && !picture.exists());
    // All members are lost before the end: no distribution there.
    let path = out("m");
    let drawn = run(&[
        "montecarlo --model sdcom --members 8 --t-end 100 --dt 0.5 --scheme heun --out",
        &path,
    ]);
    assert_eq!(drawn.status.code(), Some(0), "{}", stderr(&drawn));
    assert!(Path::new(&path).join("summary.json").is_file());
    let list = fs::read_to_string(Path::new(&path).join("members.csv")).expect("a list");
    assert_eq!(list.matches(",lost,").count(), 8, "{list}");
}

/// Before the work: the runs would take hours.
#[test]
fn a_place_that_cannot_be_written_is_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "mine").expect("written");
    let out = file.to_str().expect("text");
    for arguments in [
        &["track --runs 100000"][..],
        &["montecarlo --model sdcom --members 1000000000 --t-end 1"],
        &["disperse --model dcom --members 1000000"],
        &["covariance --model sdcom --members 1000000 --t-end 100"],
        &["reduce --runs 1000000 --t-end 100"],
        &["trim --model com --map 50x50"],
        &["poles --model dcom"],
        &["reproduce"],
        // A file in a file.
        &["simulate --model com --t-end 100 --dt 1e-5"],
    ] {
        let inner = file.join("f.csv").display().to_string();
        let out = if arguments[0].starts_with("simulate") {
            &inner
        } else {
            out
        };
        let output = run(&[arguments, &["--out", out]].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(
            message.contains("cannot") && message.contains(out),
            "{message}"
        );
        assert!(output.stdout.is_empty());
    }
    assert_eq!(fs::read_to_string(&file).expect("a file"), "mine");
}

/// Of a disk that is full: the numbers are there, and the picture is not.
#[cfg(unix)]
#[test]
fn numbers_are_written_before_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m");
    let flights = "montecarlo --model sdcom --members 64 --t-end 0.1 --dt 0.01 --snapshots 1 --out";
    let (ahv, place) = (env!("CARGO_BIN_EXE_ahv"), out.display());
    // No file grows beyond so many blocks, of 512 bytes or of 1024.
    let script = format!("trap '' XFSZ; ulimit -f 90; exec {ahv} {flights} {place}");
    let output = Command::new("sh")
        .args(["-c", &script])
        .output()
        .expect("a shell");
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("montecarlo.svg: File too large"),
        "{message}"
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("64 flights"));
    let files = [
        "summary.json",
        "snapshots.csv",
        "histograms.csv",
        "limits.csv",
        "members.csv",
    ];
    for name in files {
        assert!(out.join(name).is_file(), "{name}");
    }
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), files.len());
}

/// The same vehicle for the same seed and member, in both commands that draw vehicles.
#[test]
fn disperse_and_montecarlo_draw_the_same_vehicles() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = |name: &str, arguments: &[&str]| -> Vec<Vec<String>> {
        let out = folder.path().join(name);
        let place = ["--seed", "7", "--out", out.to_str().expect("text")];
        let output = run(&[arguments, &place].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let text = fs::read_to_string(out.join("members.csv")).expect("a list");
        let rows = text
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect());
        rows.collect()
    };
    let drawn = table("d", &["disperse --model dcom --members 40"]);
    let flown = table(
        "m",
        &["montecarlo --model dcom --members 40 --t-end 0.01 --disperse"],
    );
    assert_eq!((drawn.len(), flown.len()), (41, 41));
    let mut compared = 0;
    for (column, name) in flown[0].iter().enumerate() {
        let Some(other) = drawn[0].iter().position(|it| it == name) else {
            continue;
        };
        if name == "outcome" {
            continue;
        }
        compared += 1;
        for (drawn, flown) in drawn.iter().zip(&flown) {
            assert_eq!(drawn[other], flown[column], "{name}");
        }
    }
    // The member's number, and all parameters that are uncertain.
    assert!(compared > 60, "{compared}");
    assert!(flown[0].iter().any(|name| name == "last_velocity [ft/s]"));
}

/// 35 · 0.01 is 0.35.
#[test]
fn times_are_written_as_they_are_meant() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("text");
    let output = run(&[
        "montecarlo --model sdcom --members 8 --t-end 1 --dt 0.01 --snapshots 100 --trajectories 0 --json --out",
        out,
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let short = |text: &str| assert!(text.len() <= 4, "{text}");
    for name in ["snapshots.csv", "limits.csv"] {
        let text = fs::read_to_string(folder.path().join(name)).expect("rows");
        let times = text
            .lines()
            .skip(1)
            .filter_map(|line| line.split(',').next());
        times.for_each(short);
    }
    let text = fs::read_to_string(folder.path().join("trajectories.csv")).expect("rows");
    let times = text
        .lines()
        .skip(1)
        .filter_map(|line| line.split(',').nth(1));
    assert_eq!(times.clone().count(), 101);
    times.for_each(short);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let snapshots = json["snapshots"].as_array().expect("a list");
    snapshots
        .iter()
        .for_each(|it| short(&it["time"].to_string()));
}
