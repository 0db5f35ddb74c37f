//! Recording → Parquet.
use crate::chunk::Pages;
use crate::error::TraceError;
use crate::header::{FORMAT, FORMAT_KEY, Header, RECORDING_KEY};
use crate::recording::Recording;
use crate::seal::Hashed;
use crate::whole_file::{PassingFile, Unfinished};
use crate::{TIME, arrow, seal};
use parquet::basic::{Repetition, Type as PhysicalType};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{
    ColumnChunkMetaData, FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataWriter, RowGroupMetaData,
};
use parquet::schema::types::{SchemaDescriptor, Type, TypePtr};
use std::borrow::Cow;
use std::collections::HashSet;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

/// Instants per row group: the unit that a reader such as `DuckDB` gives to one thread, and 1 MiB per column.
pub(crate) const ROW_GROUP: usize = 1 << 17;
/// Beginning of a Parquet file.
const MAGIC: &[u8] = b"PAR1";
/// Version of the format: pages of the first kind.
const VERSION: i32 = 1;

impl Recording {
    /// Writes the recording as a Parquet file: the column `time` (s), one column per channel (SI, f64), and in the
    /// file's key-value metadata all the rest; readers of Apache Arrow find unit, writer and rate of a column in the
    /// metadata of its field. Nothing is lost: [`Recording::read_parquet`] returns every bit.
    ///
    /// The same recording gives the same bytes. The file appears when it is complete, as with
    /// [`write_whole`](crate::write_whole).
    ///
    /// # Errors
    /// [`TraceError::NameTaken`] and [`TraceError::UnequalLength`] before anything is written; [`TraceError::Io`]
    /// and [`TraceError::Encode`], which leave an older file of that name unchanged.
    pub fn write_parquet(&self, path: impl AsRef<Path>) -> Result<(), TraceError> {
        let path = path.as_ref();
        let finish = |source| TraceError::Io { action: "put in its place", path: path.to_path_buf(), source };
        self.unfinished(path)?.finish().map_err(finish)
    }

    /// The recording as a Parquet file for another process, under a name beside `path` that no other writer uses. The file is removed
    /// when the result is dropped; if this process is killed before, [`unfinished_by`](crate::unfinished_by) tells it by its name.
    ///
    /// # Errors
    /// As [`Recording::write_parquet`].
    pub fn write_passing(&self, path: impl AsRef<Path>) -> Result<PassingFile, TraceError> {
        self.unfinished(path.as_ref()).map(PassingFile)
    }

    /// The whole file, before it gets its name.
    fn unfinished(&self, path: &Path) -> Result<Unfinished, TraceError> {
        self.check_columns()?;
        let io = |action| move |source| TraceError::Io { action, path: path.to_path_buf(), source };
        let encode = |reason| TraceError::Encode { path: path.to_path_buf(), reason };
        let mut unfinished = Unfinished::create(path).map_err(io("create"))?;
        let hashed = self.encode(Hashed::new(&mut unfinished.file)).map_err(|error| match error {
            ParquetError::External(cause) => match cause.downcast() {
                Ok(source) => io("write")(*source),
                Err(cause) => encode(cause.to_string()),
            },
            error => encode(error.to_string()),
        })?;
        let digits = hashed.digits();
        if !seal::apply(&mut unfinished.file, &digits).map_err(io("write"))? {
            return Err(encode("the encoder left no place for the seal".into()));
        }
        Ok(unfinished)
    }

    /// Every channel can be a column: names differ, lengths do not.
    fn check_columns(&self) -> Result<(), TraceError> {
        let mut taken = HashSet::new();
        for channel in &self.channels {
            let (name, found, expected) = (channel.spec.full_name(), channel.values.len(), self.len());
            if name == TIME {
                return Err(TraceError::NameTaken { name: name.into_owned(), by: "the column of instants" });
            }
            if !taken.insert(name.clone()) {
                return Err(TraceError::NameTaken { name: name.into_owned(), by: "another channel" });
            }
            if found != expected {
                return Err(TraceError::UnequalLength { name: name.into_owned(), found, expected });
            }
        }
        Ok(())
    }

    /// Writes the file's bytes, not yet sealed, to `sink`, and returns it.
    fn encode<W: Write>(&self, sink: W) -> ParquetResult<W> {
        let schema = Arc::new(SchemaDescriptor::new(self.schema()?));
        let mut pages = Pages::new(sink);
        pages.add(MAGIC)?;
        let mut groups = Vec::new();
        let mut time = Vec::with_capacity(ROW_GROUP.min(self.len()));
        for (ordinal, start) in (0..self.len()).step_by(ROW_GROUP).enumerate() {
            let rows = start..self.len().min(start + ROW_GROUP);
            time.clear();
            time.extend(rows.clone().map(|index| self.time_of(index)));
            let place = pages.position();
            // Readers select by time, not by the value of a channel.
            let range = [time.first(), time.last()].map(|time| time.copied().unwrap_or_default());
            let mut columns = vec![pages.add_column(&time, schema.column(0), Some(range))?];
            for (channel, index) in self.channels.iter().zip(1..) {
                columns.push(pages.add_column(&channel.values[rows.clone()], schema.column(index), None)?);
            }
            let group = RowGroupMetaData::builder(Arc::clone(&schema))
                .set_total_byte_size(columns.iter().map(ColumnChunkMetaData::uncompressed_size).sum())
                .set_column_metadata(columns)
                .set_num_rows(i64::try_from(rows.len())?)
                .set_ordinal(i16::try_from(ordinal)?)
                .set_file_offset(i64::try_from(place)?);
            groups.push(group.build()?);
            self.release();
        }
        pages.add(&self.footer(schema, groups)?)?;
        Ok(pages.finish()?)
    }

