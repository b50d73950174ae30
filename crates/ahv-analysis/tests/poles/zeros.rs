//! Zeros of transfer matrices against SLICOT's, closed forms and what they must not depend on.

use std::fs;

use ahv_analysis::linearize::{LinearSystem, linearize};
use ahv_analysis::poles::{Decoupling, Zeros, frequency, zeros};
use ahv_core::GeneratedModel;
use ahv_models::{com, com_rigid, dcom, sdcom};
use approx::assert_abs_diff_eq;
use nalgebra::{Complex, DMatrix};

use crate::{INPUTS, system, trimmed};

/// A double integrator with two outputs in turn: the zero of 1/s², (s + 2)/s², and none at all.
#[test]
fn small_systems_have_the_zeros_of_their_transfer_functions() {
    let of = |c: [f64; 2], d: f64| LinearSystem {
        states: vec!["velocity", "altitude"],
        inputs: vec!["phi"],
        outputs: vec!["altitude"],
        a: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]),
        b: DMatrix::from_row_slice(2, 1, &[0.0, 1.0]),
        c: DMatrix::from_row_slice(1, 2, &c),
        d: DMatrix::from_element(1, 1, d),
    };
    let none = zeros(&of([1.0, 0.0], 0.0)).expect("zeros");
    assert_eq!((none.finite.len(), none.infinite_orders), (0, vec![2]));
    let one = zeros(&of([2.0, 1.0], 0.0)).expect("zeros");
    assert_eq!((one.finite.len(), one.infinite_orders), (1, vec![1]));
    assert_abs_diff_eq!(one.finite[0].value.re, -2.0, epsilon = 1e-14);
    // 1 + 4/s²: zeros at ±2i.
    let pair = zeros(&of([4.0, 0.0], 1.0)).expect("zeros");
    assert_eq!(
        (pair.finite.len(), pair.infinite(), pair.normal_rank),
        (2, 1, 1)
    );
    assert_abs_diff_eq!(pair.finite[0].value.im, 2.0, epsilon = 1e-14);
}

#[test]
fn no_input_reaches_the_coloured_noise() {
    let found = zeros(&system(&sdcom::Model::new(&sdcom::NOMINAL))).expect("zeros");
    let missed = found
        .finite
        .iter()
        .filter(|zero| zero.decoupling == Some(Decoupling::Input));
    assert_eq!(missed.count(), 3, "{found:?}");
    let found = zeros(&system(&dcom::Model::new(&dcom::SECTION5_3))).expect("zeros");
    assert!(
        found.finite.iter().all(|zero| zero.decoupling.is_none()),
        "{found:?}"
    );
    let real = found.finite.iter().filter(|zero| zero.value.im == 0.0);
    let largest = real.map(|zero| zero.value.re).fold(0.0, f64::max);
    assert_abs_diff_eq!(largest, 7.64, epsilon = 0.01);
}

/// A pair of inputs and outputs of a model, and what SLICOT found for it.
struct Pair {
    what: String,
    system: LinearSystem,
    rank: usize,
    orders: Vec<usize>,
    right: Vec<usize>,
    left: Vec<usize>,
    zeros: Vec<Complex<f64>>,
}

fn whole(text: &str) -> Vec<usize> {
    let numbers = text.split_whitespace();
    numbers.map(|it| it.parse().expect("a number")).collect()
}

/// Both zeros of a pair for the upper one.
fn conjugates(text: &str) -> Vec<Complex<f64>> {
    let number = |text: &str| -> f64 { text.parse().expect("a number") };
    let roots = text
        .split_whitespace()
        .flat_map(|root| match root.split_once(':') {
            Some((re, im)) => {
                let upper = Complex::new(number(re), number(im));
                vec![upper, upper.conj()]
            }
            None => vec![Complex::new(number(root), 0.0)],
        });
    roots.collect()
}

fn pairs() -> Vec<Pair> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors/zeros.txt");
    let text = fs::read_to_string(path).expect("the vectors are there");
    let (mut case, mut a, mut b) = ("", DMatrix::zeros(0, 0), DMatrix::zeros(0, 0));
    let mut pairs = Vec::new();
    for line in text.lines().skip(1) {
        let matrix = |numbers: &str| {
            let numbers: Vec<f64> = numbers
                .split(',')
                .map(|it| it.parse().expect("a number"))
                .collect();
            DMatrix::from_row_slice(numbers[0] as usize, numbers[1] as usize, &numbers[2..])
        };
        match line.split_once(',').filter(|_| !line.contains('|')) {
            Some(("case", name)) => case = name,
            Some(("A", numbers)) => a = matrix(numbers),
            Some((_, numbers)) => b = matrix(numbers),
            None => {
                let fields: Vec<&str> = line.split('|').collect();
                let [inputs, outputs, rank, orders, right, left] =
                    [0, 1, 2, 3, 4, 5].map(|index| whole(fields[index]));
                let c = DMatrix::from_fn(outputs.len(), a.nrows(), |row, column| {
                    f64::from(u8::from(outputs[row] == column))
                });
                pairs.push(Pair {
                    what: format!("{case}: inputs {inputs:?}, outputs {outputs:?}"),
                    system: LinearSystem {
                        states: vec!["state"; a.nrows()],
                        inputs: vec!["input"; inputs.len()],
                        outputs: vec!["output"; outputs.len()],
                        a: a.clone(),
                        b: b.select_columns(&inputs),
                        d: DMatrix::zeros(outputs.len(), inputs.len()),
                        c,
                    },
                    rank: rank[0],
                    orders,
                    right,
                    left,
                    zeros: conjugates(fields[6]),
                });
            }
        }
    }
    pairs
}

