//! Parquet → recording.
use crate::error::TraceError;
use crate::header::{FORMAT, FORMAT_KEY, FORMER_FORMAT, Header, RECORDING_KEY};
use crate::recording::Recording;
use crate::values::{GrowingValues, Values};
use crate::write::ROW_GROUP;
use crate::{TIME, pages, seal};
use parquet::basic::Type as PhysicalType;
use parquet::column::reader::ColumnReader;
use parquet::errors::ParquetError;
use parquet::file::metadata::{FileMetaData, ParquetMetaData};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::SchemaDescriptor;
use servobench_files::{named, with_short_quotes};
use std::borrow::Cow;
use std::collections::HashSet;
use std::fs::File;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

impl Recording {
    /// Reads a recording written by [`Recording::write_parquet`].
    ///
    /// The file's seal is checked before anything is decoded: a file that was damaged, cut or edited is refused, never
    /// half read.
    ///
    /// # Errors
    /// [`TraceError::Io`]; [`TraceError::Damaged`]; [`TraceError::NotParquet`]; [`TraceError::Missing`] names the metadata
    /// key or the column that a foreign file lacks; [`TraceError::Format`].
    pub fn read_parquet(path: impl AsRef<Path>) -> Result<Self, TraceError> {
        let path = path.as_ref();
        let io = |source| TraceError::Io { action: "read", path: path.into(), source };
        // The size of a recording is limited only by the disk; the memory for it is limited.
        let mut file = servobench_files::open(path, u64::MAX).map_err(io)?;
        let seal = seal::holds(&mut file).map_err(io)?;
        if seal == Some(false) {
            return Err(damaged(path, format!("its bytes do not match its `{}`", seal::KEY)));
        }
        // The decoder panics on some files that it has not written: foreign ones, and ours edited and sealed again.
        catch_unwind(AssertUnwindSafe(|| decode(file, path, seal.is_some()))).unwrap_or_else(|panic| {
            let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            let reason = format!("the decoder gave up: {}", words.unwrap_or("it did not say why"));
            Err(TraceError::NotParquet { path: path.into(), reason })
        })
    }
}

fn damaged(path: &Path, reason: String) -> TraceError {
    TraceError::Damaged { path: path.into(), reason }
}

fn decode(mut file: File, path: &Path, is_sealed: bool) -> Result<Recording, TraceError> {
    let own = file.try_clone();
    let io = |source| TraceError::Io { action: "read", path: path.into(), source };
    let reader = SerializedFileReader::new(own.map_err(io)?)
        .map_err(|error| TraceError::NotParquet { path: path.into(), reason: error.to_string() })?;
    let metadata = reader.metadata().file_metadata();
    let header = header(metadata, path)?;
    let mut names = HashSet::from([Cow::Borrowed(TIME)]);
    if let Some(name) = header.columns().find(|name| !names.insert(name.clone())) {
        return Err(damaged(path, format!("two columns in `{RECORDING_KEY}` are named `{}`", named(&name))));
    }
    let schema = metadata.schema_descr();
    let indices = header.columns().map(|name| column(schema, &name, path)).collect::<Result<Vec<_>, _>>()?;
    if !is_sealed {
        return Err(missing_key(seal::KEY, path));
    }
    let instants = header.instants;
    for (name, index) in header.columns().zip(&indices) {
        let held = holds(&mut file, reader.metadata(), *index, instants as u64).map_err(io)?;
        held.map_err(|why| damaged(path, format!("column `{}`: {why}", named(&name))))?;
    }
    let mut recording = header.into_recording();
    for (channel, index) in recording.channels.iter_mut().zip(indices) {
        channel.values = values(&reader, index, instants).map_err(|error| {
            let name = channel.spec.full_name();
            damaged(path, format!("column `{}`: {}", named(&name), with_short_quotes(&error.to_string())))
        })?;
    }
    Ok(recording)
}

/// The header of a file in our format.
fn header(metadata: &FileMetaData, path: &Path) -> Result<Header, TraceError> {
    let text = |key: &str| {
        let pairs = metadata.key_value_metadata().into_iter().flatten();
        let value = pairs.filter(|pair| pair.key == key).find_map(|pair| pair.value.as_deref());
        value.ok_or_else(|| missing_key(key, path))
    };
    let found = text(FORMAT_KEY)?;
    if found != FORMAT && found != FORMER_FORMAT {
        return Err(TraceError::Format {
            path: path.into(),
            found: found.into(),
            former: FORMER_FORMAT,
            known: FORMAT,
        });
    }
    serde_json::from_str(text(RECORDING_KEY)?).map_err(|error| {
        damaged(path, format!("its `{RECORDING_KEY}` cannot be read: {}", with_short_quotes(&error.to_string())))
    })
}

fn missing_key(key: &str, path: &Path) -> TraceError {
    TraceError::Missing { path: path.into(), missing: format!("the key `{key}` in its file metadata") }
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
        missing: format!("the column `{}` of type DOUBLE, without nulls", named(name)),
    })
}

/// True if the pages of a column hold `instants` values, checked before they are decoded.
fn holds(
    file: &mut File,
    metadata: &ParquetMetaData,
    column: usize,
    instants: u64,
) -> io::Result<Result<(), pages::Refusal>> {
    let end = file.metadata()?.len();
    let mut rows = 0_u64;
    for group in metadata.row_groups() {
        let chunk = group.column(column);
        let place = u64::try_from(chunk.data_page_offset()).ok().zip(u64::try_from(chunk.compressed_size()).ok());
        let place = place.and_then(|(start, length)| Some(start..start.checked_add(length)?));
        let (Some(place), Ok(count)) = (place.filter(|place| place.end <= end), u64::try_from(group.num_rows())) else {
            return Ok(Err("it is not where the file says".into()));
        };
        if chunk.dictionary_page_offset().is_some() {
            return Ok(Err("it has a dictionary, which is not written here".into()));
        }
        if let Err(why) = pages::check(file, place, count)? {
            return Ok(Err(why));
        }
        rows = rows.saturating_add(count);
    }
    Ok(if rows == instants { Ok(()) } else { Err(format!("it has {rows} values, {instants} were written")) })
}

/// All values of a column, which has `instants` of them.
fn values(reader: &SerializedFileReader<File>, column: usize, instants: usize) -> Result<Values, ParquetError> {
    // An edited file may promise any number: room is reserved for one row group of the writer.
    let (mut values, mut of_group) = (GrowingValues::with_room(instants.min(ROW_GROUP)), Vec::new());
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let ColumnReader::DoubleColumnReader(mut column) = group.get_column_reader(column)? else {
            return Err(ParquetError::General("its type changes between row groups".into()));
        };
        of_group.clear();
        column.read_records(instants - values.len(), None, None, &mut of_group)?;
        values.extend(&of_group)?;
    }
    if values.len() == instants {
        Ok(values.finish()?)
    } else {
        Err(ParquetError::General(format!("it has {} values, {instants} were written", values.len())))
    }
}
