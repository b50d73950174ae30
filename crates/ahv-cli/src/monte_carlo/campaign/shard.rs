//! A shard on disk: a row a member, with the sums of its members in the metadata.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;

use ahv_analysis::monte_carlo::{Loss, MemberRecord, Part};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Parquet};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use sha2::{Digest, Sha256};

use super::super::members::INTERVALS;
use super::manifest::Manifest;
use crate::failure::Failure;
use crate::flights::Ready;
use crate::output::{self, Output};

/// Keys of the metadata: what the campaign flies, units by column, sums of the members, checksum of all.
const CAMPAIGN: &str = "ahv.campaign";
const UNITS: &str = "ahv.units";
const PART: &str = "ahv.part";
const CHECKSUM: &str = "ahv.sha256";

/// Members that were flown.
pub(super) struct Flown {
    pub(super) records: Vec<MemberRecord>,
    pub(super) part: Part,
}

/// A column and its unit.
struct Column {
    name: String,
    unit: &'static str,
    kind: Physical,
    required: bool,
}

/// The columns: number of the member; when, by which state or rule it was lost; when each state first left its interval; the
/// last state.
fn columns(ready: &Ready) -> Vec<Column> {
    let column = |name: String, unit, kind, required| Column {
        name,
        unit,
        kind,
        required,
    };
    let mut columns = vec![
        column("member".to_owned(), "1", Physical::INT64, true),
        column("lost_step".to_owned(), "step", Physical::INT64, false),
        column("lost_state".to_owned(), "1", Physical::BYTE_ARRAY, false),
        column("lost_rule".to_owned(), "1", Physical::BYTE_ARRAY, false),
    ];
    for set in INTERVALS.iter().take(ready.experiment.watched.len()) {
        let names = ready.vehicle.states.names.iter();
        let names = names.map(|state| format!("left_{set}_{state}"));
        columns.extend(names.map(|name| column(name, "step", Physical::INT64, false)));
    }
    let states = ready.vehicle.states.iter();
    let states =
        states.map(|(name, unit)| column(format!("last_{name}"), unit, Physical::DOUBLE, true));
    columns.extend(states);
    columns
}

