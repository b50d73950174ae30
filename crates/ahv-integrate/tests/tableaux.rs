//! The coefficients against the order conditions, so that no digit is mistyped.
#![forbid(unsafe_code)]

use ahv_integrate::{DormandPrince54, EmbeddedPair, Rodas4, RosenbrockTableau, Tableau, Tsit5};

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

/// Elementary weights of the rooted trees up to order 5, without the weights b, and their densities.
fn trees<const N: usize>(a: &Matrix<N>) -> Vec<(usize, [f64; N], f64)> {
    let one = [1.0; N];
    let c = times(a, &one);
    let c2 = product(&c, &c);
    let c3 = product(&c2, &c);
    let ac = times(a, &c);
    let ac2 = times(a, &c2);
    let aac = times(a, &ac);
    vec![
        (1, one, 1.0),
        (2, c, 2.0),
        (3, c2, 3.0),
        (3, ac, 6.0),
        (4, c3, 4.0),
        (4, product(&c, &ac), 8.0),
        (4, ac2, 12.0),
        (4, aac, 24.0),
        (5, product(&c3, &c), 5.0),
        (5, product(&c2, &ac), 10.0),
        (5, product(&ac, &ac), 20.0),
        (5, product(&c, &ac2), 15.0),
        (5, product(&c, &aac), 30.0),
        (5, times(a, &c3), 20.0),
        (5, times(a, &product(&c, &ac)), 40.0),
        (5, times(a, &ac2), 60.0),
        (5, times(a, &aac), 120.0),
    ]
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
    for (order, weights, density) in trees(a) {
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
