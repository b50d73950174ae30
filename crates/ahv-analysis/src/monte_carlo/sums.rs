//! Sums over members that have the same bits whatever parts they are summed in.
//!
//! Members are summed in their order within blocks of [`BLOCK`], and blocks two by two: block 0 with 1, 2 with 3, then the
//! sums of 0 and 1 with those of 2 and 3, and so on. That tree is the same wherever a part begins and ends, as long as parts
//! begin with a block. What is summed about, and the bins of the quantiles, the first block chooses for all.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::bits;
use super::experiment::{Experiment, MemberRecord};
use super::outcome::{Snapshot, StateSpread};
use super::spread::{Bins, QUANTILES, Spread};
use crate::statistics::{Estimate, OpenEstimate, deviation_of, mean_and_std};

/// Members that are summed one by one.
pub const BLOCK: u64 = 2048;

/// Bins of the histograms that are reported.
const HISTOGRAM_BINS: usize = 60;

/// What a state's numbers are summed about, and counted in: of each state at each snapshot.
///
/// Of the first block those choose that fly at the snapshot, or if none does all, by their last states: near mean and standard
/// deviation of all, nothing cancels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference(Vec<Vec<StateReference>>);

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StateReference {
    #[serde(with = "bits::one")]
    origin: f64,
    /// Unit of the third and the fourth power.
    #[serde(with = "bits::one")]
    scale: f64,
    #[serde(with = "bits::one")]
    low: f64,
    #[serde(with = "bits::one")]
    width: f64,
}

impl StateReference {
    fn of(first: &[f64]) -> Self {
        let (origin, std) = mean_and_std(first);
        let Bins { low, width } = Bins::of(first);
        Self {
            origin,
            scale: if std > 0.0 { std } else { 1.0 },
            low,
            width,
        }
    }

    fn bins(self) -> Bins {
        Bins {
            low: self.low,
            width: self.width,
        }
    }
}

impl Reference {
    /// What a state's numbers at a snapshot are summed about, and in which unit.
    pub(super) fn origin_and_unit(&self, snapshot: usize, state: usize) -> Option<[f64; 2]> {
        let it = self.0.get(snapshot)?.get(state)?;
        Some([it.origin, it.scale])
    }

    /// That of the members of the first block.
    pub(super) fn of(experiment: &Experiment, first: &[MemberRecord]) -> Self {
        let states = experiment.state[0].len();
        let snapshots = (0..experiment.snapshots.len())
            .into_par_iter()
            .map(|index| {
                let flying = || first.iter().filter_map(|seen| seen.state(index));
                let all = || first.iter().map(|seen| &*seen.last);
                let some = flying().next().is_some();
                let column = |state: usize| -> Vec<f64> {
                    if some {
                        flying().filter_map(|x| x.get(state).copied()).collect()
                    } else {
                        all().filter_map(|x| x.get(state).copied()).collect()
                    }
                };
                let states = (0..states).map(|state| StateReference::of(&column(state)));
                states.collect()
            });
        Self(snapshots.collect())
    }
}

/// What members in a row show: sums and counts, which those of the next ones join.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Part {
    /// Number of the first member.
    first: u64,
    members: u64,
    /// Sums of blocks, in order, as far as they are joined.
    nodes: Vec<Node>,
    /// Of each snapshot.
    counts: Vec<Counts>,
}

/// The sums of 2^level blocks, which begin with number index · 2^level.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Node {
    level: u32,
    index: u64,
    /// Of each snapshot.
    sums: Vec<Sums>,
}

/// Numbers of members, which add up in any order.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Counts {
    spreads: Vec<Spread>,
    left: Vec<Vec<u64>>,
    left_any: Vec<u64>,
}

/// Sums of powers of the states' deviations from their origins, at a snapshot.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Sums {
    count: u64,
    #[serde(with = "bits::many")]
    first: Vec<f64>,
    /// Of the deviation in units of the scale.
    #[serde(with = "bits::many")]
    third: Vec<f64>,
    /// Of the deviation in units of the scale.
    #[serde(with = "bits::many")]
    fourth: Vec<f64>,
    /// Products of the deviations, row by row.
    #[serde(with = "bits::many")]
    second: Vec<f64>,
    /// Members that fly and have stayed in the first set of intervals.
    stayed: u64,
    /// Their mean, and the sum of squared deviations from it: what diverges among the others does not spoil them.
    #[serde(with = "bits::many")]
    mean: Vec<f64>,
    #[serde(with = "bits::many")]
    squares: Vec<f64>,
}