/// SHA-256 of all that a shard says.
fn checksum(campaign: &str, part: &str, records: &[MemberRecord]) -> String {
    let mut hash = Sha256::new();
    let text = |hash: &mut Sha256, text: &str| {
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    };
    text(&mut hash, campaign);
    text(&mut hash, part);
    for seen in records {
        seen.last
            .iter()
            .for_each(|it| hash.update(it.to_le_bytes()));
        for left in seen.left.iter().flatten() {
            hash.update(left.unwrap_or(u64::MAX).to_le_bytes());
        }
        if let Some(loss) = &seen.lost {
            hash.update(loss.step.to_le_bytes());
            text(&mut hash, loss.state);
            text(&mut hash, loss.rule.unwrap_or_default());
        }
    }
    let digest = hash.finalize();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn campaign_text(manifest: &Manifest) -> Result<String, Failure> {
    let options = manifest.options().iter();
    output::json(&options.cloned().collect::<BTreeMap<String, String>>())
}

impl Flown {
    /// Puts the shard in its place, whole.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if it cannot be written.
    pub(super) fn write(
        &self,
        path: &Path,
        manifest: &Manifest,
        ready: &Ready,
    ) -> Result<(), Failure> {
        let columns = columns(ready);
        let units = columns.iter().map(|it| (&*it.name, it.unit));
        let units: BTreeMap<&str, &str> = units.collect();
        let (campaign, part) = (campaign_text(manifest)?, output::json(&self.part)?);
        let metadata = [
            (CHECKSUM, checksum(&campaign, &part, &self.records)),
            (CAMPAIGN, campaign),
            (UNITS, output::json(&units)?),
            (PART, part),
        ];
        let number = path
            .file_stem()
            .and_then(|it| it.to_str()?.rsplit('-').next()?.parse().ok());
        let first = number
            .and_then(|it: usize| manifest.shards().get(it))
            .map_or(0, |it| it.first);
        let mut output = Output::create(path)?;
        let written = self.write_to(&mut output, &columns, first, metadata);
        written.map_err(|error| output::cannot_write(path, &error.to_string()))?;
        output.finish()
    }

    fn write_to(
        &self,
        output: &mut Output,
        columns: &[Column],
        first: u64,
        metadata: [(&str, String); 4],
    ) -> Parquet<()> {
        let fields = columns.iter().map(|column| {
            let repetition = match column.required {
                true => Repetition::REQUIRED,
                false => Repetition::OPTIONAL,
            };
            let text = (column.kind == Physical::BYTE_ARRAY).then_some(LogicalType::String);
            let field = Type::primitive_type_builder(&column.name, column.kind);
            let field = field.with_repetition(repetition).with_logical_type(text);
            field.build().map(Arc::new)
        });
        let schema = Type::group_type_builder("members")
            .with_fields(fields.collect::<Parquet<_>>()?)
            .build()?;
        let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_owned(), value));
        let properties = WriterProperties::builder()
            .set_created_by(concat!("ahv ", env!("CARGO_PKG_VERSION")).to_owned())
            // Numbers of noise do not repeat.
            .set_dictionary_enabled(false)
            .set_key_value_metadata(Some(metadata.to_vec()))
            .build();
        let mut writer = SerializedFileWriter::new(output, Arc::new(schema), Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        // Members are fewer than 10^9, and steps than 10^12.
        let members = (first as i64..)
            .zip(&self.records)
            .map(|(member, _)| Some(member));
        put::<Int64Type>(&mut group, members, true)?;
        let losses = || self.records.iter().map(|seen| seen.lost.as_ref());
        put::<Int64Type>(&mut group, losses().map(|it| Some(it?.step as i64)), false)?;
        let states = losses().map(|it| Some(ByteArray::from(it?.state)));
        put::<ByteArrayType>(&mut group, states, false)?;
        let rules = losses().map(|it| Some(ByteArray::from(it?.rule?)));
        put::<ByteArrayType>(&mut group, rules, false)?;
        let shape = self.records.first();
        let sets = shape.map_or(0, |it| it.left.len());
        let states = shape.map_or(0, |it| it.last.len());
        for (set, state) in (0..sets).flat_map(|set| (0..states).map(move |it| (set, it))) {
            let left = |seen: &MemberRecord| Some((*seen.left.get(set)?.get(state)?)? as i64);
            put::<Int64Type>(&mut group, self.records.iter().map(left), false)?;
        }
        for state in 0..states {
            let last = |seen: &MemberRecord| seen.last.get(state).copied();
            put::<DoubleType>(&mut group, self.records.iter().map(last), true)?;
        }
        group.close()?;
        writer.close()?;
        Ok(())
    }
}

/// Writes the next column.
fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, &mut Output>,
    values: impl Iterator<Item = Option<T::T>>,
    required: bool,
) -> Parquet<()> {
    let (mut some, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        some.extend(value);
    }
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("a column is missing".to_owned()));
    };
    let levels = (!required).then_some(&*levels);
    column.typed::<T>().write_batch(&some, levels, None)?;
    column.close()
}

/// Reads the column of this number.
fn take<T: DataType>(
    group: &dyn RowGroupReader,
    column: usize,
    rows: usize,
) -> Parquet<Vec<Option<T::T>>> {
    let required = group
        .metadata()
        .column(column)
        .column_descr()
        .max_def_level()
        == 0;
    let physical = group.metadata().column(column).column_type();
    if physical != T::get_physical_type() {
        return Err(ParquetError::General(format!(
            "column {column} is of another type"
        )));
    }
    let mut reader = get_typed_column_reader::<T>(group.get_column_reader(column)?);
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    while reader
        .read_records(rows, (!required).then_some(&mut levels), None, &mut values)?
        .0
        > 0
    {}
    if required {
        return Ok(values.into_iter().map(Some).collect());
    }
    let mut values = values.into_iter();
    Ok(levels
        .iter()
        .map(|level| if *level > 0 { values.next() } else { None })
        .collect())
}

/// Whether the file of a shard is of this campaign and ends as it must. Its rows are not read.
pub(super) fn is_there(path: &Path, manifest: &Manifest, number: usize) -> bool {
    open(path, manifest, number).is_ok_and(|it| it.is_some())
}

/// A file of this campaign, with the text of its options, of its sums and its checksum.
type Opened = (SerializedFileReader<File>, [String; 3]);

