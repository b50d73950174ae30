//! `ahv simulate --tolerance`.

use serde_json::Value;

use super::bench::{Bench, json};

/// Off its trim, where all of it moves.
fn flight(more: &str) -> String {
    format!("--model dcom --initial alpha=1.6deg --t-end 1 {more}")
}

#[test]
fn errors_follow_the_tolerance() {
    let bench = Bench::new();
    let last = |more: &str| {
        bench.succeed(&[&flight(more)]);
        bench.rows().pop().expect("a row")
    };
    let exact = last("--dt 0.0001");
    for scheme in ["dormand-prince54", "tsit5", "dormand-prince853", "rodas4"] {
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let found = last(&format!(
                "--dt 0.25 --scheme {scheme} --tolerance {tolerance:e}"
            ));
            // In units of the values, which are below those of the box but for the velocity and the altitude.
            let error = |(a, b): (&f64, &f64)| (a - b).abs() / (1.0 + b.abs());
            let worst = found.iter().zip(&exact).map(error).fold(0.0, f64::max);
            assert!(
                worst < 200.0 * tolerance,
                "{scheme}, {tolerance:e}: {worst:e}"
            );
        }
    }
}

#[test]
fn rows_stand_where_they_are_asked_for() {
    let bench = Bench::new();
    let output = bench.succeed(&[&flight("--dt 0.03 --tolerance 1e-8 --json")]);
    let times: Vec<f64> = bench.rows().iter().map(|row| row[0]).collect();
    assert_eq!(
        (times.len(), times[1], times[33], times[34]),
        (35, 0.03, 0.99, 1.0)
    );
    let told = json(&output);
    assert_eq!(told["scheme"], "dormand-prince853");
    let adaptive = &told["adaptive"];
    assert_eq!(adaptive["tolerance"], 1e-8);
    assert!(adaptive["accepted"].as_u64() >= Some(34));
    assert_eq!(adaptive["boundaries"], Value::Array(Vec::new()));
    let told = bench.succeed(&[&flight("--dt 0.25 --tolerance 1e-8")]);
    let told = String::from_utf8_lossy(&told.stdout);
    assert!(
        told.contains(", a row every 0.25 s to 1 s,") && told.contains("\ntolerance 1e-8: "),
        "{told}"
    );
    let fixed = bench.succeed(&[&flight("--dt 0.01 --json")]);
    assert_eq!(json(&fixed)["adaptive"], Value::Null);
}

#[test]
fn what_has_no_tolerance_is_refused() {
    let bench = Bench::new();
    for (more, message) in [
        (
            "--dt 0.1 --tolerance 1e-6 --stochastic",
            "--tolerance: a flight with noise has steps of fixed length",
        ),
        (
            "--dt 0.1 --tolerance 1e-6 --scheme rk4",
            "rk4 has no estimate of its error, which a tolerance needs; dormand-prince54, tsit5, dormand-prince853 and rodas4 \
             are for this one",
        ),
        (
            "--dt 0.1 --tolerance 0",
            "is not a number from 1e-14 to 0.1",
        ),
        (
            "--dt 0.1 --tolerance 1",
            "is not a number from 1e-14 to 0.1",
        ),
        (
            "--dt 0.1 --tolerance nan",
            "is not a number from 1e-14 to 0.1",
        ),
    ] {
        bench.fail(&[&flight(more)], 2, &[message]);
    }
}