impl Part {
    /// Of no members so far; the first will be `first`, a multiple of [`BLOCK`].
    pub(super) fn new(experiment: &Experiment, reference: &Reference, first: u64) -> Self {
        let (sets, states) = (experiment.watched.len(), experiment.state[0].len());
        let counts = reference.0.iter().map(|states_of| Counts {
            spreads: states_of.iter().map(|it| Spread::new(it.bins())).collect(),
            left: vec![vec![0; states]; sets],
            left_any: vec![0; sets],
        });
        Self {
            first,
            members: 0,
            nodes: Vec::new(),
            counts: counts.collect(),
        }
    }

    /// How many members it is of.
    pub fn members(&self) -> u64 {
        self.members
    }

    /// Adds the members of the next block.
    pub(super) fn add(
        &mut self,
        experiment: &Experiment,
        reference: &Reference,
        seen: &[MemberRecord],
    ) {
        let (member, first_of_all) = (self.first + self.members, self.members == 0);
        let snapshots = self.counts.par_iter_mut().zip(&reference.0);
        let snapshots = snapshots.zip(&experiment.snapshots).enumerate();
        let sums = snapshots.map(|(index, ((counts, states), &step))| {
            let values: Vec<&[f64]> = seen.iter().filter_map(|seen| seen.state(index)).collect();
            for (state, spread) in counts.spreads.iter_mut().enumerate() {
                let column = values.iter().filter_map(|x| x.get(state).copied());
                spread.extend(&column.collect::<Vec<_>>(), first_of_all);
            }
            let mut stayed = Vec::new();
            for seen in seen {
                // Those that are lost before have no values.
                let left = counts.leave(&seen.left, step);
                stayed.extend(seen.state(index).filter(|_| !left));
            }
            Sums::of(states, &values, &stayed)
        });
        let node = Node {
            level: 0,
            index: member / BLOCK,
            sums: sums.collect(),
        };
        self.members += seen.len() as u64;
        push(&mut self.nodes, node);
    }

    /// Joins the part of the members that come next.
    pub(super) fn join(&mut self, next: Self) {
        let first_of_all = self.members == 0;
        for (own, next) in self.counts.iter_mut().zip(next.counts) {
            own.join(next, first_of_all);
        }
        self.members += next.members;
        for node in next.nodes {
            push(&mut self.nodes, node);
        }
    }

    /// Forgets numbers as they are, which only a whole of one block reports.
    pub fn forget_numbers(&mut self) {
        let spreads = self.counts.iter_mut().flat_map(|it| &mut it.spreads);
        spreads.for_each(Spread::forget);
    }

    /// Whether it is of `members` members from number `first` on, of this experiment and with this reference.
    pub fn is_of(
        &self,
        experiment: &Experiment,
        reference: &Reference,
        first: u64,
        members: u64,
    ) -> bool {
        let (sets, states) = (experiment.watched.len(), experiment.state[0].len());
        let counted = |(counts, states_of): (&Counts, &Vec<StateReference>)| {
            let mut spreads = counts.spreads.iter().zip(states_of);
            counts.spreads.len() == states
                && spreads.all(|(spread, it)| spread.has(it.bins()))
                && counts.left.len() == sets
                && counts.left.iter().all(|it| it.len() == states)
                && counts.left_any.len() == sets
        };
        let summed = |node: &Node| {
            node.sums.len() == reference.0.len() && node.sums.iter().all(|it| it.has(states))
        };
        self.first == first
            && self.members == members
            && self.counts.len() == reference.0.len()
            && self.counts.iter().zip(&reference.0).all(counted)
            && self.nodes.iter().all(summed)
    }

