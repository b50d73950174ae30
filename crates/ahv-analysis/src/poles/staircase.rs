//! Staircase reduction of a system pencil (Emami-Naeini and Van Dooren 1982, Misra, Van Dooren and Varga 1994).
//!
//! Orthogonal transformations compress the rows of D, then the columns of that part of C whose outputs have no direct
//! input. These outputs see as many combinations of states, whose derivatives take their place: the system shrinks by
//! these states, and its invariant zeros stay. What repeats until D has full row rank, and once more for the dual
//! system until D is square and regular, also counts: a rank of D that grows at step k is an infinite zero of order k,
//! an output that vanishes there a left Kronecker index k, and in the dual system a right one.

use nalgebra::{DMatrix, DVector};

/// dx/dt = a x + b u, y = c x + d u.
#[derive(Clone)]
pub(super) struct Quadruple {
    pub(super) a: DMatrix<f64>,
    pub(super) b: DMatrix<f64>,
    pub(super) c: DMatrix<f64>,
    pub(super) d: DMatrix<f64>,
}

/// A system without its infinite and singular part, and what that part was.
pub(super) struct Reduced {
    /// The rest, with a square and regular d: its zeros are the finite invariant zeros.
    pub(super) regular: Quadruple,
    /// Orders of the infinite zeros, ascending.
    pub(super) infinite_orders: Vec<usize>,
    /// Right Kronecker indices, ascending: one for each input that adds nothing to the rank.
    pub(super) right_indices: Vec<usize>,
    /// Left Kronecker indices, ascending: one for each output that adds nothing to the rank.
    pub(super) left_indices: Vec<usize>,
}

/// A system whose d has full row rank, and what was found on the way.
struct Peeled {
    rest: Quadruple,
    /// Rank of d at each step.
    ranks: Vec<usize>,
    /// Outputs that vanished at each step.
    vanished: Vec<usize>,
}

/// Reduces `system`; an entry of a triangular factor up to `tolerance` counts as 0. `None` if the ranks of the system
/// and of its dual contradict each other, since one of them lies at the tolerance.
pub(super) fn reduce(system: Quadruple, tolerance: f64) -> Option<Reduced> {
    let rows = peel(system, tolerance);
    let columns = peel(rows.rest.dual(), tolerance);
    let regular = columns.rest.dual();
    let growth = rows
        .ranks
        .windows(2)
        .map(|pair| pair[1].saturating_sub(pair[0]));
    (regular.d.nrows() == regular.d.ncols()).then(|| Reduced {
        infinite_orders: repeated(growth.zip(1..)),
        right_indices: repeated(columns.vanished.iter().copied().zip(0..)),
        left_indices: repeated(rows.vanished.iter().copied().zip(0..)),
        regular,
    })
}

/// Each number as often as its count says.
fn repeated(counts: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    counts
        .flat_map(|(count, number)| std::iter::repeat_n(number, count))
        .collect()
}

/// Takes states away until d has full row rank.
fn peel(mut rest: Quadruple, tolerance: f64) -> Peeled {
    let (mut ranks, mut vanished) = (Vec::new(), Vec::new());
    loop {
        let direct = rest.compress_outputs(tolerance);
        let seen = rest.compress_states(direct, tolerance);
        ranks.push(direct);
        vanished.push(rest.c.nrows() - direct - seen);
        rest = rest.without(direct, seen);
        if seen == 0 {
            return Peeled {
                rest,
                ranks,
                vanished,
            };
        }
    }
}

impl Quadruple {
    fn dual(&self) -> Self {
        Self {
            a: self.a.transpose(),
            b: self.c.transpose(),
            c: self.b.transpose(),
            d: self.d.transpose(),
        }
    }

    /// Rotates the outputs so that the rows of d from its rank on are 0; returns the rank.
    fn compress_outputs(&mut self, tolerance: f64) -> usize {
        let rotation = Rotation::compressing(self.d.clone(), tolerance);
        rotation.apply(&mut self.d);
        rotation.apply(&mut self.c);
        self.d.rows_range_mut(rotation.rank()..).fill(0.0);
        rotation.rank()
    }

