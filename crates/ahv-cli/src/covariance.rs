//! `ahv covariance`: how noise spreads the states of a flight, to first order and by flying.

mod figure;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ahv_analysis::covariance::{CovarianceError, Ensemble, Flight, Sampled, Spreading};
use ahv_analysis::statistics::Estimate;
use ahv_core::{ItoCorrected, Vector};
use ahv_models::{dcom, sdcom, sdcom_gust, sdcom_printed};
use clap::Args;
use serde::Serialize;

use crate::assignment::show;
use crate::condition::{Condition, Heading, Vehicle};
use crate::csv_file::CsvFile;
use crate::failure::{Failure, print};
use crate::number::{Shown, cell, time};
use crate::output::{self, Pairs};
use crate::place::Place;
use crate::progress::{Progress, Work};
use crate::simulate::grid::positive;
use crate::vehicle::{FlightModel, ModelName};

/// Times at which the spread is told, in equal parts of the flight.
const SAMPLES: u32 = 20;
/// Of these, every so many is printed.
const STRIDE: usize = 5;

/// Propagates the covariance of the states along level flight, and flies the same many times.
///
/// The flight starts at the trim, known exactly, and holds its inputs. To first order deviations have the covariance of
/// P' = A P + P A' + G G'; beside it stands the spread of an ensemble (Heun, Ito) with intervals of 95 %. The airframe is
/// unstable: the spread grows, and what is first order about it holds for a second or two.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

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
        ModelName::Dcom => spread::<dcom::Model<f64>, { dcom::Noise::<()>::LEN }>(arguments),
        ModelName::Sdcom => spread::<sdcom::Model<f64>, { sdcom::Noise::<()>::LEN }>(arguments),
        ModelName::SdcomPrinted => {
            spread::<sdcom_printed::Model<f64>, { sdcom_printed::Noise::<()>::LEN }>(arguments)
        }
        ModelName::SdcomGust => {
            spread::<sdcom_gust::Model<f64>, { sdcom_gust::Noise::<()>::LEN }>(arguments)
        }
        ModelName::Com | ModelName::ComRigid => Err(Failure::Request(
            "--model: com and com_rigid have no noise; dcom and the sdcom models have".to_owned(),
        )),
    }
}

/// What is told: the spread to first order and of the ensemble, at the same times.
struct Outcome<'a, M: FlightModel> {
    vehicle: &'a Vehicle<M>,
    arguments: &'a Arguments,
    place: String,
    linear: Vec<Spreading<M::State>>,
    sampled: Vec<Sampled>,
}

fn spread<M, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    M: FlightModel + ItoCorrected + Sync,
    M::State: Send + Sync,
    M::Input: Sync,
{
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let steady = arguments.place.flight(&vehicle)?;
    let trim = vehicle.trim(&steady)?;
    let flight = Flight {
        start: trim.state,
        input: trim.input,
        dt: arguments.dt,
    };
    let part = arguments.t_end / f64::from(SAMPLES);
    let times: Vec<f64> = (1..=SAMPLES).map(|index| part * f64::from(index)).collect();
    let ensemble = Ensemble {
        members: arguments.members,
        seed: arguments.seed,
    };
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let progress = Progress::start(Work {
        command: "covariance",
        unit: "",
        total: None,
    });
    let failed = |error: CovarianceError| match error {
        CovarianceError::Times => Failure::Request(format!("--dt and --t-end: {error}")),
        _ => Failure::Numeric(format!("{}: {error}", M::NAME)),
    };
    let outcome = Outcome {
        linear: flight.covariance(&vehicle.model, &times).map_err(failed)?,
        sampled: flight
            .monte_carlo::<M, N>(&vehicle.model, &times, ensemble)
            .map_err(failed)?,
        place: vehicle.at(&steady),
        vehicle: &vehicle,
        arguments,
    };
    drop(progress);
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
    written.and(printed).and(drawn)
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    units: Pairs<&'static str>,
    members: u64,
    seed: u64,
    dt: f64,
    share_inside: f64,
    times: Vec<JsonTime>,
}

#[derive(Serialize)]
struct JsonTime {
    time: f64,
    members: u64,
    linear_std: Pairs<f64>,
    sampled_std: Pairs<Estimate>,
    linear_mean: Pairs<f64>,
    sampled_mean: Pairs<Estimate>,
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
    fn pairs(&self) -> impl Iterator<Item = (&Spreading<M::State>, &Sampled)> {
        self.linear.iter().zip(&self.sampled)
    }

    /// Share of the standard deviations, over states and times, that lie in the interval of the ensemble.
    fn share_inside(&self) -> f64 {
        let inside: Vec<bool> = self
            .pairs()
            .flat_map(|(linear, sampled)| linear.std().into_iter().zip(&sampled.std))
            // What does not move, does not in the ensemble either.
            .filter(|(linear, sampled)| *linear > 0.0 || sampled.value > 0.0)
            .map(|(linear, sampled)| sampled.holds(linear))
            .collect();
        inside.iter().filter(|&&it| it).count() as f64 / inside.len().max(1) as f64
    }

    fn json(&self) -> Json<'_> {
        let time = |(linear, sampled): (&Spreading<M::State>, &Sampled)| JsonTime {
            time: time(linear.time),
            members: sampled.members,
            linear_std: named::<M::State, _>(&linear.std()),
            sampled_std: named::<M::State, _>(&sampled.std),
            linear_mean: Pairs::of(&linear.state),
            sampled_mean: named::<M::State, _>(&sampled.mean),
        };
        Json {
            heading: self.vehicle.heading(),
            units: Pairs::units::<M::State>(self.vehicle.units),
            members: self.arguments.members,
            seed: self.arguments.seed,
            dt: self.arguments.dt,
            share_inside: self.share_inside(),
            times: self.pairs().map(time).collect(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!(
            "{}: {}, {}\nstandard deviations to first order, and of {} flights, seed {}, with intervals of 95 %",
            M::NAME,
            self.place,
            self.vehicle.described(),
            self.arguments.members,
            self.arguments.seed
        );
        let units = self.vehicle.units.labels::<M::State>();
        for (index, (name, unit)) in M::State::NAMES.iter().zip(units).enumerate() {
            let shown = |value: f64| show(value, unit);
            for (linear, sampled) in self.pairs().skip(STRIDE - 1).step_by(STRIDE) {
                let (Some(std), Some(flown)) = (
                    linear.std().get(index).copied(),
                    sampled.std.get(index).copied(),
                ) else {
                    continue;
                };
                // Writing into a String cannot fail.
                let _ = write!(
                    text,
                    "\n  {name:<12} at {:<5} s: {:<16} flown {} [{}, {}]",
                    Shown(time(linear.time)),
                    shown(std),
                    shown(flown.value),
                    shown(flown.low),
                    shown(flown.high)
                );
            }
        }
        let lost = self.arguments.members - self.sampled.last().map_or(0, |it| it.members);
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
            kinds.map(|kind| format!("{name}_{kind} [{unit}]"))
        });
        let first = ["time [s]", "members"].map(str::to_owned).into_iter();
        file.row(&first.chain(columns).collect::<Vec<_>>())?;
        for (linear, sampled) in self.pairs() {
            let stds = linear.std().into_iter().zip(&sampled.std);
            let stds = stds.flat_map(|(std, flown)| [std, flown.value, flown.low, flown.high]);
            let first = [time(linear.time), sampled.members as f64].into_iter();
            file.row(&first.chain(stds).map(cell).collect::<Vec<_>>())?;
        }
        file.finish()
    }
}
