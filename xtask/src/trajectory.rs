//! What `ahv simulate` writes: a CSV file whose headers carry units.

use std::path::Path;

/// A flight, column by column. The first column is time.
pub(crate) struct Trajectory {
    columns: Vec<Column>,
}

struct Column {
    name: String,
    unit: String,
    values: Vec<f64>,
}

impl Trajectory {
    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        let place = path.display();
        let problem = |error: csv::Error| format!("error: cannot read {place}: {error}");
        let mut reader = csv::Reader::from_path(path).map_err(problem)?;
        let headers = reader.headers().map_err(problem)?;
        let mut columns: Vec<Column> = headers.iter().map(column).collect();
        for record in reader.records() {
            for (column, field) in columns.iter_mut().zip(&record.map_err(problem)?) {
                let value = field.trim().parse();
                let value =
                    value.map_err(|_| format!("error: {place}: {field:?} is not a number"))?;
                column.values.push(value);
            }
        }
        Ok(Self { columns })
    }

    /// The state in the first row, as `--initial` takes it.
    pub(crate) fn start(&self) -> String {
        let states = self.columns.iter().skip(1);
        let first = |column: &Column| {
            let value = *column.values.first()?;
            Some(setting(&column.name, value, &column.unit))
        };
        states.filter_map(first).collect::<Vec<_>>().join(",")
    }

    /// A column's value in the last row.
    pub(crate) fn end(&self, name: &str) -> Option<f64> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        column.values.last().copied()
    }

    /// Unit and points over time of a column.
    pub(crate) fn series(&self, name: &str) -> Option<(&str, Vec<(f64, f64)>)> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        let time = &self.columns.first()?.values;
        let points = time
            .iter()
            .copied()
            .zip(column.values.iter().copied())
            .collect();
        Some((&column.unit, points))
    }
}

/// Splits `alpha [rad]`.
fn column(header: &str) -> Column {
    let (name, unit) = header.split_once('[').unwrap_or((header, ""));
    Column {
        name: name.trim().to_owned(),
        unit: unit.trim_end_matches(']').to_owned(),
        values: Vec::new(),
    }
}

/// `name=value` for the command line: angles need their unit, other quantities have but one.
pub(crate) fn setting(name: &str, value: f64, unit: &str) -> String {
    let unit = if unit.starts_with("rad") { unit } else { "" };
    format!("{name}={value:?}{unit}")
}
