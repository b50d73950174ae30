//! Flights as Apache Parquet.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::Table;
use crate::failure::Failure;
use crate::output::Output;

impl Table {
    pub(super) fn parquet(&self, path: &Path) -> Result<(), Failure> {
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
