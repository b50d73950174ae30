//! The assignment problem, and roots of two systems paired by it.

use nalgebra::Complex;

/// For each root of `nominal` the place of its partner in `roots`, such that the sum of the distances is least. `None` where
/// the numbers of roots differ, or one is not finite.
pub(super) fn partners(nominal: &[Complex<f64>], roots: &[Complex<f64>]) -> Option<Vec<usize>> {
    let finite = |root: &Complex<f64>| root.re.is_finite() && root.im.is_finite();
    if roots.len() != nominal.len() || !nominal.iter().chain(roots).all(finite) {
        return None;
    }
    Some(assignment(nominal.len(), |row, column| {
        distance(nominal[row], roots[column])
    }))
}

/// For each of `n` rows its column, such that the sum of `cost` is least (the assignment problem, by the method of Kuhn and
/// Munkres with potentials).
pub fn assignment(n: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    // Rows and columns count from 1; column 0 stands for "none yet".
    let (mut row_price, mut column_price) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut row_of = vec![0; n + 1];
    for row in 1..=n {
        row_of[0] = row;
        let (mut least, mut before) = (vec![f64::INFINITY; n + 1], vec![0; n + 1]);
        let mut visited = vec![false; n + 1];
        let mut column = 0;
        while row_of[column] != 0 {
            visited[column] = true;
            let current = row_of[column];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for other in (1..=n).filter(|&other| !visited[other]) {
                let reduced =
                    cost(current - 1, other - 1) - row_price[current] - column_price[other];
                if reduced < least[other] {
                    (least[other], before[other]) = (reduced, column);
                }
                if least[other] < step {
                    (step, next) = (least[other], other);
                }
            }
            for other in 0..=n {
                if visited[other] {
                    row_price[row_of[other]] += step;
                    column_price[other] -= step;
                } else {
                    least[other] -= step;
                }
            }
            column = next;
        }
        while column != 0 {
            row_of[column] = row_of[before[column]];
            column = before[column];
        }
    }
    let mut partners = vec![0; n];
    for (column, &row) in row_of.iter().enumerate().skip(1) {
        partners[row - 1] = column - 1;
    }
    partners
}

fn distance(a: Complex<f64>, b: Complex<f64>) -> f64 {
    (a.re - b.re).hypot(a.im - b.im)
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;

    use super::partners;

    /// Against all orders of five roots.
    #[test]
    fn the_sum_of_the_distances_is_least() {
        let root = |k: f64| Complex::new((7.3 * k * k).sin() * 3.0, (2.9 * k).cos() * 5.0);
        let nominal: Vec<_> = (1..6).map(|k| root(f64::from(k))).collect();
        let roots: Vec<_> = (1..6).map(|k| root(f64::from(k) + 0.37)).collect();
        let length = |order: &[usize]| -> f64 {
            let pairs = nominal.iter().zip(order);
            pairs
                .map(|(a, &b)| {
                    let apart = a - roots[b];
                    apart.re.hypot(apart.im)
                })
                .sum()
        };
        let mut least = f64::INFINITY;
        let mut orders = vec![vec![]];
        for place in 0..5 {
            let longer = |order: &Vec<usize>| {
                (0..=place)
                    .map(|at| {
                        let mut longer = order.clone();
                        longer.insert(at, place);
                        longer
                    })
                    .collect::<Vec<_>>()
            };
            orders = orders.iter().flat_map(longer).collect();
        }
        assert_eq!(orders.len(), 120);
        for order in &orders {
            least = least.min(length(order));
        }
        let found = partners(&nominal, &roots).expect("equally many");
        assert!((length(&found) - least).abs() < 1e-12);
        assert_eq!(partners(&nominal, &roots[1..]), None);
    }
}