    /// What its members show at the snapshots.
    pub(super) fn snapshots(
        &self,
        experiment: &Experiment,
        reference: &Reference,
    ) -> Vec<Snapshot> {
        let mut nodes = self.nodes.iter().rev();
        let mut all = nodes
            .next()
            .map(|node| node.sums.clone())
            .unwrap_or_default();
        for node in nodes {
            let mut left = node.sums.clone();
            join(&mut left, &all);
            all = left;
        }
        let states = experiment.state[0].len();
        all.resize_with(reference.0.len(), || Sums::new(states));
        let times = experiment
            .snapshots
            .iter()
            .map(|&step| step as f64 * experiment.dt);
        let shown = all.iter().zip(&self.counts).zip(&reference.0).zip(times);
        shown
            .map(|(((sums, counts), states), time)| sums.snapshot(counts, states, time))
            .collect()
    }
}

/// Puts a node behind the others, and joins those that are halves of one.
fn push(nodes: &mut Vec<Node>, node: Node) {
    nodes.push(node);
    while let [.., left, right] = &mut **nodes {
        let halves =
            left.level == right.level && left.index % 2 == 0 && left.index + 1 == right.index;
        if !halves {
            return;
        }
        join(&mut left.sums, &right.sums);
        (left.level, left.index) = (left.level + 1, left.index / 2);
        nodes.pop();
    }
}

fn join(left: &mut [Sums], right: &[Sums]) {
    left.iter_mut()
        .zip(right)
        .for_each(|(left, right)| left.join(right));
}

impl Counts {
    /// Counts what a member has left after so many steps; whether it has left the first of the sets.
    fn leave(&mut self, left: &[Vec<Option<u64>>], step: u64) -> bool {
        let mut first = None;
        let sets = left.iter().zip(&mut self.left).zip(&mut self.left_any);
        for ((left, counts), any) in sets {
            let mut some = false;
            for (state, count) in counts.iter_mut().enumerate() {
                let by_then = left
                    .get(state)
                    .is_some_and(|left| left.is_some_and(|left| left <= step));
                *count += u64::from(by_then);
                some |= by_then;
            }
            *any += u64::from(some);
            first.get_or_insert(some);
        }
        first.unwrap_or(false)
    }

    fn join(&mut self, next: Self, first_of_all: bool) {
        if first_of_all {
            *self = next;
            return;
        }
        for (own, next) in self.spreads.iter_mut().zip(&next.spreads) {
            own.merge(next);
        }
        let own = self.left.iter_mut().flatten().chain(&mut self.left_any);
        let next = next.left.iter().flatten().chain(&next.left_any);
        own.zip(next).for_each(|(own, next)| *own += next);
    }
}

