//! What `ahv covariance` prints and writes.

use std::fmt::Write;
use std::path::Path;

use ahv_analysis::covariance::Spreading;
use ahv_analysis::monte_carlo::Snapshot;
use ahv_analysis::statistics::{Estimate, OpenEstimate, deviation_of};
use nalgebra::DMatrix;
use serde::Serialize;

use super::Outcome;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::number::{Shown, cell, time};
use crate::output::Pairs;
use crate::show::{interval, show};
use crate::signals::interrupted;
use crate::vehicle::{Heading, PointJson};

/// Of the times, every so many is printed.
const STRIDE: usize = 5;

#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    /// Where the flights start.
    #[serde(flatten)]
    point: PointJson,
    members: u64,
    /// Whether all members were flown.
    complete: bool,
    seed: u64,
    dt: f64,
    scheme: &'static str,
    feedback: bool,
    share_inside: Option<f64>,
    worst_ratio: Option<JsonRatio>,
    stationary_std: Option<Pairs<f64>>,
    stationary_covariance: Option<Vec<Vec<f64>>>,
    times: Vec<JsonTime>,
}

#[derive(Serialize)]
struct JsonTime {
    time: f64,
    members: u64,
    linear_std: Pairs<f64>,
    sampled_std: Pairs<Option<OpenEstimate>>,
    /// Linear over sampled standard deviation.
    ratio: Pairs<Option<Estimate>>,
    linear_covariance: Vec<Vec<f64>>,
    linear_mean: Pairs<f64>,
    sampled_mean: Pairs<Option<Estimate>>,
}

/// A ratio of linear to sampled standard deviation.
#[derive(Serialize)]
struct JsonRatio {
    state: &'static str,
    time: f64,
    #[serde(flatten)]
    ratio: Estimate,
}

/// Linear over sampled standard deviation with its interval of 95 %; `None` where nothing spreads, or the interval is open.
fn ratio(linear: f64, sampled: Option<OpenEstimate>) -> Option<Estimate> {
    let Estimate { value, low, high } = sampled?.closed()?;
    let ratio = Estimate {
        value: linear / value,
        low: linear / high,
        high: linear / low,
    };
    Some(ratio).filter(|ratio| ratio.low > 0.0 && ratio.is_finite())
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let row = |row: usize| matrix.row(row).iter().copied().collect();
    (0..matrix.nrows()).map(row).collect()
}

pub(super) fn stds(snapshot: &Snapshot) -> Vec<Option<OpenEstimate>> {
    snapshot.states.iter().map(|state| state.std).collect()
}

