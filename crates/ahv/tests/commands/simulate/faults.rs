//! `ahv simulate` that fails.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use super::bench::{Bench, DCOM, with};
use crate::command::stderr;

/// A step so long that the third mode grows by five powers of ten a step.
const DIVERGING: [&str; 1] = ["--model dcom --t-end 500 --dt 0.5 --initial eta_3=1"];

#[test]
fn bad_values_are_explained() {
    let bench = Bench::new();
    let bad: [(&str, &str, &[&str]); 14] = [
        (
            "--initial",
            "alpha=1.5",
            &["alpha is an angle", "alpha=1.5deg or alpha=1.5rad"],
        ),
        (
            "--initial",
            "pitch_rate=1",
            &["pitch_rate=1deg/s or pitch_rate=1rad/s"],
        ),
        ("--initial", "pitch_rate=1deg", &["`1deg`", "deg/s"]),
        (
            "--initial",
            "alfa=1deg",
            &["unknown name `alfa`", "did you mean `alpha`?"],
        ),
        (
            "--initial",
            "zzz=1",
            &["unknown name `zzz`; known: velocity"],
        ),
        ("--initial", "velocity=2000m/s", &["`2000m/s`", "ft/s"]),
        ("--initial", "velocity=nan", &["not a finite number"]),
        ("--initial", "velocity=1e999", &["not a finite number"]),
        ("--initial", "alpha=infrad", &["not a finite number"]),
        ("--input", "phi", &["--input", "NAME=VALUE"]),
        ("--input", "", &["NAME=VALUE"]),
        ("--input", "phi=0.3deg", &["`0.3deg`", "bare number"]),
        ("--input", "phi=0.2,phi=0.3", &["`phi=0.3`", "second time"]),
        ("--input", "delta=1deg", &["did you mean `delta_"]),
    ];
    for (option, value, words) in bad {
        bench.fail(&with(&DCOM, &[option, value]), 2, words);
    }
    assert!(bench.files().is_empty());
}

#[test]
fn bad_times_are_explained() {
    let bench = Bench::new();
    for value in ["0", "-1", "nan", "inf"] {
        for (t_end, dt) in [(value, "0.01"), ("1", value)] {
            let arguments = [
                "--model",
                "dcom",
                &format!("--t-end={t_end}"),
                &format!("--dt={dt}"),
            ];
            bench.fail(&arguments, 2, &["must be positive and finite"]);
        }
    }
    bench.fail(
        &["--model dcom --t-end", "3 s", "--dt", "0.01"],
        2,
        &["number of seconds"],
    );
    bench.fail(
        &["--model dcom --t-end 1e6 --dt 1e-6"],
        2,
        &["1.000e12 steps", "--dt"],
    );
    bench.fail(
        &["--model flexible --t-end 1 --dt 0.1"],
        2,
        &["com_rigid", "dcom"],
    );
    assert!(bench.files().is_empty());
}

#[test]
fn a_numeric_failure_leaves_the_old_file() {
    let bench = Bench::new();
    fs::write(&bench.out, "precious").expect("the folder is writable");
    bench.fail(
        &DIVERGING,
        3,
        &[
            "became",
            "the last good state, at ",
            "was not written",
            "velocity ",
        ],
    );
    let deep = with(&DCOM, &["--initial", "altitude=-1e300ft"]);
    bench.fail(&deep, 3, &["after 0 s ", "the last good state, at 0 s"]);
    let still = with(&DCOM, &["--initial", "velocity=0"]);
    bench.fail(&still, 2, &["velocity must be above 0"]);
    assert_eq!(bench.text(), "precious");
    assert_eq!(bench.files(), ["run.csv"]);
}

#[test]
fn a_trim_that_does_not_exist_is_a_numeric_failure() {
    let bench = Bench::new();
    let arguments = with(&DCOM, &["--canard", "free", "--input", "delta_c=1e300rad"]);
    bench.fail(&arguments, 3, &["trim", "7702.0808 ft/s"]);
    assert!(bench.files().is_empty());
}

#[test]
fn places_that_cannot_be_written_are_explained() {
    let mut bench = Bench::new();
    bench.out = bench.folder.path().join("missing").join("run.csv");
    bench.fail(&DCOM, 2, &["cannot write", "run.csv: No such file"]);
    bench.out = bench.folder.path().to_owned();
    bench.fail(&DCOM, 2, &["cannot write", "not a regular file"]);
    bench.out = PathBuf::new();
    bench.fail(&DCOM, 2, &["--out"]);
    bench.out = bench.folder.path().join("..");
    bench.fail(&DCOM, 2, &["not a regular file"]);
    bench.out = bench.folder.path().join("protected.csv");
    fs::write(&bench.out, "precious").expect("the folder is writable");
    let mut permissions = fs::metadata(&bench.out).expect("it is there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&bench.out, permissions).expect("it is ours");
    bench.fail(&DCOM, 2, &["write-protected"]);
    assert_eq!(bench.text(), "precious");
}

#[cfg(target_os = "linux")]
#[test]
fn a_stdout_that_fails_or_closes_is_no_panic() {
    let bench = Bench::new();
    let full = fs::OpenOptions::new()
        .write(true)
        .open(Path::new("/dev/full"))
        .expect("Linux has it");
    let output = bench
        .command(&DCOM)
        .stdout(full)
        .output()
        .expect("ahv starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("cannot write to stdout"),
        "{}",
        stderr(&output)
    );

    let mut child = bench
        .command(&DCOM)
        .stdout(Stdio::piped())
        .spawn()
        .expect("ahv starts");
    drop(child.stdout.take());
    assert!(child.wait().expect("ahv ends").success());
}
