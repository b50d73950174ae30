//! `ahv rare`, through the real binary.

use serde_json::Value;

use crate::command::{self, fail, number};

/// chi_1 of SDCOM within 0.2 s from its trim: no feedback is needed for it.
const FLIGHT: [&str; 1] =
    ["rare --model sdcom --t-end 0.2 --dt 0.002 --scheme euler-maruyama --effort 200"];

fn json(options: &[&str]) -> Value {
    command::json(&[&FLIGHT, options].concat())
}

#[test]
fn a_probability_comes_with_its_interval_its_levels_and_its_price() {
    let told = json(&["--passes", "chi_1=0.6", "--threads", "1"]);
    let probability = &told["probability"];
    let [value, low, high] = ["value", "low", "high"].map(|key| number(&probability[key]));
    assert!(
        0.0 <= low && low < value && value < high && high < 1e-2,
        "{probability}"
    );
    let levels = told["levels"].as_array().expect("levels");
    let product: f64 = levels.iter().map(|level| number(&level["share"])).product();
    // The mean of products is near the product of means.
    assert!((product / value - 1.0).abs() < 0.1, "{product} {value}");
    assert_eq!(number(&levels[levels.len() - 1]["value"]), 0.6);
    let ratio = number(&told["plain_member_steps"]) / number(&told["member_steps"]);
    assert!((number(&told["ratio"]) / ratio - 1.0).abs() < 1e-12 && ratio > 1.0);
    assert_eq!(
        (&told["state"], &told["lost"]),
        (&"chi_1".into(), &0.into())
    );
    let two = json(&["--passes", "chi_1=0.6", "--threads", "2"]);
    assert_eq!(told["probability"], two["probability"]);
}

#[test]
fn what_cannot_be_found_is_told() {
    for (arguments, code, message) in [
        (["--passes", "chi_4=1"], 2, "--passes: unknown name `chi_4`"),
        (["--passes", "chi_1"], 2, "is not of the form NAME=VALUE"),
        (
            ["--passes", "chi_1=0"],
            2,
            "the limit 0 of chi_1 must be a number other than 0, where",
        ),
        (
            ["--passes", "chi_1=1e6"],
            3,
            "the members come no nearer to the limit than",
        ),
    ] {
        let output = fail(&[&FLIGHT, &arguments[..]].concat(), code, &[message]);
        assert!(output.stdout.is_empty());
    }
    let few = ["--passes", "chi_1=1", "--repetitions", "5"];
    fail(&[&FLIGHT, &few[..]].concat(), 2, &[]);
}
