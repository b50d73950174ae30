//! Whole flights of some members.

#[cfg(feature = "parquet")]
mod parquet;

use std::path::Path;

use clap::ValueEnum;

use super::Summary;
use crate::csv_file::CsvFile;
use crate::failure::{Failure, complain};
use crate::labels::Labels;
use crate::number::{cell, time};
use ahv_analysis::monte_carlo::MonteCarloError;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Comma-separated values
    Csv,
    /// Apache Parquet
    #[cfg(feature = "parquet")]
    Parquet,
}

/// The flights, column by column.
struct Table {
    names: Vec<String>,
    members: Vec<i64>,
    columns: Vec<Vec<f64>>,
}

/// Looks whether there are the members that are asked for.
///
/// # Errors
///
/// [`Failure::Request`] if not, or if there is no place to write them to.
pub(super) fn check(arguments: &super::Arguments) -> Result<(), Failure> {
    let members = arguments.members;
    if let Some(member) = arguments.trajectories.iter().find(|it| **it >= members) {
        return Err(Failure::Request(format!(
            "--trajectories: there is no member {member}; they are 0 to {}",
            members - 1
        )));
    }
    if !arguments.trajectories.is_empty() && arguments.out.is_none() {
        return Err(Failure::Request(
            "--trajectories: they are written to the folder of --out, which is not given"
                .to_owned(),
        ));
    }
    Ok(())
}

/// Writes the flights that were asked for; none is no file.
pub(super) fn write(told: &Summary<'_>, folder: &Path) -> Result<(), Failure> {
    let chosen = &told.arguments.trajectories;
    if chosen.is_empty() {
        return Ok(());
    }
    let vehicle = &told.ready.vehicle;
    let labels = [vehicle.states, vehicle.inputs].into_iter();
    let labels = std::iter::once(("time", "s")).chain(labels.flat_map(Labels::iter));
    let names = labels.map(|(name, unit)| format!("{name} [{unit}]"));
    let names: Vec<String> = names.collect();
    let mut table = Table {
        members: Vec::new(),
        columns: vec![Vec::new(); names.len()],
        names,
    };
    let numeric = |error: MonteCarloError| Failure::Numeric(error.to_string());
    let engine = vehicle.model.engine(&told.ready.experiment);
    let engine = engine.map_err(numeric)?;
    // Of a part of the members, those that were flown.
    for &member in chosen
        .iter()
        .filter(|member| **member < told.outcome.members)
    {
        let points = engine.trajectory(member, 1).map_err(numeric)?;
        if points.is_empty() {
            complain(&format!(
                "note: member {member} did not fly, and has no trajectory"
            ));
        }
        for point in points {
            // Members are fewer than 10^9.
            table.members.push(member as i64);
            let values = std::iter::once(time(point.time))
                .chain(point.state)
                .chain(point.input);
            table
                .columns
                .iter_mut()
                .zip(values)
                .for_each(|(column, value)| column.push(value));
        }
    }
    match told.arguments.trajectory_format {
        Format::Csv => table.csv(&folder.join("trajectories.csv")),
        #[cfg(feature = "parquet")]
        Format::Parquet => table.parquet(&folder.join("trajectories.parquet")),
    }
}

impl Table {
    fn csv(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        let mut heading = vec!["member".to_owned()];
        heading.extend(self.names.iter().cloned());
        file.row(&heading)?;
        for (row, member) in self.members.iter().enumerate() {
            let values = self.columns.iter().filter_map(|column| column.get(row));
            let cells = std::iter::once(member.to_string());
            let cells: Vec<String> = cells.chain(values.map(|&value| cell(value))).collect();
            file.row(&cells)?;
        }
        file.finish()
    }
}
