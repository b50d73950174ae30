//! CSV files: all of one or none.

use std::io::{self, BufRead as _, BufReader, BufWriter, Write as _};
use std::path::Path;

use serde::Serialize;

use crate::failure::Failure;
use crate::output::{Output, cannot_write, plain};

/// A CSV file that takes its place only when complete.
pub struct CsvFile {
    writer: csv::Writer<Output>,
}

impl CsvFile {
    /// Starts the file that will be `path`.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if no file can be made there.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        Ok(Self::of(Output::create(path)?))
    }

    fn of(output: Output) -> Self {
        let mut builder = csv::WriterBuilder::new();
        let writer = builder.buffer_capacity(1 << 16).from_writer(output);
        Self { writer }
    }

    /// Writes a row of numbers; each reads back as the same bits, and one that is not finite is an empty cell.
    ///
    /// # Errors
    ///
    /// As [`Self::row`].
    pub fn numbers(&mut self, values: &[f64]) -> Result<(), Failure> {
        let finite = values
            .iter()
            .map(|value| value.is_finite().then_some(*value));
        self.row(&finite.collect::<Vec<_>>())
    }

    /// Writes a row of texts.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the file cannot be written.
    pub fn row<T: Serialize>(&mut self, values: &[T]) -> Result<(), Failure> {
        self.writer.serialize(values).map_err(|error| {
            let why = match error.into_kind() {
                csv::ErrorKind::Io(error) => plain(&error),
                other => format!("{other:?}"),
            };
            cannot_write(self.writer.get_ref().path(), &why)
        })
    }

    /// Writes what there is anew, each line as `changed` has it. Only for files whose cells hold no line ends.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the file cannot be read or written.
    pub(crate) fn rewritten(mut self, changed: impl Fn(&str) -> String) -> Result<Self, Failure> {
        let path = self.writer.get_ref().path().to_owned();
        let failed = |error: io::Error| cannot_write(&path, &plain(&error));
        self.writer.flush().map_err(failed)?;
        let written = self.writer.get_ref().reader().map_err(failed)?;
        let mut anew = Output::create(&path)?;
        {
            let mut buffer = BufWriter::new(&mut anew);
            for line in BufReader::new(written).lines() {
                let line = line.map_err(failed)?;
                writeln!(buffer, "{}", changed(&line)).map_err(failed)?;
            }
            buffer.flush().map_err(failed)?;
        }
        Ok(Self::of(anew))
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if that fails; what was there stays.
    pub fn finish(mut self) -> Result<(), Failure> {
        if let Err(error) = self.writer.flush() {
            return Err(cannot_write(self.writer.get_ref().path(), &plain(&error)));
        }
        // Nothing is left to be written here.
        let output = self.writer.into_inner();
        output
            .map_err(|error| Failure::Request(error.to_string()))?
            .finish()
    }
}
