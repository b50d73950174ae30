//! What is told of the flights as JSON, and what is warned of.

use ahv_analysis::monte_carlo::{QUANTILES, Remains, Snapshot};
use ahv_analysis::statistics::{Estimate, OpenEstimate};
use serde::Serialize;

use super::Summary;
use super::causes::Cause;
use crate::flights::Settings;
use crate::number;
use crate::output::Pairs;
use crate::show::show;
use crate::vehicle::{Heading, PointJson};

/// How many times as large as that of the others a standard deviation is that a few members make.
const SWAMPED: f64 = 3.0;

/// The outcome as JSON. Means, standard deviations and quantiles are of the members that fly at the end.
#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    /// Where the flights start.
    #[serde(flatten)]
    point: PointJson,
    members: u64,
    asked: u64,
    complete: bool,
    lost: u64,
    /// Of the lost ones, those whose parameters break a rule.
    not_flown: u64,
    losses: Vec<JsonLoss>,
    member_steps: u64,
    member_steps_per_second: f64,
    seconds: f64,
    #[serde(flatten)]
    settings: Settings,
    mean: Pairs<Option<f64>>,
    std: Pairs<Option<f64>>,
    std_inside_validity_box: Pairs<Option<f64>>,
    digest: &'a str,
    left_validity_box: Estimate,
    /// With `--disperse`.
    #[serde(skip_serializing_if = "<[Cause]>::is_empty")]
    rank_correlations: &'a [Cause],
    snapshots: Vec<JsonSnapshot>,
}

#[derive(Serialize)]
struct JsonLoss {
    member: u64,
    time: f64,
    state: &'static str,
    rule: Option<&'static str>,
}

#[derive(Serialize)]
struct JsonSnapshot {
    time: f64,
    members: u64,
    mean: Pairs<Option<Estimate>>,
    std: Pairs<Option<OpenEstimate>>,
    /// With `--control-variate`: what remains of the variances of mean and standard deviation, where it could be used.
    #[serde(skip_serializing_if = "Option::is_none")]
    variance_that_remains: Option<Pairs<Option<Remains>>>,
    quantiles: Pairs<Vec<JsonQuantile>>,
    quantile_resolution: Pairs<f64>,
    covariance: Vec<Vec<Option<f64>>>,
    left_validity_box: Estimate,
    left_validity_box_by_state: Pairs<Estimate>,
    left_limits: Option<Estimate>,
    left_limits_by_state: Option<Pairs<Estimate>>,
}

#[derive(Clone, Serialize)]
struct JsonQuantile {
    share: f64,
    #[serde(flatten)]
    estimate: OpenEstimate,
}

