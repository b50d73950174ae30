//! SIGINT and SIGTERM: what was done is reported, and no temporary file is left.
#![cfg(unix)]
#![forbid(unsafe_code)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;

/// Starts `ahv` with these words; the first text may be several, with blanks between them.
fn start(words: &[&str]) -> Child {
    let (line, others) = words.split_first().expect("a word");
    let mut command = Command::new(env!("CARGO_BIN_EXE_ahv"));
    let command = command.args(line.split_whitespace()).args(others);
    let command = command.stdin(Stdio::null());
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("ahv starts")
}

fn folder() -> (TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("text").to_owned();
    (folder, path)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|it| it.expect("an entry").file_name());
    let mut names: Vec<_> = names.map(|it| it.into_string().expect("text")).collect();
    names.sort();
    names
}

/// Waits until there is a temporary file, and works for a while.
fn at_work(folder: &Path) {
    for _ in 0..2000 {
        if names(folder).iter().any(|name| name.ends_with(".tmp")) {
            return sleep(Duration::from_millis(400));
        }
        sleep(Duration::from_millis(20));
    }
    panic!("no temporary file in 40 s");
}

fn end(child: Child, signal: &str) -> Output {
    let id = child.id().to_string();
    let sent = Command::new("kill").args([signal, &id]).status();
    assert!(sent.expect("a signal").success());
    child.wait_with_output().expect("it ends")
}

fn json(output: &Output) -> Value {
    let errors = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("no JSON: {errors}"))
}

/// A part of the members is reported as a run of so many, and says that it is a part.
#[test]
fn montecarlo_reports_the_members_that_were_flown() {
    let flights = |members: &str, out: &str| {
        start(&[
            "montecarlo --model sdcom --members",
            members,
            "--t-end",
            "2",
            "--dt",
            "0.01",
            "--threads",
            "2",
            "--disperse",
            "--json",
            "--out",
            out,
        ])
    };
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let (part, out) = folder();
        let child = flights("1000000", &out);
        at_work(part.path());
        let output = end(child, signal);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let told = json(&output);
        assert_eq!(
            (&told["complete"], &told["asked"]),
            (&false.into(), &1_000_000.into())
        );
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(
            message.contains("interrupted") && message.contains("of 1000000"),
            "{message}"
        );
        let read = |name: &str| fs::read_to_string(part.path().join(name)).expect(name);
        let summary: Value = serde_json::from_str(&read("summary.json")).expect("JSON");
        assert_eq!(summary["complete"], false);
        let snapshots = read("snapshots.csv");
        assert!(
            snapshots
                .lines()
                .skip(1)
                .all(|line| line.ends_with(",false"))
        );
        assert!(read("montecarlo.svg").contains("interrupted: "));
        let members = told["members"].as_u64().expect("a number");
        let list = read("members.csv");
        assert_eq!(list.lines().count() as u64, 1 + members);
        assert!(list.lines().skip(1).all(|line| line.ends_with(",false")));
        // Those in flight are not among them.
        assert_eq!(told["member_steps"].as_u64(), Some(200 * members));
        assert!(
            names(part.path())
                .iter()
                .all(|name| !name.ends_with(".tmp"))
        );

        let (whole, out) = folder();
        let output = flights(&members.to_string(), &out).wait_with_output();
        let again = json(&output.expect("it ends"));
        for key in ["members", "mean", "std", "digest", "snapshots", "lost"] {
            assert_eq!(told[key], again[key], "{key}");
        }
        assert_eq!(again["complete"], true);
        // But for its mark, in the last column.
        let again = fs::read_to_string(whole.path().join("members.csv")).expect("a list");
        assert!(again.lines().skip(1).all(|line| line.ends_with(",true")));
        let marked = |line: &str| {
            line.strip_suffix(",true")
                .map(|cells| format!("{cells},false"))
        };
        let marked = again
            .lines()
            .map(|line| marked(line).unwrap_or_else(|| line.to_owned()));
        assert!(marked.eq(list.lines()));
    }
}

#[test]
fn nothing_is_left_of_a_simulation() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let (place, _) = folder();
        let out = place.path().join("flight.csv");
        let out = out.to_str().expect("text");
        let child = start(&["simulate --model com_rigid --t-end 10 --dt 1e-7 --out", out]);
        at_work(place.path());
        let output = end(child, signal);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        assert_eq!(names(place.path()), Vec::<String>::new());
    }
}

