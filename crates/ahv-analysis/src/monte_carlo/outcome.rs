//! What many members show together.

use std::time::Duration;

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::Loss;
use super::companion::Companion;
use super::control_variate::{ControlSums, Remains};
use super::experiment::{Experiment, MemberRecord, row};
use super::spread::{Bin, QUANTILES, Spread};
use crate::statistics::{Estimate, OpenEstimate, deviation_of, mean_and_std};

/// Losses that are told one by one.
const LISTED_LOSSES: usize = 20;

/// What members show together.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Members that were flown.
    pub members: u64,
    /// Members that were asked for; more than were flown if the work was stopped.
    pub asked: u64,
    /// What is seen at each snapshot.
    pub snapshots: Vec<Snapshot>,
    /// Members that were lost, and the first of them.
    pub lost: u64,
    /// Of these, members whose parameters break a rule: they do not fly.
    pub not_flown: u64,
    /// The first that were lost, by number of the member.
    pub losses: Vec<(u64, Loss)>,
    /// SHA-256 of the bits of the members' last states: component by component, little end first, member by member.
    pub digest: String,
    /// Steps of these members, to the end of the flight also for those that were lost.
    pub member_steps: u64,
    /// Time that it took.
    pub elapsed: Duration,
}

impl Outcome {
    /// Members that flew.
    pub fn flown(&self) -> u64 {
        self.members - self.not_flown
    }
}

/// What is seen of the members at one time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time, in s.
    pub time: f64,
    /// Members that still fly; of them are all that follows but `left`.
    pub members: u64,
    /// Each state.
    pub states: Vec<StateSpread>,
    /// Covariance of the states; infinite where numbers are too large.
    pub covariance: Vec<Vec<f64>>,
    /// For each set of watched intervals, how many members have left that of a state so far.
    pub left: Vec<Vec<u64>>,
    /// For each set of watched intervals, how many members have left any so far.
    pub left_any: Vec<u64>,
    /// Members that still fly and have stayed in the first set of watched intervals so far.
    pub stayed: u64,
}

/// How one state spreads over the members.
#[derive(Clone, Debug)]
pub struct StateSpread {
    /// Mean with its interval of 95 %; `None` where numbers are too large, or members too few.
    pub mean: Option<Estimate>,
    /// Standard deviation with its interval of 95 %, by the fourth moment; `None` as for the mean.
    pub std: Option<OpenEstimate>,
    /// What remains of the variances of both by the control variate; `None` where they are the sample's own.
    pub remains: Option<Remains>,
    /// Standard deviation of those that have stayed in the first of the watched intervals so far; `None` as for the mean.
    pub std_of_stayed: Option<f64>,
    /// Quantiles of [`QUANTILES`], each with its interval of 95 %.
    pub quantiles: [OpenEstimate; QUANTILES.len()],
    /// What the bins of the quantiles add to their error, in the unit of the state.
    pub resolution: f64,
    /// Counts between the least and the greatest number.
    pub histogram: Vec<Bin>,
}

/// Bins of the histograms that are told.
const HISTOGRAM_BINS: usize = 60;

/// Sums over members, in their order.
pub(super) struct Collector<'e> {
    experiment: &'e Experiment,
    companion: Option<&'e Companion>,
    sums: Vec<Sums>,
    members: u64,
    lost: u64,
    not_flown: u64,
    losses: Vec<(u64, Loss)>,
    hash: Sha256,
}

/// What is summed at a snapshot.
struct Sums {
    count: u64,
    /// Sums of each state.
    states: Vec<PowerSums>,
    /// Products of the deviations from the origins, by rows.
    second: Vec<Vec<f64>>,
    spreads: Vec<Spread>,
    /// Of each state; empty without control variate.
    control: Vec<ControlSums>,
    left: Vec<Vec<u64>>,
    left_any: Vec<u64>,
    stayed: u64,
    /// Of each state, of those that have stayed.
    stayed_moments: Vec<RunningMoments>,
}

/// Mean and sum of squared deviations from it, of numbers that come group by group (Chan, Golub and LeVeque 1979): what
/// diverges among others does not spoil them.
#[derive(Clone, Copy, Default)]
struct RunningMoments {
    mean: f64,
    squares: f64,
}

impl RunningMoments {
    /// `new` numbers more, after `count`.
    fn add(&mut self, count: f64, new: &[f64]) {
        let n = new.len() as f64;
        let (mean, std) = mean_and_std(new);
        let (off, all) = (mean - self.mean, count + n);
        self.squares += std * std * (n - 1.0) + off * off * count * n / all;
        self.mean += off * n / all;
    }
}

