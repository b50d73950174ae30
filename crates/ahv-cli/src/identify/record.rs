//! Flight records from CSV files.

use std::path::Path;

use ahv_identify::Record;

use crate::assignment::Assignments;
use crate::failure::Failure;
use crate::names;
use crate::show::RAD_PER_DEG;
use crate::table::text_of;
use crate::vehicle::Vehicle;

/// A column of the file: where, and what turns its numbers into the unit of the vehicle.
#[derive(Clone, Copy)]
struct Column {
    place: usize,
    factor: f64,
}

/// Where an input comes from.
enum Source {
    Column(Column),
    Held(f64),
}

/// The measured names of a record, and the record in the units of the vehicle. Inputs that the file lacks are as `held` has them.
///
/// # Errors
///
/// [`Failure::Request`] that names file, line and column.
pub(super) fn read(
    path: &Path,
    vehicle: &Vehicle,
    measured: &[String],
    held: &Assignments,
) -> Result<(Vec<&'static str>, Record), Failure> {
    let shown = names::printable(&path.display().to_string());
    let failed = |why: String| Failure::Request(format!("{shown}: {why}"));
    let text = text_of(path).map_err(|error| failed(format!("cannot be read: {error}")))?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader
        .headers()
        .map_err(|error| failed(error.to_string()))?;
    let header = Header(headers.iter().map(str::to_owned).collect());
    let time = header.find("time", "s").map_err(failed)?;
    let time = time.ok_or_else(|| failed("there is no column `time [s]`".to_owned()))?;
    let inputs = header.inputs(vehicle, held).map_err(failed)?;
    let outputs = header.outputs(vehicle, measured).map_err(failed)?;
    let mut record = Record {
        times: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
    };
    for row in reader.records() {
        let row = row.map_err(|error| failed(error.to_string()))?;
        let line = row.position().map_or(0, csv::Position::line);
        let number = |column: Column| header.number(&row, column, line).map_err(failed);
        let now = number(time)?;
        if let Some(before) = record.times.last().filter(|before| now <= **before) {
            return Err(failed(format!(
                "line {line}: the time is {now} s after {before} s; times must ascend, and a record is one flight"
            )));
        }
        record.times.push(now);
        let input = inputs.iter().map(|it| match it {
            Source::Column(column) => number(*column),
            Source::Held(value) => Ok(*value),
        });
        record.inputs.push(input.collect::<Result<_, _>>()?);
        let output = outputs.iter().map(|(_, column)| number(*column));
        record.outputs.push(output.collect::<Result<_, _>>()?);
    }
    match record.times.len() {
        0 | 1 => Err(failed("it has fewer than two samples".to_owned())),
        _ => Ok((outputs.into_iter().map(|it| it.0).collect(), record)),
    }
}

/// The first line.
struct Header(Vec<String>);

impl Header {
    /// The column of a quantity, whose header is its name with its unit in brackets.
    fn find(&self, name: &str, unit: &str) -> Result<Option<Column>, String> {
        let parts = |header: &str| {
            let (own, unit) = header.trim().split_once('[').unwrap_or((header, ""));
            (
                own.trim().to_owned(),
                unit.trim_end_matches(']').trim().to_owned(),
            )
        };
        let named = self
            .0
            .iter()
            .enumerate()
            .map(|(place, it)| (place, parts(it)));
        let mut found = named.filter(|(_, (own, _))| own == name);
        let Some((place, (_, written))) = found.next() else {
            return Ok(None);
        };
        if found.next().is_some() {
            return Err(format!("two columns are called {name}"));
        }
        let factor = match (written.as_str(), unit) {
            (written, unit) if written == unit => 1.0,
            ("deg", "rad") | ("deg/s", "rad/s") => RAD_PER_DEG,
            ("", unit) if !unit.starts_with("rad") => 1.0,
            ("", _) => {
                return Err(format!(
                    "column {name} is an angle and needs a unit: `{name} [{unit}]`"
                ));
            }
            (other, _) => {
                let other = names::printable(other);
                return Err(format!("column {name} is in {other}; it must be in {unit}"));
            }
        };
        Ok(Some(Column { place, factor }))
    }

    fn inputs(&self, vehicle: &Vehicle, held: &Assignments) -> Result<Vec<Source>, String> {
        let source = |(name, unit): (&'static str, &'static str)| match (
            self.find(name, unit)?,
            held.get(name),
        ) {
            (Some(_), Some(_)) => Err(format!("--input {name}: the record has a column of it")),
            (Some(column), None) => Ok(Source::Column(column)),
            (None, Some(value)) => Ok(Source::Held(value)),
            (None, None) if vehicle.idle(name).is_some() => Ok(Source::Held(0.0)),
            (None, None) => Err(format!(
                "there is no column `{name} [{unit}]` of the input {name}; add it, or hold the input by --input {name}=VALUE"
            )),
        };
        vehicle.inputs.iter().map(source).collect()
    }

    fn outputs(
        &self,
        vehicle: &Vehicle,
        measured: &[String],
    ) -> Result<Vec<(&'static str, Column)>, String> {
        let known = || vehicle.states.iter().chain(vehicle.outputs.iter());
        if let Some(name) = names::twice(measured) {
            return Err(format!("--measured: {name} is given twice"));
        }
        let mut outputs = Vec::new();
        if measured.is_empty() {
            for (name, unit) in known() {
                outputs.extend(self.find(name, unit)?.map(|column| (name, column)));
            }
        }
        for asked in measured {
            let all: Vec<&str> = known().map(|it| it.0).collect();
            let found = known().find(|it| it.0 == asked);
            let unknown = || {
                format!(
                    "--measured: {}",
                    names::unknown("state or output", asked, &all)
                )
            };
            let (name, unit) = found.ok_or_else(unknown)?;
            let column = self.find(name, unit)?;
            let missing = || format!("there is no column `{name} [{unit}]`");
            outputs.push((name, column.ok_or_else(missing)?));
        }
        if outputs.is_empty() {
            let names: Vec<&str> = vehicle.states.iter().map(|it| it.0).collect();
            let all = names::list(&names);
            return Err(format!("there is no column of a state or output: {all}"));
        }
        Ok(outputs)
    }

    fn number(&self, row: &csv::StringRecord, column: Column, line: u64) -> Result<f64, String> {
        let text = row.get(column.place).unwrap_or_default().trim();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value * column.factor),
            _ => {
                let name = names::printable(&self.0[column.place]);
                let text = names::printable(text);
                Err(format!(
                    "line {line}, column `{name}`: `{text}` is not a finite number"
                ))
            }
        }
    }
}
