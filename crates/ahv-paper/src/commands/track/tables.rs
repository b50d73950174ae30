//! Statistics and flights as CSV.

use std::path::Path;

use ahv_cli::csv_file::CsvFile;
use ahv_cli::failure::Failure;
use ahv_cli::number::{cell, time};
use ahv_models::dcom::{Input, State};

use super::Outcome;
use crate::track::Flight;

/// Headings of the statistics.
const STATISTICS: [&str; 12] = [
    "controller",
    "figure",
    "unit",
    "mean",
    "mean_low",
    "mean_high",
    "median",
    "p05",
    "p95",
    "least",
    "largest",
    "complete",
];

/// A row for each figure of each controller; of shares of flights only value and interval. The last column is whether all
/// flights were flown.
pub(super) fn statistics(path: &Path, outcomes: &[Outcome], complete: bool) -> Result<(), Failure> {
    let mut file = CsvFile::create(path)?;
    file.row(&STATISTICS)?;
    for Outcome {
        controller,
        statistics,
        ..
    } in outcomes
    {
        let mut row = |name: &str, unit: &str, numbers: &[Option<f64>]| {
            let texts = [*controller, name, unit].map(str::to_owned).into_iter();
            let cells = numbers.iter().map(|it| it.map_or_else(String::new, cell));
            let last = [complete.to_string()];
            file.row(&texts.chain(cells).chain(last).collect::<Vec<_>>())
        };
        for (name, count) in [
            ("lost", &statistics.lost),
            ("left_validity_box", &statistics.left_validity_box),
        ] {
            let share = &count.share;
            let interval = [share.value, share.low, share.high].map(Some);
            row(name, "1", &[&interval[..], &[None; 5]].concat())?;
        }
        for figure in &statistics.figures {
            let (mean, spread) = (&figure.mean, &figure.spread);
            let numbers = [
                mean.value,
                mean.low,
                mean.high,
                spread.value,
                spread.low,
                spread.high,
                figure.least,
                figure.largest,
            ];
            row(figure.name, figure.unit, &numbers.map(Some))?;
        }
    }
    file.finish()
}

/// State, input and commands of a flight over time.
pub(super) fn flight(path: &Path, flight: &Flight) -> Result<(), Failure> {
    let mut file = CsvFile::create(path)?;
    let units = State::<f64>::UNITS.into_iter().chain(Input::<f64>::UNITS);
    let names = State::<f64>::NAMES.into_iter().chain(Input::<f64>::NAMES);
    let columns = names
        .zip(units)
        .map(|(name, unit)| format!("{name} [{unit}]"));
    let commands = [
        "velocity_command [ft/s]",
        "altitude_command [ft]",
        "gamma_command [rad]",
    ];
    let first = ["time [s]".to_owned()].into_iter();
    let heading = first.chain(columns).chain(commands.map(str::to_owned));
    file.row(&heading.collect::<Vec<_>>())?;
    for sample in &flight.samples {
        let command = &sample.reference;
        let commands = [command.velocity, command.altitude, command.gamma()];
        let numbers = [time(sample.time)]
            .into_iter()
            .chain(sample.state.to_array())
            .chain(sample.input.to_array())
            .chain(commands);
        file.row(&numbers.map(cell).collect::<Vec<_>>())?;
    }
    file.finish()
}
