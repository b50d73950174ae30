//! Least squares beside those of NumPy and SciPy (`generator/ahv_oracle/least_squares.py`).

use ahv_fit::{
    Constraint, Design, Estimate, FitError, Monomial, Move, Problem, Residuals, Samples, search,
};
use serde_json::Value;

const VECTORS: &str = include_str!("../../../tests/vectors/least_squares.txt");

struct Case {
    json: Value,
    variables: Vec<Vec<f64>>,
    responses: Vec<Vec<f64>>,
    weights: Vec<f64>,
    monomials: Vec<Monomial>,
    folds: usize,
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}

impl Case {
    fn read() -> Self {
        let text = VECTORS.lines().nth(1).expect("the second line");
        let json: Value = serde_json::from_str(text).expect("JSON");
        let rows = |key: &str| json[key].as_array().expect("a list").clone();
        let monomial = |it: &Value| numbers(it).into_iter().map(|it| it as u32).collect();
        Self {
            variables: rows("variables").iter().map(numbers).collect(),
            responses: vec![numbers(&json["response"])],
            weights: numbers(&json["weights"]),
            monomials: rows("monomials").iter().map(monomial).collect(),
            folds: json["folds"].as_u64().expect("a count") as usize,
            json,
        }
    }

    fn samples(&self, weighted: bool) -> Samples<'_> {
        Samples {
            variables: &self.variables,
            responses: &self.responses,
            weights: weighted.then_some(self.weights.as_slice()),
        }
    }

    fn design(&self, weighted: bool) -> Design {
        Design::of(&self.samples(weighted), &self.monomials, self.folds).expect("a design")
    }

    fn solve(&self, constraints: &[Constraint]) -> Result<Estimate, FitError> {
        let design = self.design(false);
        Problem::new(&design, 0, &[0, 1, 2, 3, 4]).solve(constraints)
    }
}

#[track_caller]
fn near(found: f64, wanted: f64, room: f64) {
    assert!(
        (found - wanted).abs() <= room * wanted.abs().max(1e-3),
        "{found} {wanted}"
    );
}

#[test]
fn estimates_are_those_of_numpy() {
    let case = Case::read();
    for (weighted, name) in [(false, "plain"), (true, "weighted")] {
        let design = case.design(weighted);
        let found = Problem::new(&design, 0, &[0, 1, 2, 3, 4])
            .solve(&[])
            .expect("a fit");
        let wanted = &case.json[name];
        for (found, wanted) in found.values.iter().zip(numbers(&wanted["values"])) {
            near(*found, wanted, 1e-12);
        }
        let covariance = wanted["covariance"].as_array().expect("rows");
        for (row, wanted) in covariance.iter().enumerate() {
            for (column, wanted) in numbers(wanted).into_iter().enumerate() {
                near(found.covariance[(row, column)], wanted, 1e-11);
            }
        }
        let number = |key: &str| wanted[key].as_f64().expect("a number");
        near(found.residual, number("residual"), 1e-12);
        near(found.cross_validated, number("cross_validated"), 1e-12);
        near(found.condition, number("condition"), 1e-10);
        let monomials: Vec<&Monomial> = case.monomials.iter().collect();
        let residuals = Residuals::of(&case.samples(weighted), 0, &monomials, &found.values);
        near(
            residuals.r_squared.expect("samples differ"),
            number("r_squared"),
            1e-12,
        );
    }
}

#[test]
fn constrained_estimates_are_those_of_scipy() {
    let case = Case::read();
    let tied = Constraint::Tied {
        coefficient: 4,
        other: 0,
        factor: 0.5,
    };
    let signed = [
        Constraint::NotNegative(1),
        Constraint::NotPositive(2),
        Constraint::NotNegative(3),
    ];
    for (name, constraints) in [
        ("fixed", &[Constraint::Fixed(3, 2.0)][..]),
        ("tied", &[tied]),
        ("signed", &signed),
    ] {
        let found = case.solve(constraints).expect("a fit");
        let wanted = numbers(&case.json[name]);
        for (found, wanted) in found.values.iter().zip(&wanted) {
            near(*found, *wanted, 1e-11);
        }
        // What is fixed or held has no error.
        let errors = found.errors();
        let none = |it: usize| errors[it] == 0.0;
        match name {
            "fixed" => assert!(none(3) && !none(0)),
            "signed" => assert!(
                found
                    .held
                    .iter()
                    .enumerate()
                    .all(|(it, held)| *held == none(it))
            ),
            _ => near(errors[4], 0.5 * errors[0], 1e-12),
        }
    }
}

