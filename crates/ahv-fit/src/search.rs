//! Which monomials are worth adding or dropping.

use rayon::prelude::*;

use crate::design::Design;
use crate::problem::Problem;

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// Adds a monomial, numbered as in the design.
    Add(usize),
    /// Drops one.
    Drop(usize),
}

/// A step of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// What it does.
    pub action: Move,
    /// Cross-validated residual before it.
    pub before: f64,
    /// And after it.
    pub after: f64,
}

/// An addition must take this share off the cross-validated residual.
const GAIN: f64 = 0.01;

/// A monomial is dropped if the cross-validated residual grows by no more than this share.
const LOSS: f64 = 0.001;

/// Steps from the monomials `start` of quantity `response`, greedily by the cross-validated residual: first whatever costs next to nothing is
/// dropped, then the `candidate` that buys most is added, as long as it buys 1 % and there are fewer than `most` steps. Those that
/// are `kept` are not dropped. A residual of rounding alone ends the search.
#[must_use]
pub fn search(
    design: &Design,
    response: usize,
    start: &[usize],
    candidates: &[usize],
    kept: &[usize],
    most: usize,
) -> Vec<Step> {
    let residual = |columns: &[usize]| Problem::new(design, response, columns).cross_validated();
    let size = design.whole.column(design.monomials + response).norm();
    let rounding = 1e-12 * size / design.weight.sqrt();
    let mut columns = start.to_vec();
    let mut steps = Vec::new();
    let mut before = residual(&columns);
    while steps.len() < most {
        let drops = columns.iter().filter(|it| !kept.contains(it));
        let drops = drops
            .map(|&it| Move::Drop(it))
            .filter(|_| columns.len() > 1);
        let adds = candidates.iter().filter(|it| !columns.contains(it));
        let adds = adds.map(|&it| Move::Add(it)).filter(|_| before > rounding);
        let best = |moves: Vec<Move>| {
            let tried = moves
                .into_par_iter()
                .map(|it| (it, residual(&moved(&columns, it))));
            let tried: Vec<(Move, f64)> = tried.collect();
            tried.into_iter().min_by(|(_, p), (_, q)| p.total_cmp(q))
        };
        let drop = best(drops.collect());
        let drop = drop.filter(|(_, after)| *after <= before.max(rounding) * (1.0 + LOSS));
        let step = drop
            .or_else(|| best(adds.collect()).filter(|(_, after)| *after < before * (1.0 - GAIN)));
        let Some((action, after)) = step else {
            break;
        };
        columns = moved(&columns, action);
        steps.push(Step {
            action,
            before,
            after,
        });
        before = after;
    }
    steps
}

fn moved(columns: &[usize], action: Move) -> Vec<usize> {
    match action {
        Move::Add(it) => columns.iter().copied().chain([it]).collect(),
        Move::Drop(dropped) => columns
            .iter()
            .copied()
            .filter(|&it| it != dropped)
            .collect(),
    }
}
