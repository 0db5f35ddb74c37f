//! Recording → Parquet.
use crate::error::TraceError;
use crate::header::{FORMAT, FORMAT_KEY, Header, RECORDING_KEY};
use crate::recording::Recording;
use crate::seal::Hashed;
use crate::whole_file::Unfinished;
use crate::{TIME, arrow, seal};
use parquet::basic::{Compression, Encoding, Repetition, Type as PhysicalType};
use parquet::data_type::DoubleType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type, TypePtr};
use std::collections::HashSet;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

/// Instants per row group: what a reader such as `DuckDB` hands to one thread, and 1 MiB per column.
pub(crate) const ROW_GROUP: usize = 1 << 17;

impl Recording {
    /// Writes the recording as a Parquet file: the column `time` (s), one column per channel (SI, f64), and in the
    /// file's key-value metadata all the rest; readers of Apache Arrow find unit, writer and rate of a column in the
    /// metadata of its field. Nothing is lost: [`Recording::read_parquet`] gives back every bit.
    ///
    /// The same recording gives the same bytes. The file appears when it is whole, as [`write_whole`](crate::write_whole)
    /// does it.
    ///
    /// # Errors
    /// [`TraceError::NameTaken`] and [`TraceError::UnequalLength`] before anything is written; [`TraceError::Io`]
    /// and [`TraceError::Encode`], which leave an older file of that name as it was.
    pub fn write_parquet(&self, path: impl AsRef<Path>) -> Result<(), TraceError> {
        let path = path.as_ref();
        self.check_columns()?;
        let io = |action| move |source| TraceError::Io { action, path: path.to_path_buf(), source };
        let encode = |reason| TraceError::Encode { path: path.to_path_buf(), reason };
        let mut unfinished = Unfinished::create(path).map_err(io("create"))?;
        let mut hashed = Hashed::new(BufWriter::with_capacity(1 << 20, &mut unfinished.file));
        self.encode(&mut hashed).map_err(|error| match error {
            ParquetError::External(cause) => match cause.downcast() {
                Ok(source) => io("write")(*source),
                Err(cause) => encode(cause.to_string()),
            },
            error => encode(error.to_string()),
        })?;
        hashed.flush().map_err(io("write"))?;
        let digits = hashed.digits();
        if !seal::apply(&mut unfinished.file, &digits).map_err(io("write"))? {
            return Err(encode("the encoder left no place for the seal".into()));
        }
        unfinished.finish().map_err(io("put in its place"))
    }

    /// Every channel can be a column: names differ, lengths do not.
    fn check_columns(&self) -> Result<(), TraceError> {
        let mut taken = HashSet::new();
        for channel in &self.channels {
            let (name, found, expected) = (&channel.spec.name, channel.values.len(), self.len());
            if name == TIME {
                return Err(TraceError::NameTaken { name: name.clone(), by: "the column of instants" });
            }
            if !taken.insert(name) {
                return Err(TraceError::NameTaken { name: name.clone(), by: "another channel" });
            }
            if found != expected {
                return Err(TraceError::UnequalLength { name: name.clone(), found, expected });
            }
        }
        Ok(())
    }

    /// The file's bytes, not yet sealed.
    fn encode(&self, sink: impl Write + Send) -> ParquetResult<()> {
        let text =
            serde_json::to_string(&Header::of(self)).map_err(|error| ParquetError::General(error.to_string()))?;
        let arrow = arrow::schema(self);
        let arrow = arrow.ok_or_else(|| ParquetError::General("too many channels for an Arrow schema".into()))?;
        let metadata = vec![
            KeyValue::new(FORMAT_KEY.into(), FORMAT.to_owned()),
            KeyValue::new(seal::KEY.into(), seal::BLANK.to_owned()),
            KeyValue::new(arrow::KEY.into(), arrow),
            KeyValue::new(RECORDING_KEY.into(), text),
        ];
        let properties = WriterProperties::builder()
            .set_created_by(format!("servobench recording format {FORMAT}"))
            .set_key_value_metadata(Some(metadata))
            // The bytes of a smooth signal's f64 compress only when equal significance stands side by side.
            .set_dictionary_enabled(false)
            .set_encoding(Encoding::BYTE_STREAM_SPLIT)
            // Nearly as small as by zstd in half the time: the bytes that do not compress are passed over.
            .set_compression(Compression::LZ4_RAW)
            // Somebody looks for a stretch of time, nobody for the rows in which a torque lies between two values.
            .set_statistics_enabled(EnabledStatistics::None)
            .set_column_statistics_enabled(ColumnPath::from(TIME), EnabledStatistics::Chunk)
            .set_offset_index_disabled(true)
            .build();
        let mut file = SerializedFileWriter::new(sink, self.schema()?, Arc::new(properties))?;
        let mut time = Vec::with_capacity(ROW_GROUP.min(self.len()));
        for start in (0..self.len()).step_by(ROW_GROUP) {
            let end = self.len().min(start + ROW_GROUP);
            time.clear();
            time.extend((start..end).map(|index| self.time_of(index)));
            let mut group = file.next_row_group()?;
            write_column(&mut group, &time)?;
            for channel in &self.channels {
                write_column(&mut group, &channel.values[start..end])?;
            }
            group.close()?;
        }
        file.close()?;
        Ok(())
    }

    fn schema(&self) -> ParquetResult<TypePtr> {
        let names = std::iter::once(TIME).chain(self.channels.iter().map(|channel| channel.spec.name.as_str()));
        let column = |name| {
            let column = Type::primitive_type_builder(name, PhysicalType::DOUBLE);
            column.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
        };
        let columns = names.map(column).collect::<ParquetResult<_>>()?;
        Ok(Arc::new(Type::group_type_builder("recording").with_fields(columns).build()?))
    }
}

fn write_column<W: Write + Send>(group: &mut SerializedRowGroupWriter<'_, W>, values: &[f64]) -> ParquetResult<()> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("the schema has fewer columns than the recording".into()));
    };
    column.typed::<DoubleType>().write_batch(values, None, None)?;
    column.close()
}
