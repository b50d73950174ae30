//! `ahv covariance`: how noise spreads the states of a flight, to first order and by flying.

mod figure;

use std::fmt::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use ahv_analysis::covariance::{CovarianceError, Flight, Spreading};
use ahv_analysis::monte_carlo::{
    Control, Dcom, Experiment, Flown, Mode, Scheme, Sdcom, SdcomGust, SdcomPrinted, Snapshot,
};
use ahv_analysis::statistics::Estimate;
use ahv_core::{StochasticModel, Vector};
use ahv_models::{dcom, sdcom, sdcom_gust, sdcom_printed};
use clap::Args;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use crate::assignment::show;
use crate::condition::{Condition, Heading, Vehicle};
use crate::csv_file::CsvFile;
use crate::failure::{Failure, print};
use crate::flights::feedback::FeedbackArguments;
use crate::flights::{Pair, deviations};
use crate::number::{Shown, cell, time};
use crate::output::{self, Pairs};
use crate::place::Place;
use crate::progress::{Progress, Work};
use crate::signals::{Stoppable, interrupted};
use crate::simulate::grid::positive;
use crate::vehicle::{FlightModel, ModelName};

/// Fewest members that have a standard deviation.
const FEWEST: u64 = 2;
/// Times at which the spread is told, in equal parts of the flight.
const SAMPLES: u32 = 20;
/// Of these, every so many is printed.
const STRIDE: usize = 5;

/// Propagates the covariance of the states along a flight from the trim, and flies the same many times.
///
/// To first order deviations have the covariance of P' = A P + P A' + G G', here by matrix exponentials; beside it stands the
/// spread of an ensemble (splitting of Strang, for dcom Heun, Ito) with intervals of 95 %, and the ratio of the two standard
/// deviations. Inputs are held, or follow a state feedback. In open loop the airframe is unstable, and the spread grows.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

    /// Standard deviations of the states at the start, e.g. altitude=50ft,gamma=0.2deg
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state_std: Vec<String>,

    /// Standard deviations of the inputs at the start, e.g. phi=0.01; without feedback they are held
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input_std: Vec<String>,

    #[command(flatten)]
    feedback: FeedbackArguments,

    /// Add the covariance at which the linear system comes to rest
    #[arg(long)]
    stationary: bool,

    /// End of the flight in s
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Longest step in s
    #[arg(long, value_name = "S", default_value_t = 0.002, value_parser = positive, allow_negative_numbers = true)]
    dt: f64,

    /// Flights of the ensemble
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(30..=1_000_000))]
    members: u64,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Folder for covariance.svg and covariance.csv
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim or the
/// flight diverges.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.condition.model {
        ModelName::Dcom => spread::<dcom::Model<f64>, Dcom>(arguments, Scheme::Heun),
        ModelName::Sdcom => spread::<sdcom::Model<f64>, Sdcom>(arguments, Scheme::Splitting),
        ModelName::SdcomPrinted => {
            spread::<sdcom_printed::Model<f64>, SdcomPrinted>(arguments, Scheme::Splitting)
        }
        ModelName::SdcomGust => {
            spread::<sdcom_gust::Model<f64>, SdcomGust>(arguments, Scheme::Splitting)
        }
        ModelName::Com | ModelName::ComRigid => Err(Failure::Request(
            "--model: com and com_rigid have no noise; dcom and the sdcom models have".to_owned(),
        )),
    }
}

/// What is printed: the spread to first order and of the ensemble, at the same times.
struct Outcome<'a, M: FlightModel> {
    vehicle: &'a Vehicle<M>,
    arguments: &'a Arguments,
    place: String,
    scheme: Scheme,
    linear: Vec<Spreading<M::State>>,
    /// Members that were flown.
    members: u64,
    sampled: Vec<Snapshot>,
    stationary: Option<DMatrix<f64>>,
}

