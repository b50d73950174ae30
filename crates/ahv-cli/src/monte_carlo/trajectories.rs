//! Whole flights of some members.

use std::path::Path;
use std::sync::Arc;

use ahv_core::{GeneratedModel, Vector};
use clap::ValueEnum;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::Told;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::number::{cell, time};
use crate::output::Output;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Comma-separated values
    Csv,
    /// Apache Parquet
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
pub(super) fn write<M: GeneratedModel>(told: &Told<'_, M>, folder: &Path) -> Result<(), Failure> {
    let chosen = &told.arguments.trajectories;
    if chosen.is_empty() {
        return Ok(());
    }
    let units = told.ready.vehicle.units;
    let labels = |names: &[&str], units: &[&str]| -> Vec<String> {
        let named = names.iter().zip(units);
        named
            .map(|(name, unit)| format!("{name} [{unit}]"))
            .collect()
    };
    let mut table = Table {
        names: [
            vec!["time [s]".to_owned()],
            labels(M::State::NAMES, units.labels::<M::State>()),
            labels(M::Input::NAMES, units.labels::<M::Input>()),
        ]
        .concat(),
        members: Vec::new(),
        columns: Vec::new(),
    };
    table.columns = vec![Vec::new(); table.names.len()];
    // Of a part of the members, those that were flown.
    for &member in chosen
        .iter()
        .filter(|member| **member < told.outcome.members)
    {
        let flight = told.ready.experiment.trajectory(member, 1);
        let flight = flight.map_err(|error| Failure::Numeric(error.to_string()))?;
        for point in flight {
            // Members are fewer than 10^9.
            table.members.push(member as i64);
            let states = (0..M::State::LEN).filter_map(|index| point.state.get(index));
            let inputs = (0..M::Input::LEN).filter_map(|index| point.input.get(index));
            let values = std::iter::once(time(point.time))
                .chain(states)
                .chain(inputs);
            table
                .columns
                .iter_mut()
                .zip(values)
                .for_each(|(column, value)| column.push(value));
        }
    }
    match told.arguments.trajectory_format {
        Format::Csv => table.csv(&folder.join("trajectories.csv")),
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

    fn parquet(&self, path: &Path) -> Result<(), Failure> {
        let mut output = Output::create(path)?;
        self.parquet_to(&mut output).map_err(|error| {
            Failure::Request(format!("cannot write {}: {error}", path.display()))
        })?;
        output.finish()
    }

    fn parquet_to(&self, output: &mut Output) -> parquet::errors::Result<()> {
        let field = |name: &str, physical| {
            Type::primitive_type_builder(name, physical)
                .with_repetition(Repetition::REQUIRED)
                .build()
                .map(Arc::new)
        };
        let mut fields = vec![field("member", Physical::INT64)?];
        for name in &self.names {
            fields.push(field(name, Physical::DOUBLE)?);
        }
        let schema = Type::group_type_builder("trajectories")
            .with_fields(fields)
            .build()?;
        let properties = WriterProperties::builder()
            .set_created_by("ahv".to_owned())
            .build();
        let mut writer = SerializedFileWriter::new(output, Arc::new(schema), Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        if let Some(mut column) = group.next_column()? {
            column
                .typed::<Int64Type>()
                .write_batch(&self.members, None, None)?;
            column.close()?;
        }
        for values in &self.columns {
            if let Some(mut column) = group.next_column()? {
                column
                    .typed::<DoubleType>()
                    .write_batch(values, None, None)?;
                column.close()?;
            }
        }
        group.close()?;
        writer.close()?;
        Ok(())
    }
}