impl Sums {
    fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        Self {
            count: 0,
            first: zeros(),
            third: zeros(),
            fourth: zeros(),
            second: vec![0.0; states * states],
            stayed: 0,
            mean: zeros(),
            squares: zeros(),
        }
    }

    /// Of the members of a block that fly, and of those that have stayed.
    fn of(states: &[StateReference], flying: &[&[f64]], stayed: &[&[f64]]) -> Self {
        let mut sums = Self::new(states.len());
        let mut deviation = vec![0.0; states.len()];
        for x in flying {
            let origins = deviation.iter_mut().zip(*x).zip(states);
            origins.for_each(|((deviation, x), state)| *deviation = x - state.origin);
            for (index, (&a, state)) in deviation.iter().zip(states).enumerate() {
                let scaled = a / state.scale;
                let cube = scaled * scaled * scaled;
                sums.first[index] += a;
                sums.third[index] += cube;
                sums.fourth[index] += cube * scaled;
            }
            let rows = sums.second.chunks_mut(states.len().max(1));
            for (row, &a) in rows.zip(&deviation) {
                row.iter_mut()
                    .zip(&deviation)
                    .for_each(|(sum, &b)| *sum += a * b);
            }
        }
        sums.count = flying.len() as u64;
        sums.stayed = stayed.len() as u64;
        if stayed.is_empty() {
            return sums;
        }
        for (index, (mean, squares)) in sums.mean.iter_mut().zip(&mut sums.squares).enumerate() {
            let column = stayed.iter().filter_map(|x| x.get(index).copied());
            let (of_column, std) = mean_and_std(&column.collect::<Vec<_>>());
            (*mean, *squares) = (of_column, std * std * (stayed.len() as f64 - 1.0));
        }
        sums
    }

    /// Whether it is of so many states.
    fn has(&self, states: usize) -> bool {
        let all = [
            &self.first,
            &self.third,
            &self.fourth,
            &self.mean,
            &self.squares,
        ];
        all.iter().all(|it| it.len() == states) && self.second.len() == states * states
    }

    /// The sums of these members and of those that come next (means by Chan, Golub and LeVeque 1979).
    fn join(&mut self, next: &Self) {
        let columns = [
            (&mut self.first, &next.first),
            (&mut self.third, &next.third),
            (&mut self.fourth, &next.fourth),
            (&mut self.second, &next.second),
        ];
        for (own, next) in columns {
            own.iter_mut()
                .zip(next)
                .for_each(|(own, next)| *own += next);
        }
        self.count += next.count;
        let (own, n) = (self.stayed as f64, next.stayed as f64);
        self.stayed += next.stayed;
        if next.stayed == 0 {
            return;
        }
        let own_moments = self.mean.iter_mut().zip(&mut self.squares);
        for ((mean, squares), (other, other_squares)) in
            own_moments.zip(next.mean.iter().zip(&next.squares))
        {
            let (off, all) = (other - *mean, own + n);
            *squares += other_squares + off * off * own * n / all;
            *mean += off * n / all;
        }
    }

    /// m₄/m₂² of a state; 3 where all numbers are equal.
    fn kurtosis(&self, state: usize, scale: f64) -> f64 {
        let n = self.count as f64;
        let of = |sums: &[f64]| sums.get(state).copied().unwrap_or(f64::NAN) / n;
        let second = self.second.get(state * self.first.len() + state);
        let mean = of(&self.first) / scale;
        let square = second.copied().unwrap_or(f64::NAN) / n / (scale * scale);
        let variance = square - mean * mean;
        if variance <= 0.0 {
            return 3.0;
        }
        let cube = of(&self.third);
        let fourth =
            of(&self.fourth) - 4.0 * mean * cube + 6.0 * mean * mean * square - 3.0 * mean.powi(4);
        // Rounding must not push it below its least value.
        (fourth / (variance * variance)).max(1.0)
    }

    fn snapshot(&self, counts: &Counts, states: &[StateReference], time: f64) -> Snapshot {
        let n = self.count as f64;
        let means: Vec<f64> = self.first.iter().map(|first| first / n).collect();
        let rows = self.second.chunks(means.len().max(1)).zip(&means);
        let covariance: Vec<Vec<f64>> = rows
            .map(|(row, a)| {
                let entry = |(sum, b): (&f64, &f64)| (sum - n * a * b) / (n - 1.0);
                row.iter().zip(&means).map(entry).collect()
            })
            .collect();
        let each = states.iter().zip(&counts.spreads).zip(&means).enumerate();
        let each = each.map(|(index, ((state, spread), mean))| {
            let variance = covariance.get(index).and_then(|row| row.get(index));
            let std = deviation_of(variance.copied().unwrap_or(f64::NAN));
            let mean = state.origin + mean;
            let kurtosis = self.kurtosis(index, state.scale);
            // One number has no spread.
            let squares = self.squares.get(index).filter(|_| self.stayed > 1);
            let of_stayed = squares.map(|it| (it / (self.stayed - 1) as f64).sqrt());
            StateSpread {
                mean: Some(Estimate::of_mean(mean, std, n)).filter(|it| n > 1.0 && it.is_finite()),
                std: Some(OpenEstimate::of_std(std, kurtosis, n))
                    .filter(|it| n > 1.0 && it.is_finite()),
                remains: None,
                std_of_stayed: of_stayed.filter(|std| std.is_finite()),
                quantiles: QUANTILES.map(|share| spread.quantile(share)),
                resolution: spread.resolution(),
                histogram: spread.histogram(HISTOGRAM_BINS),
            }
        });
        Snapshot {
            time,
            members: self.count,
            states: each.collect(),
            covariance,
            left: counts.left.clone(),
            left_any: counts.left_any.clone(),
            stayed: self.stayed,
        }
    }
}