/// Every zero has a partner of its own. A multiple zero is known to a root of the rounding only: zeros are compared in
/// groups that are nearer to each other than that, by their mean.
pub(crate) fn assert_near(found: &[Complex<f64>], expected: &[Complex<f64>], what: &str) {
    const NEAR: f64 = 1e-3;
    let mut left: Vec<_> = expected.to_vec();
    let mut own: Vec<_> = found.to_vec();
    while let Some(&first) = left.first() {
        let size = NEAR * frequency(first).max(1.0);
        let take = |roots: &mut Vec<Complex<f64>>| -> Vec<Complex<f64>> {
            let near = |root: &Complex<f64>| frequency(*root - first) <= size;
            let group = roots.iter().copied().filter(near).collect();
            roots.retain(|root| !near(root));
            group
        };
        let (group, partners) = (take(&mut left), take(&mut own));
        assert_eq!(
            group.len(),
            partners.len(),
            "{what}: {found:?}, not {expected:?}"
        );
        let mean = |group: &[Complex<f64>]| group.iter().sum::<Complex<f64>>() / group.len() as f64;
        let distance = frequency(mean(&group) - mean(&partners));
        assert!(
            distance <= 1e-7 * frequency(first).max(1.0),
            "{what}: {partners:?}, not {group:?}"
        );
    }
    assert!(own.is_empty(), "{what}: {found:?}, not {expected:?}");
}

#[test]
fn zeros_of_every_pair_are_slicots() {
    let pairs = pairs();
    assert!(pairs.len() > 1800, "{}", pairs.len());
    for pair in pairs {
        let found = zeros(&pair.system).expect("zeros");
        let what = &pair.what;
        assert_eq!(found.normal_rank, pair.rank, "{what}");
        assert_eq!(found.infinite_orders, pair.orders, "{what}");
        assert_eq!(found.right_indices, pair.right, "{what}");
        assert_eq!(found.left_indices, pair.left, "{what}");
        let finite: Vec<_> = found.finite.iter().map(|it| it.value).collect();
        assert_near(&finite, &pair.zeros, what);
    }
}

fn pair<M: GeneratedModel>(model: &M, inputs: &[&str], outputs: &[&str]) -> Zeros {
    let (x, u) = trimmed(model);
    let system = linearize(model, &x, &u, inputs, outputs).expect("the model is smooth");
    zeros(&system).expect("zeros")
}

/// The rows of altitude and gamma differ by V/s: the transfer matrix has rank 1.
#[test]
fn a_transfer_matrix_without_full_rank_has_no_invented_zeros() {
    let dcom = dcom::Model::new(&dcom::NOMINAL);
    let found = pair(&dcom, INPUTS, &["altitude", "gamma"]);
    assert_eq!((found.normal_rank, found.finite.len()), (1, 0));
    assert_eq!(
        (found.right_indices.len(), found.left_indices.len()),
        (1, 1)
    );
    let slaved = dcom::NOMINAL.with_canard(dcom::Canard::Slaved);
    let found = pair(&dcom::Model::new(&slaved), &["delta_e"], &["altitude"]);
    assert_eq!((found.finite.len(), found.infinite_orders), (8, vec![3]));
    let rigid = com_rigid::Model::new(&com::NOMINAL);
    let found = pair(&rigid, INPUTS, &["altitude", "alpha"]);
    assert_eq!((found.finite.len(), found.normal_rank), (1, 2));
}

/// Zeros do not depend on units, and neither does the rank: each state, input and output is scaled by itself.
#[test]
fn units_change_no_zero() {
    let (x, u) = trimmed(&dcom::Model::new(&dcom::SECTION5_3));
    for outputs in [
        ["altitude", "gamma"],
        ["velocity", "gamma"],
        ["alpha", "eta_1"],
    ] {
        let model = dcom::Model::new(&dcom::SECTION5_3);
        let system = linearize(&model, &x, &u, INPUTS, &outputs).expect("smooth");
        let plain = zeros(&system).expect("zeros");
        let factor = |index: usize| 10.0_f64.powi((index as i32 * 7) % 13 - 6);
        let mut scaled = system.clone();
        scaled.a = DMatrix::from_fn(11, 11, |i, j| system.a[(i, j)] * factor(i) / factor(j));
        scaled.b = DMatrix::from_fn(11, 2, |i, j| system.b[(i, j)] * factor(i) * factor(j + 3));
        scaled.c = DMatrix::from_fn(2, 11, |i, j| system.c[(i, j)] * factor(i + 5) / factor(j));
        let scaled = zeros(&scaled).expect("zeros");
        assert_eq!(plain.normal_rank, scaled.normal_rank);
        assert_eq!(plain.infinite_orders, scaled.infinite_orders);
        let [plain, scaled] = [plain, scaled].map(|zeros| {
            let values = zeros.finite.iter().map(|it| it.value);
            values.collect::<Vec<_>>()
        });
        assert_near(&scaled, &plain, outputs[0]);
    }
}

#[test]
fn there_may_be_more_outputs_than_inputs() {
    let dcom = dcom::Model::new(&dcom::NOMINAL);
    let tall = pair(&dcom, &["phi"], &["velocity", "gamma"]);
    assert_eq!((tall.normal_rank, tall.left_indices.len()), (1, 1));
    let wide = pair(&dcom, INPUTS, &["velocity"]);
    assert_eq!((wide.normal_rank, wide.right_indices.len()), (1, 1));
}
