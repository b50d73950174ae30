//! Means and standard deviations of members by the control variate: what the companions' sample happens to be off what is known
//! of them, the members' is off too (Lavenberg and Welch 1981).

use rayon::prelude::*;

use super::companion::Companion;
use super::experiment::{MemberRecord, row};
use super::outcome::Snapshot;
use super::sums::Reference;
use crate::statistics::{Estimate, OpenEstimate, student_95};

/// Members below which the sample's own estimates are told: of fewer, what remains of the variance is known too badly for an interval
/// (`docs/monte-carlo.md` has the coverage).
const FEWEST: f64 = 500.0;
/// What remains of a variance is at least this part of it: less is rounding.
const LEAST: f64 = 1e-12;

/// The sums of all states at all snapshots, beside what is known of the companions.
pub(super) struct Controls<'e> {
    companion: &'e Companion,
    /// By snapshot and state.
    sums: Vec<Vec<ControlSums>>,
}

impl<'e> Controls<'e> {
    /// Of no members so far.
    pub(super) fn new(companion: &'e Companion) -> Self {
        let zeros = |variances: &Vec<f64>| vec![ControlSums::default(); variances.len()];
        Self {
            companion,
            sums: companion.variances.iter().map(zeros).collect(),
        }
    }

    /// The members that come next.
    pub(super) fn add(&mut self, reference: &Reference, seen: &[MemberRecord]) {
        let snapshots = self.sums.par_iter_mut().zip(&self.companion.variances);
        snapshots
            .enumerate()
            .for_each(|(snapshot, (sums, variances))| {
                for seen in seen {
                    let companion = row(&seen.companion, variances.len(), snapshot);
                    let (Some(x), Some(z)) = (seen.state(snapshot), companion) else {
                        continue;
                    };
                    let pairs = sums.iter_mut().zip(variances).zip(x.iter().zip(z));
                    for (state, ((sums, variance), (x, z))) in pairs.enumerate() {
                        let about = reference.origin_and_unit(snapshot, state);
                        let [origin, unit] = about.unwrap_or([0.0, 1.0]);
                        sums.add((x - origin) / unit, z / variance.sqrt());
                    }
                }
            });
    }

    /// Puts its estimates in the place of the sample's own, where `flown` members all fly at the snapshot: who is left of some that
    /// were lost is no sample of what is known of the companions.
    pub(super) fn apply(&self, reference: &Reference, flown: u64, snapshots: &mut [Snapshot]) {
        for (index, (snapshot, sums)) in snapshots.iter_mut().zip(&self.sums).enumerate() {
            if snapshot.members != flown {
                continue;
            }
            for (state, (spread, sums)) in snapshot.states.iter_mut().zip(sums).enumerate() {
                let about = reference.origin_and_unit(index, state);
                let found = about.and_then(|[origin, unit]| sums.estimates(origin, unit));
                if let Some(Controlled { mean, std, remains }) = found {
                    (spread.mean, spread.std) = (Some(mean), Some(std));
                    spread.remains = Some(remains);
                }
            }
        }
    }
}

/// Sums over members of products of powers of the deviation of a state and of its companion's, each in a unit of its own.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ControlSums {
    count: f64,
    a: [f64; 4],
    b: [f64; 4],
    ab: f64,
    aab: f64,
    abb: f64,
    aabb: f64,
}

/// What the control variate makes of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Controlled {
    pub(super) mean: Estimate,
    pub(super) std: OpenEstimate,
    pub(super) remains: Remains,
}

/// What remains of the variances of two estimates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Remains {
    /// Of the mean.
    pub mean: f64,
    /// Of the standard deviation.
    pub std: f64,
}

impl ControlSums {
    /// One member more.
    pub(super) fn add(&mut self, a: f64, b: f64) {
        self.count += 1.0;
        let (aa, bb) = (a * a, b * b);
        for (sums, powers) in [
            (&mut self.a, [a, aa, aa * a, aa * aa]),
            (&mut self.b, [b, bb, bb * b, bb * bb]),
        ] {
            for (sum, power) in sums.iter_mut().zip(powers) {
                *sum += power;
            }
        }
        self.ab += a * b;
        self.aab += aa * b;
        self.abb += a * bb;
        self.aabb += aa * bb;
    }

    /// Estimates of a state whose deviation in `unit` from `origin` was added, where the companion has the mean 0 and, in its unit,
    /// the variance 1. `None` of too few members, and where numbers are too large.
    pub(super) fn estimates(&self, origin: f64, unit: f64) -> Option<Controlled> {
        let n = self.count;
        if n < FEWEST {
            return None;
        }
        let ([a, b], freedom) = ([self.a[0] / n, self.b[0] / n], n - 2.0);
        let scatter = |sums: &[f64; 4], mean: f64| sums[1] - n * mean * mean;
        let (aa, bb) = (scatter(&self.a, a), scatter(&self.b, b));
        // The mean.
        let ab = self.ab - n * a * b;
        let of_mean = Regression::new([aa, ab, bb]);
        let error = (of_mean.rest / freedom * (1.0 / n + b * b / bb)).sqrt();
        let (centre, half) = (a - of_mean.slope * b, student_95(freedom) * error);
        let in_unit = |value: f64| origin + unit * value;
        let mean = Estimate {
            value: in_unit(centre),
            low: in_unit(centre - half),
            high: in_unit(centre + half),
        };
        // The variance: of the squared deviations from the means.
        let fourth = |sums: &[f64; 4], mean: f64| {
            sums[3] - 4.0 * mean * sums[2] + 6.0 * mean * mean * sums[1] - 3.0 * n * mean.powi(4)
        };
        let mixed = self.aabb - 2.0 * (b * self.aab + a * self.abb)
            + b * b * self.a[1]
            + a * a * self.b[1]
            + 4.0 * a * b * self.ab
            - 3.0 * n * (a * b) * (a * b);
        let of_square = Regression::new([
            fourth(&self.a, a) - aa * aa / n,
            mixed - aa * bb / n,
            fourth(&self.b, b) - bb * bb / n,
        ]);
        let variance = aa / (n - 1.0) - of_square.slope * (bb / (n - 1.0) - 1.0);
        let error = (of_square.rest / freedom / n).sqrt();
        // Half, for the deviation is the root.
        let ratio = (0.5 * student_95(freedom) * error / variance).exp();
        let std = unit * variance.sqrt();
        let controlled = Controlled {
            mean,
            std: OpenEstimate {
                value: Some(std),
                low: Some(std / ratio),
                high: Some(std * ratio),
            },
            remains: Remains {
                mean: of_mean.remains,
                std: of_square.remains,
            },
        };
        let sound = mean.is_finite() && controlled.std.is_finite() && std > 0.0;
        Some(controlled).filter(|it| sound && it.remains.std.is_finite())
    }
}

/// The straight line through pairs of numbers.
struct Regression {
    slope: f64,
    /// Sum of the squares that it leaves.
    rest: f64,
    /// As a share of what there was.
    remains: f64,
}

impl Regression {
    /// From the sums of squares and products of deviations from the means.
    fn new([yy, xy, xx]: [f64; 3]) -> Self {
        let slope = xy / xx;
        let remains = (1.0 - slope * xy / yy).max(LEAST);
        Self {
            slope,
            rest: remains * yy,
            remains,
        }
    }
}
