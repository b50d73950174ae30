//! Which drawn parameters the lost members, and the states at the end, have to do with.

use ahv_analysis::monte_carlo::MemberRecord;
use ahv_analysis::statistics::{chance_of_rank_correlation, rank_correlation};
use serde::Serialize;

use crate::flights::Ready;
use crate::output::Pairs;

/// Members that are kept for it at most, the first ones: memory is not to grow with the members.
const MOST_KEPT: u64 = 10_000;
/// How often a correlation may stand there by chance, one of all parameters for one outcome.
const CHANCE: f64 = 0.05;

/// The parameters that one outcome has to do with.
#[derive(Serialize)]
pub(super) struct Cause {
    /// `lost`, or a state at the end.
    pub(super) of: &'static str,
    /// Spearman's rank correlation by parameter, the strongest first: those that are no chance.
    pub(super) correlations: Pairs<f64>,
    /// Members that they are of.
    members: usize,
}

/// Members as they came.
#[derive(Default)]
pub(super) struct Kept {
    /// Drawn parameters of each.
    drawn: Vec<Vec<f64>>,
    /// Last state of each, and whether it was lost.
    seen: Vec<(Vec<f64>, bool)>,
}

impl Kept {
    /// Keeps members from number `first` on.
    pub(super) fn add(&mut self, ready: &Ready, first: u64, seen: &[MemberRecord]) {
        let Some(draws) = &ready.experiment.dispersion else {
            return;
        };
        for (member, seen) in (first..MOST_KEPT).zip(seen) {
            self.drawn.push(draws.member_values(member));
            self.seen.push((seen.last.clone(), seen.lost.is_some()));
        }
    }

    /// What they have in common.
    pub(super) fn causes(&self, ready: &Ready) -> Vec<Cause> {
        let Some(draws) = &ready.experiment.dispersion else {
            return Vec::new();
        };
        let names = ready.vehicle.model.parameters().names;
        let varied = draws.varied();
        let cause = |of, members: &[usize], outcome: &dyn Fn(usize) -> f64| {
            let outcomes: Vec<f64> = members.iter().map(|&it| outcome(it)).collect();
            let correlation = |&parameter: &usize| {
                let drawn: Vec<f64> = members
                    .iter()
                    .map(|&it| self.drawn[it][parameter])
                    .collect();
                let rank = rank_correlation(&drawn, &outcomes)?;
                // One of so many would stand out by chance more often than one alone.
                let chance = chance_of_rank_correlation(rank, members.len()) * varied.len() as f64;
                (chance < CHANCE).then_some((names[parameter], rank))
            };
            let mut correlations: Vec<_> = varied.iter().filter_map(correlation).collect();
            correlations.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
            Cause {
                of,
                correlations: Pairs(correlations),
                members: members.len(),
            }
        };
        let all: Vec<usize> = (0..self.seen.len()).collect();
        let flown: Vec<usize> = all.iter().copied().filter(|&it| !self.seen[it].1).collect();
        let lost = cause("lost", &all, &|it| f64::from(u8::from(self.seen[it].1)));
        let states = ready.vehicle.states.names.iter().enumerate();
        let states = states.map(|(index, &name)| cause(name, &flown, &|it| self.seen[it].0[index]));
        std::iter::once(lost).chain(states).collect()
    }
}
