//! Output error against SciPy, and what cannot be estimated.

use crate::common::Case;
use ahv_identify::{IdentifyError, Problem, Record, filter, output_error};

/// The record, and omega, zeta, their standard errors and the noise.
fn scipy() -> (Record, Vec<f64>) {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/vectors/identify.txt"
    );
    let text = std::fs::read_to_string(path).expect("the vectors are there");
    let mut record = Record {
        times: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
    };
    let mut answer = Vec::new();
    for line in text.lines().skip(1) {
        let numbers = line.split(',').filter_map(|it| it.parse().ok());
        match numbers.collect::<Vec<f64>>().as_slice() {
            [time, eta] => {
                record.times.push(*time);
                record.outputs.push(vec![*eta]);
            }
            numbers => answer = numbers.to_vec(),
        }
    }
    assert_eq!((record.times.len(), answer.len()), (80, 5));
    (record, answer)
}

/// The mode flies free: its coloured noise is held at 0.
fn problem<'a>(case: &'a Case, record: Record) -> Problem<'a> {
    let inputs = vec![case.input.clone(); record.times.len()];
    let record = Record { inputs, ..record };
    let mut problem = case.problem(record, 0.0);
    problem.free.truncate(2);
    problem.held = vec![2];
    problem
}

#[test]
fn output_error_is_that_of_scipy() {
    let case = Case::flexible_mode();
    let (record, answer) = scipy();
    let estimate = output_error(&problem(&case, record)).expect("it converges");
    for (index, it) in estimate.parameters.iter().enumerate() {
        let (value, error) = (answer[index], answer[index + 2]);
        // Runge-Kutta flies here, the closed form there.
        assert!(
            (it.value - value).abs() < 0.01 * error,
            "{it:?}, SciPy {value}"
        );
        assert!(
            (it.white_error - error).abs() < 0.01 * error,
            "{it:?}, SciPy {error}"
        );
    }
    let noise = estimate.noise[0];
    assert!((noise - answer[4]).abs() < 1e-3 * answer[4], "{noise}");
    assert!(estimate.whiteness[0].p > 0.01);
}

#[test]
fn what_has_no_effect_is_named() {
    let case = Case::flexible_mode();
    let (record, _) = scipy();
    let mut problem = problem(&case, record);
    // The intensity of a noise that does not fly.
    let sigma = case
        .model
        .parameters()
        .index_of("sigma")
        .expect("it is there");
    problem.free.push(sigma);
    match output_error(&problem) {
        Err(IdentifyError::Unobservable { names, .. }) => assert_eq!(names, ["sigma"]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_state_that_is_not_seen_is_named() {
    let case = Case::flexible_mode();
    let (record, _) = scipy();
    let mut problem = problem(&case, record);
    problem.held.clear();
    match output_error(&problem) {
        Err(IdentifyError::Unobservable { names, .. }) => assert_eq!(names, ["chi"]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_short_record_is_refused() {
    let case = Case::flexible_mode();
    let (record, _) = scipy();
    let short = Record {
        times: record.times[..4].to_vec(),
        outputs: record.outputs[..4].to_vec(),
        ..record
    };
    let refused = output_error(&problem(&case, short.clone()));
    assert!(
        matches!(
            refused,
            Err(IdentifyError::Short {
                numbers: 4,
                unknowns: 5
            })
        ),
        "{refused:?}"
    );
    let mut problem = case.problem(
        Record {
            inputs: vec![case.input.clone(); 4],
            ..short
        },
        0.0,
    );
    assert!(matches!(
        filter(&problem),
        Err(IdentifyError::Short {
            numbers: 4,
            unknowns: 4
        })
    ));
    problem.segment = 0.02;
    assert!(matches!(filter(&problem), Err(IdentifyError::Short { .. })));
}