fn open(path: &Path, manifest: &Manifest, number: usize) -> Result<Option<Opened>, String> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(output::plain(&error)),
    };
    let reader = SerializedFileReader::new(file).map_err(|_| "it is no whole Parquet file")?;
    let metadata = reader.metadata().file_metadata();
    let text = |key: &str| {
        let pairs = metadata.key_value_metadata()?.iter();
        pairs.into_iter().find(|it| it.key == key)?.value.clone()
    };
    let texts = [CAMPAIGN, PART, CHECKSUM].map(text);
    let [Some(campaign), Some(part), Some(checksum)] = texts else {
        return Err("it is no shard of a campaign".to_owned());
    };
    let own = campaign_text(manifest).map_err(|_| "its options have no text")?;
    if campaign != own {
        return Err("it is of another campaign".to_owned());
    }
    let rows = u64::try_from(metadata.num_rows()).unwrap_or(0);
    if rows != manifest.shards()[number].members || reader.num_row_groups() != 1 {
        return Err(format!("it has {rows} members"));
    }
    Ok(Some((reader, [campaign, part, checksum])))
}

/// The members of a shard; `None` where there is no file.
///
/// # Errors
///
/// What is wrong with the file.
pub(super) fn read(
    path: &Path,
    manifest: &Manifest,
    number: usize,
    ready: &Ready,
) -> Result<Option<Flown>, String> {
    let Some((reader, [campaign, text, sum])) = open(path, manifest, number)? else {
        return Ok(None);
    };
    let records = records(&reader, ready).map_err(|error| format!("it cannot be read: {error}"))?;
    if checksum(&campaign, &text, &records) != sum {
        return Err("its checksum is another".to_owned());
    }
    let range = &manifest.shards()[number];
    let part: Part = serde_json::from_str(&text).map_err(|_| "its sums cannot be read")?;
    let experiment = &ready.experiment;
    if !part.is_of(experiment, manifest.reference(), range.first, range.members) {
        return Err("its sums are of other members".to_owned());
    }
    Ok(Some(Flown { records, part }))
}

fn records(reader: &SerializedFileReader<File>, ready: &Ready) -> Parquet<Vec<MemberRecord>> {
    let columns = columns(ready);
    let group = reader.get_row_group(0)?;
    let own = reader.metadata().file_metadata().schema_descr();
    let names = own.columns().iter().map(|it| it.name());
    if !names.eq(columns.iter().map(|it| &*it.name)) {
        return Err(ParquetError::General("its columns are others".to_owned()));
    }
    let group = &*group;
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let steps = take::<Int64Type>(group, 1, rows)?;
    let lost_states = take::<ByteArrayType>(group, 2, rows)?;
    let rules = take::<ByteArrayType>(group, 3, rows)?;
    let states = ready.vehicle.states.names;
    let known_rules = ready.vehicle.model.table().rules;
    let mut records: Vec<MemberRecord> = (0..rows)
        .map(|row| {
            let name = |texts: &[Option<ByteArray>]| texts.get(row).cloned().flatten();
            let (state, rule) = (name(&lost_states), name(&rules));
            let state = state.and_then(|it| states.iter().find(|own| own.as_bytes() == it.data()));
            let rule = rule.and_then(|it| {
                let mut reasons = known_rules.iter().map(|rule| rule.reason);
                reasons.find(|own| own.as_bytes() == it.data())
            });
            let step = steps.get(row).copied().flatten();
            MemberRecord {
                companion: Vec::new(),
                states: Vec::new(),
                inputs: Vec::new(),
                last: Vec::with_capacity(states.len()),
                lost: step.map(|step| Loss {
                    step: step as u64,
                    state: state.copied().unwrap_or(""),
                    rule,
                }),
                left: vec![vec![None; states.len()]; ready.experiment.watched.len()],
            }
        })
        .collect();
    let mut column = 4;
    for set in 0..ready.experiment.watched.len() {
        for state in 0..states.len() {
            let steps = take::<Int64Type>(group, column, rows)?;
            for (record, step) in records.iter_mut().zip(steps) {
                record.left[set][state] = step.map(|it| it as u64);
            }
            column += 1;
        }
    }
    for _ in states {
        let last = take::<DoubleType>(group, column, rows)?;
        for (record, value) in records.iter_mut().zip(last) {
            record.last.extend(value);
        }
        column += 1;
    }
    Ok(records)
}