fn spread<M, F>(arguments: &Arguments, scheme: Scheme) -> Result<(), Failure>
where
    M: Pair<F> + StochasticModel,
    F: Flown,
{
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let steady = arguments.place.flight(&vehicle)?;
    let trim = vehicle.trim(&steady)?;
    let part = arguments.t_end / f64::from(SAMPLES);
    let steps = (part / arguments.dt - 1e-9).ceil().max(1.0);
    let experiment = Experiment::<F> {
        parameters: vehicle.parameters,
        dispersion: None,
        state: [
            trim.state,
            deviations("--state-std", &arguments.state_std, &vehicle)?,
        ],
        input: [
            trim.input,
            deviations("--input-std", &arguments.input_std, &vehicle)?,
        ],
        feedback: arguments.feedback.read::<M, F>(&vehicle, &steady)?,
        watched: Vec::new(),
        scheme,
        mode: Mode::Exact,
        dt: part / steps,
        snapshots: (1..=u64::from(SAMPLES))
            .map(|index| index.saturating_mul(steps as u64))
            .collect(),
        seed: arguments.seed,
    };
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let progress = Progress::start(Work {
        command: "covariance",
        unit: "member-steps",
        total: Some(arguments.members.saturating_mul(experiment.steps())),
    });
    let [x_std, u_std] = [
        Pairs::of(&experiment.state[1]),
        Pairs::of(&experiment.input[1]),
    ];
    let variances = x_std.0.iter().chain(&u_std.0).map(|(_, std)| std * std);
    let flight = Flight {
        initial: DMatrix::from_diagonal(&DVector::from_vec(variances.collect())),
        feedback: experiment.feedback.as_ref().map(|it| it.regulation()),
        ..Flight::new(trim.state, trim.input, arguments.dt)
    };
    let failed = |error: CovarianceError| match error {
        CovarianceError::Times => Failure::Request(format!("--dt and --t-end: {error}")),
        _ => Failure::Numeric(format!("{}: {error}", M::NAME)),
    };
    // Not multiples of a part: 14 of 20 parts of 1 s are 0.7 s.
    let time = |index| arguments.t_end * f64::from(index) / f64::from(SAMPLES);
    let times: Vec<f64> = (1..=SAMPLES).map(time).collect();
    let linear = flight.covariance(&vehicle.model, &times).map_err(failed)?;
    let stationary = arguments
        .stationary
        .then(|| flight.stationary(&vehicle.model).map_err(failed))
        .transpose()?;
    let stoppable = Stoppable::new(progress.control());
    let sampled = sample::<M, F>(&experiment, arguments.members, progress.control());
    drop(stoppable);
    drop(progress);
    let (members, sampled) = sampled?;
    let outcome = Outcome {
        linear,
        stationary,
        members,
        sampled,
        place: vehicle.at(&steady),
        scheme,
        vehicle: &vehicle,
        arguments,
    };
    // Whatever fails, the rest is reported; the picture comes last.
    let written = folder.map_or(Ok(()), |folder| outcome.write(folder));
    let printed = if arguments.json {
        output::print_json(&outcome.json())
    } else {
        print(&outcome.text())
    };
    let drawn = folder.map_or(Ok(()), |folder| {
        output::picture(&folder.join("covariance.svg"), figure::draw(&outcome))
    });
    written.and(printed).and(drawn)?;
    if outcome.is_complete() {
        return Ok(());
    }
    Err(Failure::Interrupted(format!(
        "interrupted: {members} of {} flights were flown, and are reported",
        arguments.members
    )))
}

