//! Samples from files.

use std::fs::File;
use std::path::Path;

use ahv_table::Unit;

use super::plan::{Named, Plan};
use crate::failure::Failure;
use crate::names;

/// Samples by columns, in the units of the table.
pub(super) struct Columns {
    /// In the order of the plan's variables; all 0 for one that no fitted quantity depends on.
    pub(super) variables: Vec<Vec<f64>>,
    /// In the order of `quantities`.
    pub(super) responses: Vec<Vec<f64>>,
    /// Indices of the plan's quantities that there are samples of.
    pub(super) quantities: Vec<usize>,
    pub(super) weights: Option<Vec<f64>>,
    /// Where they are from.
    pub(super) origin: String,
    /// Intervals that were drawn from: name and ends.
    pub(super) drawn: Vec<(&'static str, (f64, f64))>,
}

/// A file's columns, by their headers.
pub(super) trait Store {
    /// Its headers.
    fn headers(&self) -> Vec<String>;

    /// Columns as numbers.
    ///
    /// # Errors
    ///
    /// Where there is something else, in words.
    fn read(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, String>;
}

/// Reads the samples that a plan needs; with `all`, all variables that its quantities may have.
///
/// # Errors
///
/// [`Failure::Request`] that names file, line and column.
pub(super) fn read(
    path: &Path,
    plan: &Plan,
    weight: Option<&str>,
    all: bool,
) -> Result<Columns, Failure> {
    let shown = names::printable(&path.display().to_string());
    let failed = |why: String| Failure::Request(format!("{shown}: {why}"));
    let mut store = open(path).map_err(failed)?;
    columns(&mut *store, plan, weight, all)
        .map(|it| Columns {
            origin: names::printable(
                &path
                    .file_name()
                    .map_or_else(String::new, |it| it.to_string_lossy().into_owned()),
            ),
            ..it
        })
        .map_err(failed)
}

fn open(path: &Path) -> Result<Box<dyn Store>, String> {
    let kind = std::fs::metadata(path).map_err(|error| format!("cannot be read: {error}"))?;
    if !kind.is_file() {
        return Err("is not a regular file".to_owned());
    }
    let file = File::open(path).map_err(|error| format!("cannot be read: {error}"))?;
    match path.extension().and_then(|it| it.to_str()) {
        Some("parquet") => super::parquet::open(file),
        _ => Ok(Box::new(Csv::open(file)?)),
    }
}

fn columns(
    store: &mut dyn Store,
    plan: &Plan,
    weight: Option<&str>,
    all: bool,
) -> Result<Columns, String> {
    let headers = store.headers();
    let parsed: Vec<(&str, Option<&str>)> = headers.iter().map(|it| header(it)).collect();
    let named: Vec<&str> = parsed.iter().map(|it| it.0).collect();
    if let Some(twice) = names::twice(&named) {
        return Err(format!(
            "two columns are called `{}`",
            names::printable(twice)
        ));
    }
    let place = |name: &str| named.iter().position(|it| *it == name);
    let of = plan.quantities.iter().enumerate();
    let quantities: Vec<usize> = of
        .filter(|(_, it)| place(it.fit.section).is_some())
        .map(|(index, _)| index)
        .collect();
    if quantities.is_empty() {
        let wanted: Vec<&str> = plan.quantities.iter().map(|it| it.fit.section).collect();
        return Err(format!(
            "has a column for none of the table's quantities: {}",
            wanted.join(", ")
        ));
    }
    // What is read: its column and the factor of its unit.
    let mut wanted: Vec<(usize, f64)> = Vec::new();
    let mut used: Vec<usize> = quantities
        .iter()
        .flat_map(|&it| plan.used(&plan.quantities[it], all))
        .collect();
    used.sort_unstable();
    used.dedup();
    for &variable in &used {
        let Named { name, unit, .. } = &plan.variables[variable];
        let missing = || {
            let angle = if unit == "rad" {
                format!(" or `{name} [deg]`")
            } else {
                String::new()
            };
            format!(
                "the column `{name} [{unit}]`{angle} is missing; there are {}",
                named.join(", ")
            )
        };
        let at = place(name).ok_or_else(missing)?;
        wanted.push((at, factor(&headers[at], parsed[at].1, unit)?));
    }
    for &quantity in &quantities {
        let quantity = &plan.quantities[quantity];
        let at = place(quantity.fit.section).unwrap_or_default();
        wanted.push((at, factor(&headers[at], parsed[at].1, &quantity.unit)?));
    }
    if let Some(name) = weight {
        let at = place(name).ok_or_else(|| names::unknown("column of weights", name, &named))?;
        wanted.push((at, 1.0));
    }
    let places: Vec<usize> = wanted.iter().map(|it| it.0).collect();
    let mut read = store.read(&places)?;
    for ((place, factor), column) in wanted.iter().zip(&mut read) {
        column.iter_mut().for_each(|it| *it *= factor);
        if let Some(row) = column.iter().position(|it| !it.is_finite()) {
            let header = names::printable(&headers[*place]);
            return Err(format!(
                "sample {}, column `{header}`: not a finite number",
                row + 1
            ));
        }
    }
    let rows = read.first().map_or(0, Vec::len);
    let weights = weight.and_then(|_| read.pop());
    if let Some(row) = weights.iter().flatten().position(|it| *it < 0.0) {
        return Err(format!("sample {}: a weight is not negative", row + 1));
    }
    let responses = read.split_off(used.len());
    let mut variables = vec![vec![0.0; rows]; plan.variables.len()];
    for (variable, column) in used.into_iter().zip(read) {
        variables[variable] = column;
    }
    Ok(Columns {
        variables,
        responses,
        quantities,
        weights,
        origin: String::new(),
        drawn: Vec::new(),
    })
}

/// The name and the unit of a header such as `alpha [deg]`.
fn header(text: &str) -> (&str, Option<&str>) {
    let text = text.trim();
    match text.strip_suffix(']').and_then(|it| it.split_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (text, None),
    }
}

/// What turns a column into the unit that is `expected`.
fn factor(header: &str, unit: Option<&str>, expected: &str) -> Result<f64, String> {
    let header = names::printable(header);
    let Some(unit) = unit else {
        return match expected {
            "1" => Ok(1.0),
            _ => Err(format!(
                "the column `{header}` has no unit; write it like `{header} [{expected}]`"
            )),
        };
    };
    let known = Unit::parse(unit).zip(Unit::parse(expected));
    let factor = known.and_then(|(unit, expected)| unit.in_terms_of(&expected));
    factor.ok_or_else(|| {
        format!("the unit of the column `{header}` does not fit; it is `{expected}` here")
    })
}

/// A CSV file with a line of headers.
struct Csv {
    reader: csv::Reader<File>,
    headers: Vec<String>,
}

impl Csv {
    fn open(file: File) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .buffer_capacity(1 << 16)
            .from_reader(file);
        let headers = reader
            .headers()
            .map_err(|error| format!("is no CSV: {error}"))?;
        let headers = headers.iter().map(str::to_owned).collect();
        Ok(Self { reader, headers })
    }
}

impl Store for Csv {
    fn headers(&self) -> Vec<String> {
        self.headers.clone()
    }

    fn read(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, String> {
        let mut columns = vec![Vec::new(); wanted.len()];
        let mut record = csv::StringRecord::new();
        loop {
            let more = self.reader.read_record(&mut record);
            if !more.map_err(|error| format!("is no CSV: {error}"))? {
                return Ok(columns);
            }
            for (column, &place) in columns.iter_mut().zip(wanted) {
                let cell = record.get(place).unwrap_or_default().trim();
                let number = cell.parse::<f64>().ok().filter(|it| it.is_finite());
                column.push(number.ok_or_else(|| {
                    let line = record.position().map_or(0, csv::Position::line);
                    let header = names::printable(&self.headers[place]);
                    let cell = names::printable(&cell.chars().take(40).collect::<String>());
                    format!("line {line}, column `{header}`: `{cell}` is not a finite number")
                })?);
            }
        }
    }
}
