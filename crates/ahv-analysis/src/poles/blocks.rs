//! Blocks of states that act on each other.

use nalgebra::DMatrix;

/// The states in blocks: those of one act on each other, through however many states. Ordered so, the matrix is block
/// triangular, and its eigenvalues are those of the blocks.
pub(super) fn blocks(a: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = a.nrows();
    let mut reaches = a.map(|entry| entry != 0.0);
    for through in 0..n {
        for from in 0..n {
            for to in 0..n {
                reaches[(to, from)] |= reaches[(to, through)] && reaches[(through, from)];
            }
        }
    }
    let together = |i: usize, j: usize| i == j || (reaches[(i, j)] && reaches[(j, i)]);
    let first = |state: &usize| (0..*state).all(|earlier| !together(*state, earlier));
    let block = |state: usize| (state..n).filter(|&other| together(state, other)).collect();
    (0..n).filter(first).map(block).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_that_act_on_each_other_are_together() {
        // 0 and 2 through 3; 1 is driven by all, 4 by nothing.
        let mut a = DMatrix::zeros(5, 5);
        for (row, column) in [(2, 0), (3, 2), (0, 3), (1, 0), (1, 1), (0, 4)] {
            a[(row, column)] = 1.0;
        }
        assert_eq!(blocks(&a), [vec![0, 2, 3], vec![1], vec![4]]);
    }
}