#[test]
fn samples_that_do_not_tell_monomials_apart_name_them() {
    let line: Vec<f64> = (0..50).map(|k| f64::from(k) / 10.0).collect();
    let twice = line.iter().map(|it| 2.0 * it).collect();
    let variables = [line.clone(), twice, vec![0.0; 50]];
    let samples = Samples {
        variables: &variables,
        responses: &[line],
        weights: None,
    };
    let monomials = [
        vec![0, 0, 0],
        vec![1, 0, 0],
        vec![0, 1, 0],
        vec![0, 0, 1],
        vec![2, 0, 0],
    ];
    let design = Design::of(&samples, &monomials, 5).expect("a design");
    let fault = |columns: &[usize], constraints: &[Constraint]| {
        Problem::new(&design, 0, columns)
            .solve(constraints)
            .expect_err("no fit")
    };
    assert_eq!(
        fault(&[0, 1, 2, 4], &[]),
        FitError::RankDeficient(vec![1, 2])
    );
    assert_eq!(fault(&[0, 1, 3], &[]), FitError::RankDeficient(vec![2]));
    let two = [Constraint::Fixed(1, 1.0), Constraint::NotNegative(1)];
    assert_eq!(fault(&[0, 1], &two), FitError::Contradiction(1));
    // Fixed, one of the two is told from the other.
    let found = Problem::new(&design, 0, &[0, 1, 2, 4])
        .solve(&[Constraint::Fixed(2, 0.25)])
        .expect("a fit");
    near(found.values[1], 0.5, 1e-12);
    let folds = Design::of(&samples, &monomials, 51).expect_err("too many folds");
    assert_eq!(
        folds,
        FitError::Folds {
            folds: 51,
            rows: 50
        }
    );
}

#[test]
fn a_number_that_is_not_finite_is_named() {
    let samples = Samples {
        variables: &[vec![1.0, 1e200, 3.0]],
        responses: &[vec![1.0, 2.0, 3.0]],
        weights: None,
    };
    let fault = Design::of(&samples, &[vec![1], vec![2]], 2).expect_err("too large");
    assert_eq!(fault, FitError::NotFinite { row: 1, column: 1 });
}

#[test]
fn the_search_finds_what_the_samples_are_made_of() {
    let case = Case::read();
    let monomials: Vec<Monomial> = (0..4)
        .flat_map(|i| (0..4 - i).map(move |j| vec![i, j]))
        .collect();
    let samples = case.samples(false);
    let design = Design::of(&samples, &monomials, 7).expect("a design");
    let of = |wanted: [u32; 2]| {
        monomials
            .iter()
            .position(|it| *it == wanted)
            .expect("a monomial")
    };
    // It starts without y, and with x y², which the samples do not have.
    let start = [of([0, 0]), of([1, 0]), of([2, 0]), of([1, 2])];
    let all: Vec<usize> = (0..monomials.len()).collect();
    let steps = search(&design, 0, &start, &all, &[], 20);
    assert!(
        steps.iter().any(|it| it.action == Move::Add(of([0, 1]))),
        "{steps:?}"
    );
    let last = steps.last().expect("steps").after;
    near(
        last,
        case.json["plain"]["cross_validated"]
            .as_f64()
            .expect("a number"),
        0.02,
    );
    // What is kept stays.
    let kept = [of([1, 2])];
    let steps = search(&design, 0, &start, &all, &kept, 20);
    assert!(steps.iter().all(|it| it.action != Move::Drop(kept[0])));
}
