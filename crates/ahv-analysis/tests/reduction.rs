//! Reductions against SLICOT's, and against what they promise.
#![forbid(unsafe_code)]

use ahv_analysis::reduction::{Part, Reduced, ReductionError, ReductionMethod};
use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};

/// A system, the Hankel singular values, and method, order, H-infinity and H2 norm of each line.
struct Case {
    system: Part,
    hankel: Vec<f64>,
    norms: Vec<(String, usize, f64, f64)>,
}

fn slicot() -> Vec<Case> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/vectors/reduction.txt"
    );
    let text = std::fs::read_to_string(path).expect("the vectors are there");
    let mut cases: Vec<Case> = Vec::new();
    for line in text.lines().skip(1) {
        let (name, rest) = line.split_once(',').expect("a name");
        let numbers: Vec<f64> = rest
            .split(',')
            .map(|it| it.parse().expect("a number"))
            .collect();
        let matrix =
            || DMatrix::from_row_slice(numbers[0] as usize, numbers[1] as usize, &numbers[2..]);
        if name == "A" {
            let none = DMatrix::zeros(0, 0);
            cases.push(Case {
                system: Part {
                    a: matrix(),
                    b: none.clone(),
                    c: none,
                },
                hankel: Vec::new(),
                norms: Vec::new(),
            });
            continue;
        }
        let case = cases.last_mut().expect("A comes first");
        match name {
            "B" => case.system.b = matrix(),
            "C" => case.system.c = matrix(),
            "hankel" => case.hankel = numbers,
            _ => {
                let norms = (name.to_owned(), numbers[0] as usize, numbers[1], numbers[2]);
                case.norms.push(norms);
            }
        }
    }
    assert_eq!(cases.len(), 4);
    cases
}

fn method(name: &str) -> ReductionMethod {
    let found = ReductionMethod::ALL
        .into_iter()
        .find(|it| it.name() == name);
    found.expect("a method")
}

#[test]
fn errors_and_norms_are_slicots() {
    for Case {
        system,
        hankel,
        norms,
    } in slicot()
    {
        let (_, _, h_infinity, h2) = norms[0];
        for (name, order, h_infinity_error, h2_error) in &norms[1..] {
            let reduced = Reduced::new(&system, method(name), *order).expect("it reduces");
            assert_eq!(reduced.reduced.order(), *order);
            for (ours, theirs) in reduced.hankel.iter().zip(&hankel) {
                assert_relative_eq!(ours, theirs, max_relative = 1e-6);
            }
            assert_relative_eq!(reduced.h_infinity, h_infinity, max_relative = 1e-7);
            assert_relative_eq!(reduced.h2, h2, max_relative = 1e-7);
            assert_relative_eq!(
                reduced.h_infinity_error.expect("it is seen"),
                *h_infinity_error,
                max_relative = 1e-6
            );
            assert_relative_eq!(
                reduced.h2_error.expect("it is seen"),
                *h2_error,
                max_relative = 1e-6
            );
        }
    }
}

#[test]
fn balanced_truncation_keeps_its_bound_and_krylov_its_moment() {
    for Case { system, .. } in slicot() {
        let unstable = system.a.complex_eigenvalues();
        let unstable = unstable.iter().filter(|it| it.re > 0.0).count();
        for order in 3..system.order() - unstable {
            let balanced = Reduced::new(&system, ReductionMethod::Balanced, order).expect("it");
            assert!(
                balanced.h_infinity_error.expect("it is seen") <= balanced.bound() * (1.0 + 1e-9)
            );
            assert_eq!(balanced.kept.order(), unstable);
            let krylov = Reduced::new(&system, ReductionMethod::Krylov, order).expect("it");
            for part in [&balanced.reduced, &krylov.reduced] {
                assert!(part.a.complex_eigenvalues().iter().all(|it| it.re < 0.0));
            }
            let at_rest = |part: &Part| {
                let states = part.a.clone().lu().solve(&part.b).expect("regular");
                &part.c * states
            };
            let (ours, exact) = (at_rest(&krylov.reduced), at_rest(&krylov.stable));
            assert!((ours - &exact).amax() < 1e-6 * exact.amax());
        }
    }
}

#[test]
fn what_is_kept_and_what_is_reduced_have_all_poles() {
    for Case { system, .. } in slicot() {
        let reduced = Reduced::new(&system, ReductionMethod::Balanced, 1).expect("it reduces");
        let traces = reduced.kept.a.trace() + reduced.stable.a.trace();
        assert_relative_eq!(traces, system.a.trace(), max_relative = 1e-7);
        let gains = &reduced.kept.c * &reduced.kept.b + &reduced.stable.c * &reduced.stable.b;
        let first = &system.c * &system.b;
        assert!((gains - &first).amax() < 1e-7 * first.amax());
    }
}

#[test]
fn an_order_without_sense_is_refused() {
    let cases = slicot();
    let [Case { system, .. }, ..] = cases.as_slice() else {
        panic!("a case");
    };
    for order in [0, 4, 5] {
        let refused = Reduced::new(system, ReductionMethod::Balanced, order);
        assert_eq!(refused, Err(ReductionError::Order { order, stable: 4 }));
    }
    // Two states that no input reaches.
    let unreached = Part {
        a: DMatrix::from_diagonal(&DVector::from_vec(vec![-1.0, -2.0, -3.0])),
        b: DMatrix::from_column_slice(3, 1, &[1.0, 0.0, 0.0]),
        c: DMatrix::from_row_slice(1, 3, &[1.0, 1.0, 1.0]),
    };
    for method in ReductionMethod::ALL {
        let refused = Reduced::new(&unreached, method, 2);
        assert_eq!(refused, Err(ReductionError::Rank { order: 2, rank: 1 }));
    }
}