/// Flies the ensemble: how many members, and their snapshots.
fn sample<M: Pair<F>, F: Flown>(
    experiment: &Experiment<F>,
    members: u64,
    control: &Control,
) -> Result<(u64, Vec<Snapshot>), Failure> {
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let outcome = experiment
        .run(members, threads, control)
        .map_err(|error| Failure::Numeric(format!("{}: {error}", M::NAME)))?;
    if outcome.members < members.min(FEWEST) {
        return Err(Failure::Interrupted(format!(
            "interrupted before {FEWEST} flights ended"
        )));
    }
    match outcome.snapshots.iter().find(|it| it.members < FEWEST) {
        None => Ok((outcome.members, outcome.snapshots)),
        Some(Snapshot {
            time,
            members: left,
            ..
        }) => Err(Failure::Numeric(format!(
            "{}: at {time} s {left} of {} flights are left, too few for a standard deviation: the others are no longer \
             finite",
            M::NAME,
            outcome.members
        ))),
    }
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    units: Pairs<&'static str>,
    members: u64,
    /// Whether all members were flown.
    complete: bool,
    seed: u64,
    dt: f64,
    scheme: &'static str,
    feedback: bool,
    share_inside: f64,
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
    sampled_std: Pairs<Option<Estimate>>,
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

/// Linear over sampled standard deviation with its interval of 95 %; `None` where nothing spreads.
fn ratio(linear: f64, sampled: Option<Estimate>) -> Option<Estimate> {
    let Estimate { value, low, high } = sampled?;
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

fn stds(snapshot: &Snapshot) -> Vec<Option<Estimate>> {
    snapshot.states.iter().map(|state| state.std).collect()
}

/// Names of the states, each with its value.
fn named<X: Vector<f64>, V: Clone>(values: &[V]) -> Pairs<V> {
    Pairs(
        X::NAMES
            .iter()
            .copied()
            .zip(values.iter().cloned())
            .collect(),
    )
}

impl<M: FlightModel> Outcome<'_, M> {
    fn pairs(&self) -> impl Iterator<Item = (&Spreading<M::State>, &Snapshot)> {
        self.linear.iter().zip(&self.sampled)
    }

    /// Ratios of linear to sampled standard deviation, over states and times.
    fn ratios(&self) -> impl Iterator<Item = JsonRatio> {
        self.pairs().flat_map(|(linear, sampled)| {
            let stds = linear.std().into_iter().zip(stds(sampled));
            let named = M::State::NAMES.iter().zip(stds);
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
    /// spread does not count.
    fn share_inside(&self) -> f64 {
        let inside: Vec<bool> = self.ratios().map(|it| it.ratio.holds(1.0)).collect();
        inside.iter().filter(|&&it| it).count() as f64 / inside.len().max(1) as f64
    }

    /// The mark of a part of the flights.
    fn mark(&self) -> String {
        interrupted(self.members, self.arguments.members, "flights")
    }

    fn is_complete(&self) -> bool {
        self.members == self.arguments.members
    }

    /// How many flights the ensemble has.
    fn flights(&self) -> String {
        if self.is_complete() {
            format!("{} flights", self.members)
        } else {
            self.mark()
        }
    }

    /// The ratio that is farthest from 1.
    fn worst(&self) -> Option<JsonRatio> {
        let distance = |it: &JsonRatio| it.ratio.value.ln().abs();
        self.ratios()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    fn stationary_std(&self) -> Option<Vec<f64>> {
        let variances = self.stationary.as_ref()?.diagonal();
        Some(
            variances
                .iter()
                .map(|variance| variance.max(0.0).sqrt())
                .collect(),
        )
    }

    fn json(&self) -> Json<'_> {
        let at = |(linear, sampled): (&Spreading<M::State>, &Snapshot)| {
            let stds = stds(sampled);
            let ratios = linear.std().into_iter().zip(&stds);
            let ratios: Vec<_> = ratios.map(|(linear, &std)| ratio(linear, std)).collect();
            let means: Vec<_> = sampled.states.iter().map(|state| state.mean).collect();
            JsonTime {
                time: time(linear.time),
                members: sampled.members,
                linear_std: named::<M::State, _>(&linear.std()),
                sampled_std: named::<M::State, _>(&stds),
                ratio: named::<M::State, _>(&ratios),
                linear_covariance: rows(&linear.covariance),
                linear_mean: Pairs::of(&linear.state),
                sampled_mean: named::<M::State, _>(&means),
            }
        };
        let stationary = self.stationary_std();
        Json {
            heading: self.vehicle.heading(),
            units: Pairs::units::<M::State>(self.vehicle.units),
            members: self.members,
            complete: self.is_complete(),
            seed: self.arguments.seed,
            dt: self.arguments.dt,
            scheme: self.scheme.name(),
            feedback: self.arguments.feedback.is_given(),
            share_inside: self.share_inside(),
            worst_ratio: self.worst(),
            stationary_std: stationary.map(|std| named::<M::State, _>(&std)),
            stationary_covariance: self.stationary.as_ref().map(rows),
            times: self.pairs().map(at).collect(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!(
            "{}: {}, {}\nstandard deviations to first order, and of {} ({}, seed {}) with intervals of 95 %, and the \
             ratio of the two",
            M::NAME,
            self.place,
            self.vehicle.described(),
            self.flights(),
            self.scheme.name(),
            self.arguments.seed
        );
        let units = self.vehicle.units.labels::<M::State>();
        // Writing into a String cannot fail.
        for (index, (name, unit)) in M::State::NAMES.iter().zip(units).enumerate() {
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
                    "\n  {name:<12} at {:<5} s: {:<16} flown {} [{}, {}]",
                    Shown(time(linear.time)),
                    shown(std),
                    shown(flown.value),
                    shown(flown.low),
                    shown(flown.high)
                );
                if let Some(ratio) = ratio(std, Some(flown)) {
                    let _ = write!(text, "  ratio {:.3}", Shown(ratio.value));
                }
            }
        }
        for ((name, unit), std) in M::State::NAMES
            .iter()
            .zip(units)
            .zip(self.stationary_std().into_iter().flatten())
        {
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
        let _ = write!(
            text,
            "\n{:.1} % of the standard deviations lie in their interval; {lost} flights broke down",
            Shown(100.0 * self.share_inside())
        );
        text
    }

    /// Writes the table.
    fn write(&self, folder: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(&folder.join("covariance.csv"))?;
        let units = self.vehicle.units.labels::<M::State>();
        let columns = M::State::NAMES.iter().zip(units).flat_map(|(name, unit)| {
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
        let cells = |it: Option<Estimate>| {
            let numbers = [
                it.map(|it| it.value),
                it.map(|it| it.low),
                it.map(|it| it.high),
            ];
            numbers.map(|number| number.map_or_else(String::new, cell))
        };
        for (linear, sampled) in self.pairs() {
            let stds = linear.std().into_iter().zip(stds(sampled));
            let stds = stds.flat_map(|(std, flown)| {
                let rest = cells(flown).into_iter().chain(cells(ratio(std, flown)));
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
