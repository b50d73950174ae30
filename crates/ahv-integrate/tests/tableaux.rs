//! The coefficients against the order conditions, so that no digit is mistyped.
#![forbid(unsafe_code)]

use ahv_integrate::{
    DormandPrince54, DormandPrince853, EmbeddedPair, Rodas4, RosenbrockTableau, Tableau, Tsit5,
};

type Matrix<const N: usize> = [[f64; N]; N];

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times<const N: usize>(matrix: &Matrix<N>, x: &[f64; N]) -> [f64; N] {
    matrix.map(|row| dot(&row, x))
}

fn product<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] * b[i])
}

/// Order of a rooted tree, its elementary weights without the weights b, and its density.
type Tree<const N: usize> = (usize, [f64; N], f64);

/// All rooted trees up to this order.
fn trees<const N: usize>(a: &Matrix<N>, most: usize) -> Vec<Tree<N>> {
    let mut trees = Vec::new();
    for order in 1..=most {
        let mut grown = Vec::new();
        grow(a, &trees, order, &mut grown, (order - 1, [1.0; N], 1.0), 0);
        trees.extend(grown);
    }
    trees
}

/// Puts subtrees on a root until none of its nodes is left; subtrees stand in the order of the list, so that none comes twice.
fn grow<const N: usize>(
    a: &Matrix<N>,
    subtrees: &[Tree<N>],
    order: usize,
    grown: &mut Vec<Tree<N>>,
    (left, weights, density): (usize, [f64; N], f64),
    from: usize,
) {
    if left == 0 {
        grown.push((order, weights, order as f64 * density));
    }
    for (index, (nodes, own, dense)) in subtrees.iter().enumerate().skip(from) {
        if *nodes <= left {
            let weights = product(&weights, &times(a, own));
            let rest = (left - nodes, weights, density * dense);
            grow(a, subtrees, order, grown, rest, index);
        }
    }
}

#[test]
fn there_are_so_many_rooted_trees() {
    let trees = trees(&[[0.0]], 8);
    let counts: Vec<usize> = (1..=8)
        .map(|order| trees.iter().filter(|tree| tree.0 == order).count())
        .collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]);
}

fn assert_near(value: f64, exact: f64, tolerance: f64, what: &str) {
    assert!(
        (value - exact).abs() < tolerance,
        "{what}: {value} instead of {exact}"
    );
}

fn check(name: &str, tableau: &Tableau) {
    let Tableau { c, a, error, dense } = tableau;
    for (c, row) in c.iter().zip(a) {
        assert_near(row.iter().sum(), *c, 1e-14, name);
    }
    let b = a[6];
    assert_eq!(b[6], 0.0, "{name}: the last stage is the next first");
    let lower: [f64; 7] = std::array::from_fn(|i| b[i] - error[i]);
    let mut lower_fails = 0.0_f64;
    for (order, weights, density) in trees(a, 5) {
        let what = format!("{name}, order {order}, density {density}");
        assert_near(dot(&b, &weights), 1.0 / density, 2e-14, &what);
        if order <= 4 {
            assert_near(dot(&lower, &weights), 1.0 / density, 2e-14, &what);
            for theta in [0.1, 0.3, 0.5, 0.77, 1.0_f64] {
                let at_theta =
                    dense.map(|[p, q, r, s]| theta * (p + theta * (q + theta * (r + theta * s))));
                let exact = theta.powi(order as i32) / density;
                assert_near(dot(&at_theta, &weights), exact, 1e-13, &what);
            }
        } else {
            lower_fails = lower_fails.max((dot(&lower, &weights) - 1.0 / density).abs());
        }
    }
    assert!(
        lower_fails > 1e-4,
        "{name}: the error estimate would be blind"
    );
}

#[test]
fn the_explicit_pairs_meet_the_order_conditions() {
    check("Dormand-Prince", &DormandPrince54::TABLEAU);
    check("Tsit5", &Tsit5::TABLEAU);
}

#[test]
fn the_dense_output_ends_where_the_step_does() {
    for Tableau { a, dense, .. } in [DormandPrince54::TABLEAU, Tsit5::TABLEAU] {
        for (stage, (weights, b)) in dense.iter().zip(a[6]).enumerate() {
            assert_near(weights.iter().sum(), b, 3e-14, "value at the end");
            let [p, q, r, s] = weights;
            let slope = p + 2.0 * q + 3.0 * r + 4.0 * s;
            let exact = if stage == 6 { 1.0 } else { 0.0 };
            assert_near(slope, exact, 3e-13, "slope at the end");
            assert_eq!(*p, if stage == 0 { 1.0 } else { 0.0 }, "slope at the start");
        }
    }
}

#[test]
fn the_method_of_order_8_meets_the_order_conditions() {
    let a = DormandPrince853::A;
    let b = a[12];
    for (c, row) in DormandPrince853::C.iter().zip(&a) {
        assert_near(row.iter().sum(), *c, 1e-14, "time of a stage");
    }
    let [fifth, third] = DormandPrince853::ERRORS;
    let mut misses = [0.0_f64; 3];
    for (order, weights, density) in trees(&a, 9) {
        let [weight, fifth, third] = [
            dot(&b, &weights) - 1.0 / density,
            (0..12).map(|i| fifth[i] * weights[i]).sum(),
            (0..12).map(|i| third[i] * weights[i]).sum(),
        ];
        let what = format!("order {order}, density {density}");
        if order <= 8 {
            assert_near(weight, 0.0, 1e-13, &what);
        }
        if order <= 5 {
            assert_near(fifth, 0.0, 2e-14, &what);
        }
        if order <= 3 {
            assert_near(third, 0.0, 2e-14, &what);
        }
        for (miss, (value, above)) in misses.iter_mut().zip([(weight, 9), (fifth, 6), (third, 4)]) {
            if order == above {
                *miss = miss.max(value.abs());
            }
        }
    }
    assert!(misses[0] > 1e-7, "order 9 would be met too: {misses:?}");
    assert!(misses[1] > 1e-5 && misses[2] > 1e-4, "blind: {misses:?}");
}

