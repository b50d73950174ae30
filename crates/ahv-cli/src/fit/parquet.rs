//! Samples from Apache Parquet.

use std::fs::File;

use super::samples::Store;

/// Opens a Parquet file.
///
/// # Errors
///
/// Why it cannot be read, in words.
#[cfg(not(feature = "parquet"))]
pub(super) fn open(_: File) -> Result<Box<dyn Store>, String> {
    Err("this program was built without Parquet; build it with `--features parquet`, or give samples as CSV".to_owned())
}

/// Opens a Parquet file.
///
/// # Errors
///
/// Why it cannot be read, in words.
#[cfg(feature = "parquet")]
pub(super) fn open(file: File) -> Result<Box<dyn Store>, String> {
    let reader = reading::Reader::try_from(file);
    reader
        .map(|it| Box::new(it) as Box<dyn Store>)
        .map_err(|error| format!("is no Parquet: {error}"))
}

#[cfg(feature = "parquet")]
mod reading {
    use std::fs::File;

    use parquet::column::reader::ColumnReader;
    use parquet::errors::{ParquetError, Result};
    use parquet::file::reader::{FileReader as _, SerializedFileReader};

    use super::Store;

    /// A file of columns of doubles, floats or integers.
    pub(super) struct Reader(SerializedFileReader<File>);

    impl TryFrom<File> for Reader {
        type Error = ParquetError;

        fn try_from(file: File) -> Result<Self> {
            SerializedFileReader::new(file).map(Self)
        }
    }

    impl Store for Reader {
        fn headers(&self) -> Vec<String> {
            let schema = self.0.metadata().file_metadata().schema_descr();
            schema
                .columns()
                .iter()
                .map(|it| it.path().string())
                .collect()
        }

        fn read(&mut self, wanted: &[usize]) -> std::result::Result<Vec<Vec<f64>>, String> {
            let headers = self.headers();
            let column = |&place: &usize| {
                let mut column = Vec::new();
                for group in 0..self.0.num_row_groups() {
                    self.append(group, place, &mut column)
                        .map_err(|error| format!("column `{}`: {error}", headers[place]))?;
                }
                Ok(column)
            };
            wanted.iter().map(column).collect()
        }
    }

    impl Reader {
        fn append(&self, group: usize, place: usize, to: &mut Vec<f64>) -> Result<()> {
            let group = self.0.get_row_group(group)?;
            let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            macro_rules! read {
                ($reader:expr, $of:expr) => {{
                    let (mut values, mut levels) = (Vec::new(), Vec::new());
                    let mut done = 0;
                    while done < rows {
                        let (records, ..) = $reader.read_records(
                            rows - done,
                            Some(&mut levels),
                            None,
                            &mut values,
                        )?;
                        if records == 0 {
                            break;
                        }
                        done += records;
                    }
                    // A value that is not there is no number: the caller names its row.
                    let mut values = values.into_iter();
                    match levels.is_empty() {
                        true => to.extend(values.map($of)),
                        false => to.extend(levels.iter().map(|&level| match level {
                            0 => f64::NAN,
                            _ => values.next().map_or(f64::NAN, $of),
                        })),
                    }
                    Ok(())
                }};
            }
            match group.get_column_reader(place)? {
                ColumnReader::DoubleColumnReader(mut it) => read!(it, |value: f64| value),
                ColumnReader::FloatColumnReader(mut it) => read!(it, f64::from),
                ColumnReader::Int32ColumnReader(mut it) => read!(it, f64::from),
                ColumnReader::Int64ColumnReader(mut it) => read!(it, |value: i64| value as f64),
                _ => Err(ParquetError::General("it holds no numbers".to_owned())),
            }
        }
    }
}
