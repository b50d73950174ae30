//! `ahv linearize`.

use std::fs;

use crate::command::{fail, json, number, numbers, text};

#[test]
fn the_matrices_are_labelled() {
    let system = json(&["linearize --model com_rigid"]);
    assert_eq!(system["states"].as_array().map(Vec::len), Some(5));
    assert_eq!(system["inputs"], serde_json::json!(["phi", "delta_e"]));
    assert_eq!(system["outputs"], serde_json::json!(["velocity", "gamma"]));
    // Kinematics: h' = V gamma, alpha' = Q - gamma'.
    let a = |row: usize| numbers(&system["A"][row]);
    assert_eq!(a(1), [0.0, 0.0, 7702.0808, 0.0, 0.0]);
    assert_eq!((a(2)[4], a(3)[4]), (0.0, 1.0));
    assert!((a(2)[3] + a(3)[3]).abs() < 1e-15);
    assert_eq!(number(&system["C"][1][2]), 1.0);
    assert_eq!(numbers(&system["D"][0]), [0.0, 0.0]);
    let told = text(&["linearize --model com_rigid"]);
    assert!(
        told.contains("altitude    0.0000e0    0.0000e0    7.7021e3"),
        "{told}"
    );
}

#[test]
fn inputs_and_outputs_are_chosen() {
    let words = ["linearize --model dcom --canard free"];
    let more = [
        "--inputs",
        "phi,delta_e,delta_c",
        "--outputs",
        "alpha,pitch_rate,eta_1",
    ];
    let system = json(&[&words[..], &more].concat());
    assert_eq!(numbers(&system["B"][0]).len(), 3);
    assert_eq!(system["C"].as_array().map(Vec::len), Some(3));
    assert_eq!(number(&system["C"][2][5]), 1.0);
    fail(
        &[&words[..], &["--outputs", "alhpa"]].concat(),
        2,
        &["--outputs", "did you mean `alpha`?"],
    );
    fail(
        &[&words[..], &["--inputs", "rudder"]].concat(),
        2,
        &["--inputs", "known: phi, delta_e, delta_c"],
    );
}

/// To the last bit but one, which reading JSON may lose.
fn same(found: f64, expected: &serde_json::Value) {
    let expected = number(expected);
    assert!(
        (found - expected).abs() <= f64::EPSILON * expected.abs(),
        "{found}, not {expected}"
    );
}

#[test]
fn files_hold_the_same_matrices() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let write = |name: &str| json(&["linearize --model sdcom --out", &path(name)]);
    let system = write("sdcom.json");
    let file = fs::read_to_string(path("sdcom.json")).expect("it is written");
    assert_eq!(
        serde_json::from_str::<serde_json::Value>(&file).expect("JSON"),
        system
    );

    write("sdcom.csv");
    let csv = fs::read_to_string(path("sdcom.csv")).expect("it is written");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!((rows.len(), rows[0].len()), (1 + 8 + 2, 1 + 8 + 2));
    assert_eq!(
        (rows[0][1], rows[1][0]),
        ("velocity [ft/s]", "dvelocity/dt [ft/s/s]")
    );
    let cell = |row: usize, column: usize| rows[row][column].parse().expect("a number");
    same(cell(1, 4), &system["A"][0][3]);
    same(cell(5, 10), &system["B"][4][1]);
    assert_eq!(rows[0][9..], ["phi [1]", "delta_e [rad]"]);

    write("sdcom.mat");
    let mat = fs::read(path("sdcom.mat")).expect("it is written");
    let int = |at: usize| i32::from_le_bytes(mat[at..at + 4].try_into().expect("four bytes"));
    // Type, rows, columns, imaginary part, length of the name; the name; columns of doubles.
    assert_eq!([0, 4, 8, 12, 16].map(int), [0, 8, 8, 0, 2]);
    assert_eq!(&mat[20..22], b"A\0");
    let double = |at: usize| f64::from_le_bytes(mat[at..at + 8].try_into().expect("eight bytes"));
    same(double(22 + 8 * (3 * 8)), &system["A"][0][3]);
    let (square, tall) = (22 + 8 * 64, 22 + 8 * 16);
    let labels = square + 2 * tall + 22 + 8 * 4;
    // The names as rows of characters, column by column: bytes, text.
    let list = |at: usize, name: &str, rows: usize, columns: usize| {
        let head = [51, rows as i32, columns as i32, 0, name.len() as i32 + 1];
        assert_eq!([0, 4, 8, 12, 16].map(|offset| int(at + offset)), head);
        let text = at + 21 + name.len();
        assert_eq!(&mat[at + 20..text - 1], name.as_bytes());
        let row = |row| -> Vec<u8> {
            (0..columns)
                .map(|column| mat[text + column * rows + row])
                .collect()
        };
        let rows: Vec<String> = (0..rows)
            .map(|index| {
                String::from_utf8(row(index))
                    .expect("text")
                    .trim_end()
                    .to_owned()
            })
            .collect();
        (rows.join(" "), text + columns * rows.len())
    };
    let (states, next) = list(labels, "states", 8, 10);
    let expected = "velocity altitude gamma alpha pitch_rate chi_1 chi_2 chi_3";
    assert_eq!(states, expected);
    let (inputs, next) = list(next, "inputs", 2, 7);
    let (outputs, end) = list(next, "outputs", 2, 8);
    assert_eq!(
        (inputs.as_str(), outputs.as_str()),
        ("phi delta_e", "velocity gamma")
    );
    assert_eq!(mat.len(), end);

    fail(
        &["linearize --model sdcom --out", &path("sdcom.xls")],
        2,
        &[".json, .csv or .mat"],
    );
    assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 3);
}

#[test]
fn without_a_trim_there_is_no_system() {
    let words = ["linearize --model com --velocity 7000 --altitude 110000"];
    let output = fail(
        &words,
        3,
        &[
            "com: no trim with delta_e <= 20 deg",
            "velocity 7000 ft/s, altitude 110000 ft",
        ],
    );
    assert!(output.stdout.is_empty());
}
