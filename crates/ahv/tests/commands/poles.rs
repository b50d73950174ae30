//! `ahv poles`.

use std::fs;

use serde_json::Value;

use crate::command::{json, number, numbers, text};

fn named<'a>(roots: &'a Value, name: &str) -> Vec<&'a Value> {
    let modes = roots["modes"].as_array().expect("modes");
    modes.iter().filter(|mode| mode["name"] == name).collect()
}

#[test]
fn the_dcom_has_nine_zeros() {
    for set in ["section5.1", "section5.3"] {
        let roots = json(&["poles --model dcom --set", set]);
        assert_eq!(roots["poles"].as_array().map(Vec::len), Some(11));
        assert_eq!(roots["zeros"].as_array().map(Vec::len), Some(9));
        assert_eq!(roots["zeros_at_infinity"], 4);
    }
    let roots = json(&["poles --model dcom --set section5.3"]);
    let mut short: Vec<f64> = named(&roots, "short period")
        .iter()
        .map(|it| number(&it["pole"][0]))
        .collect();
    short.sort_by(f64::total_cmp);
    assert!(
        (short[0] + 3.9694).abs() < 6e-5 && (short[1] - 3.8612).abs() < 6e-5,
        "{short:?}"
    );
    for (name, frequency) in [
        ("flexible 1", 20.5),
        ("flexible 2", 52.5),
        ("flexible 3", 105.0),
    ] {
        let pair = named(&roots, name);
        assert_eq!(pair.len(), 2, "{roots}");
        assert!((number(&pair[0]["frequency"]) - frequency).abs() < 0.1);
        assert!((number(&pair[0]["damping"]) - 0.02).abs() < 1e-4);
    }
}

#[test]
fn the_sdcom_says_how_many_zeros_it_has() {
    let roots = json(&["poles --model sdcom"]);
    assert_eq!(roots["poles"].as_array().map(Vec::len), Some(8));
    assert_eq!(roots["zeros"].as_array().map(Vec::len), Some(6));
    let told = text(&["poles --model sdcom"]);
    for part in [
        "6 finite zeros: 8 states less the orders of the infinite zeros (1, 1); 3 of them are poles that inputs or outputs miss",
        "input decoupling",
        "coloured noise 3",
        "short period",
        "height",
    ] {
        assert!(told.contains(part), "no {part:?} in: {told}");
    }
    // The coloured noise decays at zeta omega of (36), and no input reaches it.
    let zeros: Vec<Vec<f64>> = roots["zeros"]
        .as_array()
        .expect("zeros")
        .iter()
        .map(numbers)
        .collect();
    assert!(
        zeros
            .iter()
            .any(|zero| (zero[0] + 0.7 * 19.7437).abs() < 1e-9),
        "{zeros:?}"
    );
}

#[test]
fn the_picture_and_the_table_are_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    text(&["poles --model dcom --out", out]);
    let svg = fs::read_to_string(folder.path().join("poles.svg")).expect("it is written");
    for part in ["Poles and zeros of dcom", "imaginary part [1/s]", "zeros"] {
        assert!(svg.contains(part), "no {part:?}");
    }
    let csv = fs::read_to_string(folder.path().join("poles.csv")).expect("it is written");
    assert_eq!(
        csv.lines().filter(|line| line.starts_with("pole,")).count(),
        11
    );
    assert_eq!(
        csv.lines().filter(|line| line.starts_with("zero,")).count(),
        9
    );
}

#[test]
fn a_pair_without_full_rank_says_so() {
    let words = ["poles --model dcom --outputs altitude,gamma"];
    let roots = json(&words);
    assert_eq!(roots["normal_rank"], 1);
    assert_eq!(roots["zeros"].as_array().map(Vec::len), Some(0));
    let told = text(&words);
    let part = "the transfer matrix has rank 1 only: its 2 inputs cannot move its 2 outputs apart";
    assert!(told.contains(part), "{told}");
    assert!(told.contains("0 finite zeros: 11 states less"), "{told}");
}

#[test]
fn single_pairs_have_the_zeros_that_exist() {
    let slaved = ["poles --model dcom --canard slaved"];
    let pair = ["--inputs", "delta_e", "--outputs", "altitude"];
    let roots = json(&[&slaved[..], &pair].concat());
    assert_eq!(roots["zeros"].as_array().map(Vec::len), Some(8));
    assert_eq!(roots["infinite_zero_orders"], serde_json::json!([3]));
    assert_eq!(roots["zeros_at_infinity"], 4);
    let rigid = json(&["poles --model com_rigid --outputs altitude,alpha"]);
    assert_eq!(rigid["zeros"].as_array().map(Vec::len), Some(1));
    let tall = json(&["poles --model dcom --inputs phi"]);
    assert_eq!(tall["normal_rank"], 1);
}

/// No input reaches the coloured noise: what an output of one of them leaves are the decays of the others.
#[test]
fn an_output_that_no_input_reaches_keeps_the_zeros_of_the_rest() {
    let decays = [13.820_59, 28.671_06, 47.410_15];
    for model in ["sdcom", "sdcom_printed"] {
        for (inputs, output) in [("phi", ""), ("delta_e", ""), ("phi,delta_e", "alpha,")] {
            for seen in 0..3 {
                let outputs = format!("{output}chi_{}", seen + 1);
                let flags = ["--inputs", inputs, "--outputs", &outputs];
                let roots = json(&[&["poles --model", model][..], &flags].concat());
                let zeros = roots["zeros"].as_array().expect("zeros").iter();
                let found: Vec<f64> = zeros.map(|zero| -number(&zero[0])).collect();
                let mut others = decays.to_vec();
                others.remove(seen);
                let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6;
                let right = found.len() == 2 && found.iter().zip(&others).all(near);
                assert!(right, "{model} {inputs} {outputs}: {found:?}");
            }
        }
    }
}