impl Outcome<'_> {
    pub(super) fn pairs(&self) -> impl Iterator<Item = (&Spreading, &Snapshot)> {
        self.linear.iter().zip(&self.sampled)
    }

    /// Ratios of linear to sampled standard deviation, over states and times.
    fn ratios(&self) -> impl Iterator<Item = JsonRatio> {
        let names = self.vehicle.states.names;
        self.pairs().flat_map(|(linear, sampled)| {
            let stds = linear.std().into_iter().zip(stds(sampled));
            let named = names.iter().zip(stds);
            let time = time(linear.time);
            named.filter_map(move |(&state, (linear, sampled))| {
                Some(JsonRatio {
                    state,
                    time,
                    ratio: ratio(linear, sampled)?,
                })
            })
        })
    }

    /// Share of the standard deviations, over states and times, that lie in the interval of the ensemble; what does not
    /// spread does not count, nor what has no interval with two ends.
    fn share_inside(&self) -> Option<f64> {
        let inside: Vec<bool> = self.ratios().map(|it| it.ratio.holds(1.0)).collect();
        let share = inside.iter().filter(|&&it| it).count() as f64 / inside.len() as f64;
        Some(share).filter(|share| share.is_finite())
    }

    /// The mark of a part of the flights.
    pub(super) fn mark(&self) -> String {
        interrupted(self.members, self.arguments.members, "flights")
    }

    pub(super) fn is_complete(&self) -> bool {
        self.members == self.arguments.members
    }

    /// How many flights the ensemble has.
    pub(super) fn flights(&self) -> String {
        if self.is_complete() {
            format!("{} flights", self.members)
        } else {
            format!(
                "{} of {} flights, for it was interrupted,",
                self.members, self.arguments.members
            )
        }
    }

    /// The ratio that is farthest from 1.
    fn worst(&self) -> Option<JsonRatio> {
        let distance = |it: &JsonRatio| it.ratio.value.ln().abs();
        self.ratios()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The stationary covariance, if it is asked for and there is one.
    fn stationary(&self) -> Option<&DMatrix<f64>> {
        self.stationary.as_ref()?.as_ref().ok()
    }

    fn stationary_std(&self) -> Option<Vec<f64>> {
        let variances = self.stationary()?.diagonal();
        Some(variances.iter().copied().map(deviation_of).collect())
    }

    pub(super) fn json(&self) -> Json<'_> {
        let states = self.vehicle.states;
        let at = |(linear, sampled): (&Spreading, &Snapshot)| {
            let ratios = linear.std().into_iter().zip(stds(sampled));
            let ratios = ratios.map(|(linear, std)| ratio(linear, std));
            JsonTime {
                time: time(linear.time),
                members: sampled.members,
                linear_std: states.pairs(linear.std()),
                sampled_std: states.pairs(stds(sampled)),
                ratio: states.pairs(ratios),
                linear_covariance: rows(&linear.covariance),
                linear_mean: states.pairs(linear.state.iter().copied()),
                sampled_mean: states.pairs(sampled.states.iter().map(|state| state.mean)),
            }
        };
        Json {
            heading: self.vehicle.heading(),
            point: self.vehicle.point(&self.start[0], &self.start[1]),
            members: self.members,
            complete: self.is_complete(),
            seed: self.arguments.seed,
            dt: self.arguments.dt,
            scheme: self.scheme.name(),
            feedback: self.arguments.feedback.is_given(),
            share_inside: self.share_inside(),
            worst_ratio: self.worst(),
            stationary_std: self.stationary_std().map(|std| states.pairs(std)),
            stationary_covariance: self.stationary().map(rows),
            times: self.pairs().map(at).collect(),
        }
    }

    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "{}: {}, {}\nstandard deviations to first order, and of {} ({}, seed {}) with intervals of 95 %, and the \
             ratio of the two",
            self.vehicle.name(),
            self.place,
            self.vehicle.described(),
            self.flights(),
            self.scheme.name(),
            self.arguments.seed
        );
        let states = self.vehicle.states;
        // Writing into a String cannot fail.
        for (index, (name, unit)) in states.iter().enumerate() {
            let shown = |value: f64| show(value, unit);
            for (linear, sampled) in self.pairs().skip(STRIDE - 1).step_by(STRIDE) {
                let (Some(std), Some(Some(flown))) = (
                    linear.std().get(index).copied(),
                    stds(sampled).get(index).copied(),
                ) else {
                    continue;
                };
                let _ = write!(
                    text,
                    "\n  {name:<12} at {:<5} s: {:<16} flown {}",
                    Shown(time(linear.time)),
                    shown(std),
                    interval(&flown, shown)
                );
                if let Some(ratio) = ratio(std, Some(flown)) {
                    let _ = write!(text, "  ratio {:.3}", Shown(ratio.value));
                }
            }
        }
        let stationary = self.stationary_std().into_iter().flatten();
        for ((name, unit), std) in states.iter().zip(stationary) {
            let _ = write!(text, "\n  {name:<12} stationary: {}", show(std, unit));
        }
        if let Some(worst) = self.worst() {
            let Estimate { value, low, high } = worst.ratio;
            let _ = write!(
                text,
                "\nlinear over flown standard deviation: farthest from 1 is {:.3} [{:.3}, {:.3}], {} at {} s",
                Shown(value),
                Shown(low),
                Shown(high),
                worst.state,
                Shown(worst.time)
            );
        }
        let lost = self.members - self.sampled.last().map_or(0, |it| it.members);
        let inside = self.share_inside().map_or_else(
            || "no standard deviation has an interval with two ends".to_owned(),
            |share| {
                let percent = Shown(100.0 * share);
                format!("{percent:.1} % of the standard deviations lie in their interval")
            },
        );
        let _ = write!(text, "\n{inside}; {lost} flights broke down");
        text
    }

    /// Writes the table.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(&folder.join("covariance.csv"))?;
        let columns = self.vehicle.states.iter().flat_map(|(name, unit)| {
            let kinds = [
                "linear_std",
                "sampled_std",
                "sampled_std_low",
                "sampled_std_high",
            ];
            let stds = kinds.map(|kind| format!("{name}_{kind} [{unit}]"));
            let ratios = ["", "_low", "_high"].map(|end| format!("{name}_ratio{end} [1]"));
            stds.into_iter().chain(ratios)
        });
        let first = ["time [s]", "members"].map(str::to_owned).into_iter();
        let last = ["complete".to_owned()];
        file.row(&first.chain(columns).chain(last).collect::<Vec<_>>())?;
        let cells = |it: OpenEstimate| {
            [it.value, it.low, it.high].map(|number| number.map_or_else(String::new, cell))
        };
        for (linear, sampled) in self.pairs() {
            let stds = linear.std().into_iter().zip(stds(sampled));
            let stds = stds.flat_map(|(std, flown)| {
                let ratio = cells(ratio(std, flown).into());
                let rest = cells(flown.unwrap_or_default()).into_iter().chain(ratio);
                std::iter::once(cell(std)).chain(rest)
            });
            let first = [cell(time(linear.time)), sampled.members.to_string()];
            let last = [self.is_complete().to_string()];
            file.row(
                &first
                    .into_iter()
                    .chain(stds)
                    .chain(last)
                    .collect::<Vec<_>>(),
            )?;
        }
        file.finish()
    }
}