    /// The footer behind the pages: schema, places, and everything except the channels as text.
    fn footer(&self, schema: Arc<SchemaDescriptor>, groups: Vec<RowGroupMetaData>) -> ParquetResult<Vec<u8>> {
        let created_by = format!("servobench recording format {FORMAT}");
        let (rows, metadata) = (i64::try_from(self.len())?, Some(self.key_values()?));
        let file = FileMetaData::new(VERSION, rows, Some(created_by), metadata, schema, None);
        let mut footer = Vec::new();
        ParquetMetaDataWriter::new(&mut footer, &ParquetMetaData::new(file, groups)).finish()?;
        Ok(footer)
    }

    fn key_values(&self) -> ParquetResult<Vec<KeyValue>> {
        let text =
            serde_json::to_string(&Header::of(self)).map_err(|error| ParquetError::General(error.to_string()))?;
        let arrow = arrow::schema(self);
        let arrow = arrow.ok_or_else(|| ParquetError::General("too many channels for an Arrow schema".into()))?;
        Ok(vec![
            KeyValue::new(FORMAT_KEY.into(), FORMAT.to_owned()),
            KeyValue::new(seal::KEY.into(), seal::BLANK.to_owned()),
            KeyValue::new(arrow::KEY.into(), arrow),
            KeyValue::new(RECORDING_KEY.into(), text),
        ])
    }

    fn schema(&self) -> ParquetResult<TypePtr> {
        let names = self.channels.iter().map(|channel| channel.spec.full_name());
        let names = std::iter::once(TIME.into()).chain(names);
        let column = |name: Cow<'_, str>| {
            let column = Type::primitive_type_builder(&name, PhysicalType::DOUBLE);
            column.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
        };
        let columns = names.map(column).collect::<ParquetResult<_>>()?;
        Ok(Arc::new(Type::group_type_builder("recording").with_fields(columns).build()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{About, Channel, ChannelSpec};
    use parquet::basic::{Compression, Encoding};
    use parquet::data_type::DoubleType;
    use parquet::file::properties::{EnabledStatistics, WriterProperties};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::types::ColumnPath;
    use servobench_base::Rate;

    /// Numbers that compress well, badly and not at all.
    fn recording(rows: usize) -> Recording {
        let rate = Rate::new(16_000).unwrap();
        let about = About {
            scenario: "s".into(),
            engine: "none".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into()],
            overrides: vec![],
        };
        let mut random = servobench_testkit::Random::seeded(7);
        let mut recording = Recording::new(about, rate);
        let mut channel = |name: &str, values: Vec<f64>| {
            let spec = ChannelSpec { axis: None, name: name.into(), unit: "m".into(), writer: "test".into(), rate };
            recording.channels.push(Channel { spec, values: values.into() });
        };
        channel("rest", vec![0.25; rows]);
        channel("smooth", (0..rows).map(|k| (k as f64 * 1e-3).sin()).collect());
        channel("noise", (0..rows).map(|_| random.signed()).collect());
        channel("not finite", (0..rows).map(|k| if k % 3 == 0 { f64::NAN } else { f64::NEG_INFINITY }).collect());
        recording
    }

    /// The file made by the library's own writer.
    fn by_the_library(recording: &Recording) -> Vec<u8> {
        let properties = WriterProperties::builder()
            .set_created_by(format!("servobench recording format {FORMAT}"))
            .set_key_value_metadata(Some(recording.key_values().unwrap()))
            .set_dictionary_enabled(false)
            .set_encoding(Encoding::BYTE_STREAM_SPLIT)
            .set_compression(Compression::LZ4_RAW)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_column_statistics_enabled(ColumnPath::from(TIME), EnabledStatistics::Chunk)
            .set_offset_index_disabled(true)
            .build();
        let mut bytes = Vec::new();
        let mut file =
            SerializedFileWriter::new(&mut bytes, recording.schema().unwrap(), Arc::new(properties)).unwrap();
        for start in (0..recording.len()).step_by(ROW_GROUP) {
            let rows = start..recording.len().min(start + ROW_GROUP);
            let time: Vec<f64> = rows.clone().map(|index| recording.time_of(index)).collect();
            let mut group = file.next_row_group().unwrap();
            let columns = recording.channels.iter().map(|channel| &channel.values[rows.clone()]);
            for values in std::iter::once(&time[..]).chain(columns) {
                let mut column = group.next_column().unwrap().unwrap();
                column.typed::<DoubleType>().write_batch(values, None, None).unwrap();
                column.close().unwrap();
            }
            group.close().unwrap();
        }
        file.close().unwrap();
        bytes
    }

    /// The text beside the channels may be longer than the collected bytes, wherever these end.
    #[test]
    fn a_long_footer_is_written_whole() {
        for rows in (0..32_000).step_by(2_000) {
            let mut recording = recording(rows);
            let message = "a long word ".repeat(100);
            recording.events =
                (0..1_000).map(|k| crate::Event::new(f64::from(k), 1e3, "test", message.as_str())).collect();
            let bytes = recording.encode(Vec::new()).unwrap();
            assert!(bytes.len() > 1 << 20 && bytes == by_the_library(&recording), "{rows} rows");
        }
    }

    #[test]
    fn the_bytes_are_those_of_the_library() {
        for rows in [0, 1, 17, 1_023, 20_479, 20_480, 20_481, 45_678, ROW_GROUP, ROW_GROUP + 1] {
            let recording = recording(rows);
            let bytes = recording.encode(Vec::new()).unwrap();
            assert!(bytes == by_the_library(&recording), "{rows} rows");
        }
    }
}