#[test]
fn the_dense_output_of_order_7_meets_the_order_conditions() {
    let a = DormandPrince853::A;
    let b = a[12];
    let unit = |stage| std::array::from_fn::<f64, 16, _>(|i| if i == stage { 1.0 } else { 0.0 });
    let (first, last) = (unit(0), unit(12));
    let mut miss = 0.0_f64;
    for theta in [0.1, 0.3, 0.5, 0.77, 1.0_f64] {
        let rest = 1.0 - theta;
        let [t1, t2, t3, t4] = [(2, 2), (3, 2), (3, 3), (4, 3)]
            .map(|(ahead, behind)| theta.powi(ahead) * rest.powi(behind));
        let [d1, d2, d3, d4] = DormandPrince853::DENSE;
        let at_theta: [f64; 16] = std::array::from_fn(|i| {
            let slopes = theta * rest * (rest * first[i] - theta * last[i]);
            let cubic = theta * theta * (3.0 - 2.0 * theta) * b[i] + slopes;
            cubic + t1 * d1[i] + t2 * d2[i] + t3 * d3[i] + t4 * d4[i]
        });
        for (order, weights, density) in trees(&a, 8) {
            let exact = theta.powi(order as i32) / density;
            let found = dot(&at_theta, &weights);
            if order <= 7 {
                assert_near(found, exact, 1e-13, &format!("order {order} at {theta}"));
            } else {
                miss = miss.max((found - exact).abs());
            }
        }
    }
    assert!(miss > 1e-7, "order 8 would be met too: {miss:e}");
}

/// (I/γ − C)⁻¹, row by row: Γ of the method, lower triangular.
fn big_gamma(gamma: f64, c: &Matrix<6>) -> Matrix<6> {
    let mut rows: Vec<[f64; 6]> = Vec::new();
    for (place, weights) in c.iter().enumerate() {
        let row = std::array::from_fn(|column| {
            let unit = if place == column { 1.0 } else { 0.0 };
            let known: f64 = weights
                .iter()
                .zip(&rows)
                .map(|(c, row)| c * row[column])
                .sum();
            gamma * (unit + known)
        });
        rows.push(row);
    }
    std::array::from_fn(|place| rows[place])
}

fn matrix_product(a: &Matrix<6>, b: &Matrix<6>) -> Matrix<6> {
    a.map(|row| std::array::from_fn(|j| (0..6).map(|k| row[k] * b[k][j]).sum()))
}

/// Conditions for a Rosenbrock method with α for the bushy and β = α + Γ for the single branches.
fn rosenbrock_trees(alpha: &Matrix<6>, beta: &Matrix<6>) -> Vec<(usize, [f64; 6], f64)> {
    let one = [1.0; 6];
    let (a, b) = (times(alpha, &one), times(beta, &one));
    let a2 = product(&a, &a);
    vec![
        (1, one, 1.0),
        (2, b, 2.0),
        (3, a2, 3.0),
        (3, times(beta, &b), 6.0),
        (4, product(&a2, &a), 4.0),
        (4, product(&a, &times(alpha, &b)), 8.0),
        (4, times(beta, &a2), 12.0),
        (4, times(beta, &times(beta, &b)), 24.0),
    ]
}

#[test]
fn rodas_meets_the_order_conditions_and_is_stiffly_accurate() {
    let RosenbrockTableau {
        gamma,
        c: times_of,
        d: weights_of_time,
        a,
        b: c,
    } = Rodas4::TABLEAU;
    let big = big_gamma(gamma, &c);
    let alpha = matrix_product(&a, &big);
    let beta: Matrix<6> = std::array::from_fn(|i| std::array::from_fn(|j| alpha[i][j] + big[i][j]));
    for i in 0..6 {
        assert_near(alpha[i].iter().sum(), times_of[i], 1e-13, "time of a stage");
        let sum: f64 = big[i].iter().sum();
        assert_near(
            sum,
            weights_of_time[i],
            1e-13,
            "weight of the time derivative",
        );
    }
    // The result is the last stage's state plus its solution; the other order is the stage's state itself.
    let (m, lower) = ([a[5][0], a[5][1], a[5][2], a[5][3], 1.0, 1.0], a[5]);
    let row = |m: &[f64; 6]| -> [f64; 6] {
        std::array::from_fn(|j| (0..6).map(|k| m[k] * big[k][j]).sum())
    };
    let (b, lower) = (row(&m), row(&lower));
    for (order, weights, density) in rosenbrock_trees(&alpha, &beta) {
        let what = format!("order {order}, density {density}");
        assert_near(dot(&b, &weights), 1.0 / density, 1e-12, &what);
        if order <= 3 {
            assert_near(dot(&lower, &weights), 1.0 / density, 1e-12, &what);
        }
    }
    for (b, last) in b.iter().zip(beta[5]) {
        assert_near(*b, last, 1e-12, "stiffly accurate: R(∞) = 0");
    }
}