impl Summary<'_> {
    pub(super) fn json(&self) -> Json<'_> {
        let (outcome, names) = (&self.outcome, self.ready.vehicle.states);
        let value = |estimate: &Option<Estimate>| estimate.map(|it| it.value);
        let last = || {
            self.outcome
                .snapshots
                .last()
                .into_iter()
                .flat_map(|it| &it.states)
        };
        Json {
            heading: self.ready.vehicle.heading(),
            point: self.ready.point(),
            members: outcome.members,
            asked: outcome.asked,
            complete: self.is_complete(),
            lost: outcome.lost,
            not_flown: outcome.not_flown,
            losses: outcome
                .losses
                .iter()
                .map(|(member, loss)| JsonLoss {
                    member: *member,
                    time: self.ready.time(loss.step),
                    state: loss.state,
                    rule: loss.rule,
                })
                .collect(),
            member_steps: outcome.member_steps,
            member_steps_per_second: self.rate(),
            seconds: outcome.elapsed.as_secs_f64(),
            settings: self.ready.settings(outcome.asked),
            mean: names.pairs(last().map(|it| value(&it.mean))),
            std: names.pairs(last().map(|it| it.std?.value)),
            std_inside_validity_box: names.pairs(last().map(|it| it.std_of_stayed)),
            digest: &outcome.digest,
            left_validity_box: self.left_any(outcome.snapshots.last(), 0),
            rank_correlations: &self.causes,
            snapshots: outcome
                .snapshots
                .iter()
                .map(|it| self.snapshot(it))
                .collect(),
        }
    }

    fn snapshot(&self, snapshot: &Snapshot) -> JsonSnapshot {
        let (names, states) = (self.ready.vehicle.states, || snapshot.states.iter());
        let finite = |value: &f64| Some(*value).filter(|value| value.is_finite());
        let quantiles = states().map(|it| {
            let shares = QUANTILES.iter().zip(&it.quantiles);
            let quantile = |(&share, &estimate)| JsonQuantile { share, estimate };
            shares.map(quantile).collect()
        });
        JsonSnapshot {
            time: number::time(snapshot.time),
            members: snapshot.members,
            mean: names.pairs(states().map(|it| it.mean)),
            std: names.pairs(states().map(|it| it.std)),
            variance_that_remains: self
                .arguments
                .control_variate
                .then(|| names.pairs(states().map(|it| it.remains))),
            quantiles: names.pairs(quantiles),
            quantile_resolution: names.pairs(states().map(|it| it.resolution)),
            covariance: snapshot
                .covariance
                .iter()
                .map(|row| row.iter().map(finite).collect())
                .collect(),
            left_validity_box: self.left_any(Some(snapshot), 0),
            left_validity_box_by_state: self.left(snapshot, 0),
            left_limits: self.has_limits().then(|| self.left_any(Some(snapshot), 1)),
            left_limits_by_state: self.has_limits().then(|| self.left(snapshot, 1)),
        }
    }

    pub(super) fn has_limits(&self) -> bool {
        self.ready.experiment.watched.len() > 1
    }

    /// Probability that a member has left any interval of a set by then.
    pub(super) fn left_any(&self, snapshot: Option<&Snapshot>, set: usize) -> Estimate {
        let count = snapshot.and_then(|it| it.left_any.get(set).copied());
        Estimate::of_share(count.unwrap_or(0), self.outcome.flown())
    }

    /// The same state by state.
    pub(super) fn left(&self, snapshot: &Snapshot, set: usize) -> Pairs<Estimate> {
        let counts = snapshot.left.get(set).into_iter().flatten();
        let shares = counts.map(|&it| Estimate::of_share(it, self.outcome.flown()));
        self.ready.vehicle.states.pairs(shares)
    }

    /// What to say of a few members that left the validity box and make most of a standard deviation, if they do.
    ///
    /// With one of a law like the normal one that cannot be: without less than half of its members it is a third at least.
    pub(super) fn warning(&self) -> Option<String> {
        let last = self.outcome.snapshots.last()?;
        if last.members == 0 {
            return Some(format!(
                "warning: no member is left at the end: all {} were lost, the first of them {}",
                self.outcome.members,
                self.outcome
                    .losses
                    .first()
                    .map_or_else(String::new, |(_, loss)| {
                        match loss.rule {
                            Some(rule) => format!("because {rule}"),
                            None => format!("when {} was no longer finite", loss.state),
                        }
                    })
            ));
        }
        let left = last.members - last.stayed;
        if 2 * left >= last.members {
            return None;
        }
        let states = self.ready.vehicle.states.iter().zip(&last.states);
        let swamped = states.filter_map(|((name, unit), state)| {
            let (all, stayed) = (state.std?.value?, state.std_of_stayed?);
            let less = format!(
                "{name} {} instead of {}",
                show(stayed, unit),
                show(all, unit)
            );
            (stayed > 0.0 && all > SWAMPED * stayed).then_some(less)
        });
        let swamped: Vec<String> = swamped.collect();
        (!swamped.is_empty()).then(|| {
            format!(
                "warning: {left} of {} members that fly at the end had left the validity box, and their values make most of the \
                 means and standard deviations; without them the standard deviations are: {}. Look at the quantiles \
                 instead",
                last.members,
                swamped.join(", ")
            )
        })
    }

    pub(super) fn rate(&self) -> f64 {
        self.outcome.member_steps as f64 / self.outcome.elapsed.as_secs_f64().max(1e-9)
    }
}