/// Sums of powers of a state's deviation from an origin.
///
/// Origin and scale are mean and standard deviation of the first members that are added, however many follow: near those of
/// all, nothing cancels.
#[derive(Clone, Copy)]
struct PowerSums {
    origin: f64,
    scale: f64,
    first: f64,
    /// Of the deviation in units of the scale.
    third: f64,
    /// Of the deviation in units of the scale.
    fourth: f64,
}

impl PowerSums {
    fn about(first: &[f64]) -> Self {
        let (origin, std) = mean_and_std(first);
        Self {
            origin,
            scale: if std > 0.0 { std } else { 1.0 },
            first: 0.0,
            third: 0.0,
            fourth: 0.0,
        }
    }

    fn add(&mut self, deviation: f64) {
        let scaled = deviation / self.scale;
        let cube = scaled * scaled * scaled;
        self.first += deviation;
        self.third += cube;
        self.fourth += cube * scaled;
    }

    /// m₄/m₂² of `count` numbers with the sum `second` of squared deviations; 3 where all are equal.
    fn kurtosis(&self, second: f64, count: f64) -> f64 {
        let mean = self.first / count / self.scale;
        let square = second / count / (self.scale * self.scale);
        let variance = square - mean * mean;
        if variance <= 0.0 {
            return 3.0;
        }
        let cube = self.third / count;
        let fourth = self.fourth / count - 4.0 * mean * cube + 6.0 * mean * mean * square
            - 3.0 * mean.powi(4);
        // Rounding must not push it below its least value.
        (fourth / (variance * variance)).max(1.0)
    }
}

impl<'e> Collector<'e> {
    pub(super) fn new(experiment: &'e Experiment, companion: Option<&'e Companion>) -> Self {
        let states = experiment.state[0].len();
        let sums = experiment.snapshots.iter().map(|_| Sums {
            count: 0,
            states: Vec::new(),
            second: vec![vec![0.0; states]; states],
            spreads: Vec::new(),
            control: vec![ControlSums::default(); companion.map_or(0, |_| states)],
            left: vec![vec![0; states]; experiment.watched.len()],
            left_any: vec![0; experiment.watched.len()],
            stayed: 0,
            stayed_moments: vec![RunningMoments::default(); states],
        });
        Self {
            sums: sums.collect(),
            experiment,
            companion,
            members: 0,
            lost: 0,
            not_flown: 0,
            losses: Vec::new(),
            hash: Sha256::new(),
        }
    }

    /// Members from number `first` on.
    pub(super) fn add(&mut self, first: u64, seen: &[MemberRecord]) {
        for (member, seen) in (first..).zip(seen) {
            for value in &seen.last {
                self.hash.update(value.to_le_bytes());
            }
            if let Some(loss) = seen.lost {
                self.lost += 1;
                self.not_flown += u64::from(loss.rule.is_some());
                if self.losses.len() < LISTED_LOSSES {
                    self.losses.push((member, loss));
                }
            }
        }
        self.members += seen.len() as u64;
        let steps = self.experiment.snapshots.par_iter();
        let sums = self.sums.par_iter_mut().zip(steps).enumerate();
        sums.for_each(|(index, (sums, &step))| {
            let values: Vec<&[f64]> = seen.iter().filter_map(|seen| seen.state(index)).collect();
            sums.add(&values);
            if let Some(companion) = self.companion {
                sums.compare(index, seen, companion);
            }
            let (mut flying, mut stayed) = (values.iter(), Vec::new());
            for seen in seen {
                let left = sums.leave(&seen.left, step);
                // Those that are lost before have no values.
                let values = seen.state(index).and_then(|_| flying.next());
                stayed.extend(values.copied().filter(|_| !left));
            }
            sums.stay(&stayed);
        });
    }

    pub(super) fn outcome(self, asked: u64, elapsed: Duration) -> Outcome {
        let dt = self.experiment.dt;
        let flown = self.members - self.not_flown;
        let snapshots = self.sums.into_iter().zip(&self.experiment.snapshots);
        Outcome {
            members: self.members,
            asked,
            snapshots: snapshots
                .map(|(sums, &step)| {
                    // Who is left of some that were lost is no sample of what the companion knows.
                    let is_known = sums.count == flown;
                    sums.snapshot(step as f64 * dt, is_known)
                })
                .collect(),
            lost: self.lost,
            not_flown: self.not_flown,
            losses: self.losses,
            digest: self
                .hash
                .finalize()
                .iter()
                .map(|byte| format!("{byte:02x}"))
                .collect(),
            member_steps: flown.saturating_mul(self.experiment.steps()),
            elapsed,
        }
    }
}

impl Sums {
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