#[test]
fn disperse_reports_the_members_that_were_drawn() {
    let (place, out) = folder();
    let child = start(&["disperse --model dcom --members 1000000 --json --out", &out]);
    sleep(Duration::from_secs(2));
    let output = end(child, "-INT");
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let told = json(&output);
    let members = told["members"].as_u64().expect("a number");
    assert_eq!(
        (&told["complete"], &told["asked"]),
        (&false.into(), &1_000_000.into())
    );
    let list = fs::read_to_string(place.path().join("members.csv")).expect("a list");
    assert_eq!(list.lines().count() as u64, 1 + members);
    assert!(
        names(place.path())
            .iter()
            .all(|name| !name.ends_with(".tmp"))
    );
}

#[test]
fn covariance_reports_the_flights_that_were_flown() {
    let (place, out) = folder();
    let child = start(&[
        "covariance --model sdcom --t-end 0.2 --dt 0.002 --members 1000000 --json --out",
        &out,
    ]);
    sleep(Duration::from_secs(4));
    let output = end(child, "-INT");
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let outcome = json(&output);
    assert_eq!(outcome["complete"], false);
    let members = outcome["members"].as_u64().expect("a number");
    assert!(members > 0 && members < 1_000_000);
    let read = |name: &str| fs::read_to_string(place.path().join(name)).expect("a file");
    assert!(read("covariance.csv").trim_end().ends_with(",false"));
    assert!(read("covariance.svg").contains("interrupted: "));
    let said = String::from_utf8_lossy(&output.stderr);
    let part = format!("interrupted: {members} of 1000000 flights were flown, and are reported");
    assert!(said.contains(&part), "{said}");
}

/// The repetitions that were flown make an estimate of their own, which says that it is a part.
#[test]
fn rare_reports_the_repetitions_that_were_flown() {
    let flights = |repetitions: &str| {
        let line = "rare --model sdcom --t-end 0.2 --dt 0.002 --scheme euler-maruyama --effort 200 --passes chi_1=0.5 --threads 1 --json";
        let flags = ["--repetitions", repetitions];
        start(&line.split(' ').chain(flags).collect::<Vec<_>>())
    };
    let child = flights("10000");
    sleep(Duration::from_secs(3));
    let output = end(child, "-INT");
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let told = json(&output);
    let flown = told["repetitions"].as_u64().expect("a number");
    assert!((10..10_000).contains(&flown), "{flown}");
    assert_eq!(
        (&told["complete"], &told["asked"]),
        (&false.into(), &10_000.into())
    );
    let message = String::from_utf8_lossy(&output.stderr);
    let words = format!("interrupted: {flown} of 10000 repetitions were flown, and are reported");
    assert!(message.contains(&words), "{message}");
    let again = json(
        &flights(&flown.to_string())
            .wait_with_output()
            .expect("it ends"),
    );
    for key in [
        "probability",
        "levels",
        "repetitions",
        "member_steps",
        "lost",
    ] {
        assert_eq!(told[key], again[key], "{key}");
    }
    assert_eq!(again["complete"], true);
}

/// Without an estimate it says what was flown, and that there is none.
#[test]
fn rare_without_an_estimate_says_so() {
    let line = "rare --model sdcom --t-end 100 --passes chi_1=1 --effort 100000 --threads 1";
    let child = start(&line.split(' ').collect::<Vec<_>>());
    sleep(Duration::from_secs(1));
    let output = end(child, "-INT");
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    assert!(output.stdout.is_empty());
    let message = String::from_utf8_lossy(&output.stderr);
    for words in [
        "the pilot had set",
        "0 of 20 repetitions",
        "there is no estimate",
    ] {
        assert!(message.contains(words), "{message}");
    }
}

/// What has no part to report ends at once.
#[test]
fn other_work_ends_at_once() {
    for arguments in [
        &["rare --model sdcom --t-end 100 --passes chi_1=1 --effort 100000"][..],
        &["covariance --model sdcom --t-end 1 --dt 0.00001 --members 100000"],
    ] {
        let child = start(arguments);
        sleep(Duration::from_secs(1));
        let output = end(child, "-TERM");
        assert_eq!(output.status.code(), Some(143), "{output:?}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains("interrupted"), "{message}");
    }
}
