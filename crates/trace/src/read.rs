//! Parquet → recording.
use crate::error::TraceError;
use crate::header::{FORMAT, FORMAT_KEY, Header, RECORDING_KEY};
use crate::recording::Recording;
use crate::seal;
use parquet::basic::Type as PhysicalType;
use parquet::column::reader::ColumnReader;
use parquet::errors::ParquetError;
use parquet::file::metadata::FileMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::SchemaDescriptor;
use std::fs::File;
use std::path::Path;

impl Recording {
    /// Reads what [`Recording::write_parquet`] wrote.
    ///
    /// The file's seal is checked before its values are decoded: a file that was damaged, cut or edited is refused, never
    /// half read.
    ///
    /// # Errors
    /// [`TraceError::Io`]; [`TraceError::NotParquet`]; [`TraceError::Missing`] names the metadata key or the column that
    /// a foreign file lacks; [`TraceError::Format`]; [`TraceError::Damaged`].
    pub fn read_parquet(path: impl AsRef<Path>) -> Result<Self, TraceError> {
        let path = path.as_ref();
        let io = |source| TraceError::Io { action: "read", path: path.into(), source };
        let mut file = File::open(path).map_err(io)?;
        let own_cursor = File::open(path).map_err(io)?;
        let reader = SerializedFileReader::new(own_cursor)
            .map_err(|error| TraceError::NotParquet { path: path.into(), reason: error.to_string() })?;
        let metadata = reader.metadata().file_metadata();
        let header = header(metadata, path)?;
        let schema = metadata.schema_descr();
        let indices = header.columns().map(|name| column(schema, name, path)).collect::<Result<Vec<_>, _>>()?;
        if !seal::holds(&mut file).map_err(io)? {
            let reason = format!("its bytes do not match its `{}`", seal::KEY);
            return Err(TraceError::Damaged { path: path.into(), reason });
        }
        let instants = header.instants;
        let mut recording = header.into_recording().ok_or_else(|| TraceError::Damaged {
            path: path.into(),
            reason: format!("a rate in `{RECORDING_KEY}` is 0 Hz"),
        })?;
        for (channel, index) in recording.channels.iter_mut().zip(indices) {
            channel.values = values(&reader, index, instants).map_err(|error| TraceError::Damaged {
                path: path.into(),
                reason: format!("column `{}`: {error}", channel.spec.name),
            })?;
        }
        Ok(recording)
    }
}

/// The header of a file that has our format.
fn header(metadata: &FileMetaData, path: &Path) -> Result<Header, TraceError> {
    let text = |key: &str| {
        let pairs = metadata.key_value_metadata().into_iter().flatten();
        let value = pairs.filter(|pair| pair.key == key).find_map(|pair| pair.value.as_deref());
        value.ok_or_else(|| TraceError::Missing {
            path: path.into(),
            missing: format!("the key `{key}` in its file metadata"),
        })
    };
    let found = text(FORMAT_KEY)?;
    if found != FORMAT {
        return Err(TraceError::Format { path: path.into(), found: found.into(), known: FORMAT });
    }
    serde_json::from_str(text(RECORDING_KEY)?).map_err(|error| TraceError::Damaged {
        path: path.into(),
        reason: format!("its `{RECORDING_KEY}` cannot be read: {error}"),
    })
}

/// Index of the column `name`.
fn column(schema: &SchemaDescriptor, name: &str, path: &Path) -> Result<usize, TraceError> {
    let is_ours = |index: &usize| {
        let column = schema.column(*index);
        column.path().parts() == [name]
            && column.physical_type() == PhysicalType::DOUBLE
            && column.max_def_level() == 0
            && column.max_rep_level() == 0
    };
    (0..schema.num_columns()).find(is_ours).ok_or_else(|| TraceError::Missing {
        path: path.into(),
        missing: format!("the column `{name}` of type DOUBLE, without nulls"),
    })
}

/// All values of a column that has `instants` of them.
fn values(reader: &SerializedFileReader<File>, column: usize, instants: usize) -> Result<Vec<f64>, ParquetError> {
    let mut values = Vec::with_capacity(instants);
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let ColumnReader::DoubleColumnReader(mut column) = group.get_column_reader(column)? else {
            return Err(ParquetError::General("its type changes between row groups".into()));
        };
        column.read_records(instants - values.len(), None, None, &mut values)?;
    }
    if values.len() == instants {
        Ok(values)
    } else {
        Err(ParquetError::General(format!("it has {} values, {instants} were written", values.len())))
    }
}