    /// Members that have stayed in the first of the sets.
    fn stay(&mut self, members: &[&[f64]]) {
        if members.is_empty() {
            return;
        }
        for (state, moments) in self.stayed_moments.iter_mut().enumerate() {
            let values = members.iter().filter_map(|x| x.get(state).copied());
            moments.add(self.stayed as f64, &values.collect::<Vec<_>>());
        }
        self.stayed += members.len() as u64;
    }

    fn add(&mut self, members: &[&[f64]]) {
        // Members that are lost before leave nothing to begin with.
        let Some(first) = members.first() else {
            return;
        };
        if self.states.is_empty() {
            let columns = (0..first.len()).map(|state| -> Vec<f64> {
                let column = members.iter().filter_map(|x| x.get(state).copied());
                column.collect()
            });
            let columns: Vec<_> = columns.collect();
            self.states = columns.iter().map(|it| PowerSums::about(it)).collect();
            self.spreads = columns.into_iter().map(Spread::new).collect();
        } else {
            for x in members {
                for (spread, &value) in self.spreads.iter_mut().zip(*x) {
                    spread.add(value);
                }
            }
        }
        for x in members {
            let origins = x.iter().zip(&self.states);
            let deviation: Vec<f64> = origins.map(|(x, state)| x - state.origin).collect();
            self.count += 1;
            for ((state, row), &a) in self.states.iter_mut().zip(&mut self.second).zip(&deviation) {
                state.add(a);
                for (second, &b) in row.iter_mut().zip(&deviation) {
                    *second += a * b;
                }
            }
        }
    }

    /// Members at snapshot number `index`, beside their companions.
    fn compare(&mut self, index: usize, seen: &[MemberRecord], companion: &Companion) {
        let variances = companion.variances.get(index).map_or(&[][..], |it| it);
        for seen in seen {
            let pair = (
                seen.state(index),
                row(&seen.companion, variances.len(), index),
            );
            let (Some(x), Some(z)) = pair else { continue };
            let states = self.control.iter_mut().zip(&self.states).zip(variances);
            for (((control, state), variance), (x, z)) in states.zip(x.iter().zip(z)) {
                control.add((x - state.origin) / state.scale, z / variance.sqrt());
            }
        }
    }

    /// What is seen; whether the companions know of these members, where there are any.
    fn snapshot(mut self, time: f64, is_known: bool) -> Snapshot {
        if self.states.is_empty() {
            let states = self.second.len();
            self.states = vec![PowerSums::about(&[]); states];
            self.spreads = vec![Spread::new(Vec::new()); states];
        }
        let n = self.count as f64;
        let means: Vec<f64> = self.states.iter().map(|state| state.first / n).collect();
        let covariance: Vec<Vec<f64>> = self
            .second
            .iter()
            .zip(&means)
            .map(|(row, a)| {
                let entry = |(sum, b): (&f64, &f64)| (sum - n * a * b) / (n - 1.0);
                row.iter().zip(&means).map(entry).collect()
            })
            .collect();
        let states = self.states.iter().zip(&self.spreads).enumerate();
        let states = states.map(|(index, (sums, spread))| {
            let entry = |matrix: &[Vec<f64>]| {
                let row = matrix.get(index);
                row.and_then(|row| row.get(index).copied())
                    .unwrap_or(f64::NAN)
            };
            let std = deviation_of(entry(&covariance));
            let mean = sums.origin + sums.first / n;
            let kurtosis = sums.kurtosis(entry(&self.second), n);
            // One number has no spread.
            let stayed = self.stayed_moments.get(index).filter(|_| self.stayed > 1);
            let of_stayed = stayed.map(|it| (it.squares / (self.stayed - 1) as f64).sqrt());
            let control = self.control.get(index).filter(|_| is_known);
            let control = control.and_then(|it| it.estimates(sums.origin, sums.scale));
            let own = Some(Estimate::of_mean(mean, std, n));
            let own_std = Some(OpenEstimate::of_std(std, kurtosis, n));
            StateSpread {
                mean: control
                    .map(|it| it.mean)
                    .or(own.filter(|it| n > 1.0 && it.is_finite())),
                std: control
                    .map(|it| it.std)
                    .or(own_std.filter(|it| n > 1.0 && it.is_finite())),
                remains: control.map(|it| it.remains),
                std_of_stayed: of_stayed.filter(|std| std.is_finite()),
                quantiles: QUANTILES.map(|share| spread.quantile(share)),
                resolution: spread.resolution(),
                histogram: spread.histogram(HISTOGRAM_BINS),
            }
        });
        Snapshot {
            time,
            members: self.count,
            states: states.collect(),
            covariance,
            left: self.left,
            left_any: self.left_any,
            stayed: self.stayed,
        }
    }
}