    /// Rotates the states so that the outputs from number `direct` on see the first ones alone; returns how many.
    fn compress_states(&mut self, direct: usize, tolerance: f64) -> usize {
        let rotation = Rotation::compressing(self.c.rows_range(direct..).transpose(), tolerance);
        rotation.apply(&mut self.a);
        rotation.apply(&mut self.b);
        for matrix in [&mut self.a, &mut self.c] {
            let mut transposed = matrix.transpose();
            rotation.apply(&mut transposed);
            *matrix = transposed.transpose();
        }
        rotation.rank()
    }

    /// The system without its first `seen` states, whose derivatives become outputs beside the first `direct` ones.
    fn without(&self, direct: usize, seen: usize) -> Self {
        let states = self.a.nrows() - seen;
        let stacked = |outputs: &DMatrix<f64>, rates: &DMatrix<f64>, from: usize| {
            let columns = outputs.ncols() - from;
            let mut stacked = DMatrix::zeros(direct + seen, columns);
            let above = outputs.view((0, from), (direct, columns));
            stacked
                .view_mut((0, 0), (direct, columns))
                .copy_from(&above);
            let below = rates.view((0, from), (seen, columns));
            stacked
                .view_mut((direct, 0), (seen, columns))
                .copy_from(&below);
            stacked
        };
        Self {
            a: self.a.view((seen, seen), (states, states)).into_owned(),
            b: self.b.rows_range(seen..).into_owned(),
            c: stacked(&self.c, &self.a, seen),
            d: stacked(&self.d, &self.b, 0),
        }
    }
}

/// Householder reflections I − τ v vᵀ, each of the rows from its own number on.
///
/// There are as many as the rank: what counts as 0 must not turn anything. A rotation by the direction of rounding mixes
/// states that nothing connects, and small pivots enlarge that from step to step.
struct Rotation(Vec<(DVector<f64>, f64)>);

impl Rotation {
    /// The one that makes the rows of `matrix` from its rank on 0, by QR with column pivoting up to `tolerance`.
    fn compressing(mut matrix: DMatrix<f64>, tolerance: f64) -> Self {
        let mut reflections = Vec::new();
        for step in 0..matrix.nrows().min(matrix.ncols()) {
            let rest = matrix.view_range(step.., step..);
            let norms: Vec<f64> = rest.column_iter().map(|column| column.norm()).collect();
            let largest = (0..norms.len()).max_by(|&i, &j| norms[i].total_cmp(&norms[j]));
            let Some(pivot) = largest.filter(|&pivot| norms[pivot] > tolerance) else {
                break;
            };
            let mut axis = rest.column(pivot).into_owned();
            let beta = -norms[pivot].copysign(axis[0]);
            let factor = (beta - axis[0]) / beta;
            axis[0] -= beta;
            axis /= axis[0];
            matrix.swap_columns(step, step + pivot);
            let reflection = (axis, factor);
            reflect(&mut matrix, step, &reflection);
            reflections.push(reflection);
        }
        Self(reflections)
    }

    fn rank(&self) -> usize {
        self.0.len()
    }

    /// Rotates the rows of `matrix`.
    fn apply(&self, matrix: &mut DMatrix<f64>) {
        for (step, reflection) in self.0.iter().enumerate() {
            reflect(matrix, step, reflection);
        }
    }
}

/// Reflects the rows of `matrix` from number `step` on.
fn reflect(matrix: &mut DMatrix<f64>, step: usize, (axis, factor): &(DVector<f64>, f64)) {
    let mut rows = matrix.rows_range_mut(step..);
    for mut column in rows.column_iter_mut() {
        let along = axis.dot(&column);
        column.axpy(-factor * along, axis, 1.0);
    }
}
