//! A table with a unit for each column, as a file that every data tool opens: CSV, and Parquet with the units in its metadata.
//!
//! Rows are computed while they are written: a table of a million of them takes no memory.
use crate::arrow;
use arrow_schema::DataType;
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use servobench_base::Shortest;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::Arc;

/// Rows per row group.
const ROW_GROUP: usize = 1 << 16;
/// Key of the units in the file's metadata: a JSON object from the name of a column to its unit.
const UNITS_KEY: &str = "servobench:units";

/// A table whose rows are computed one after the other.
pub struct Table<'a> {
    /// Number of rows.
    pub rows: usize,
    /// Its columns; no two have the same name.
    pub columns: Vec<TableColumn<'a>>,
}

/// A column of a [`Table`].
pub struct TableColumn<'a> {
    /// Its name: `setpoint.jerk`.
    pub name: String,
    /// The unit of its numbers; empty of pure numbers and of texts.
    pub unit: String,
    /// Content of its rows.
    pub cells: Cells<'a>,
}

/// Content of a row of a column, by the number of the row from 0.
pub enum Cells<'a> {
    /// A number; missing if it is NaN.
    Numbers(Box<dyn Fn(usize) -> f64 + 'a>),
    /// A text.
    Texts(Box<dyn Fn(usize) -> Cow<'a, str> + 'a>),
}

impl Table<'_> {
    /// Writes CSV (RFC 4180): a heading with the unit of a column in brackets behind its name, `setpoint.jerk [m/s3]`;
    /// numbers in the shortest form that reads back to the same bits; missing numbers are empty.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut line = String::new();
        for column in &self.columns {
            separate(&mut line);
            let unit = if column.unit.is_empty() { String::new() } else { format!(" [{}]", column.unit) };
            quote(&mut line, &format!("{}{unit}", column.name));
        }
        writeln!(out, "{line}")?;
        for row in 0..self.rows {
            line.clear();
            for (k, column) in self.columns.iter().enumerate() {
                if k > 0 {
                    line.push(',');
                }
                match &column.cells {
                    Cells::Numbers(number) => {
                        let number = number(row);
                        if !number.is_nan() {
                            line.push_str(&Shortest(number).to_string());
                        }
                    }
                    Cells::Texts(text) => quote(&mut line, &text(row)),
                }
            }
            writeln!(out, "{line}")?;
        }
        Ok(())
    }

    /// Writes Parquet: a missing number is null. Readers of Apache Arrow find the unit in the metadata of a field, others in the file's
    /// key-value metadata under `servobench:units`.
    ///
    /// # Errors
    /// Those of `out`, and values that the format does not accept.
    pub fn write_parquet(&self, out: &mut (dyn Write + Send)) -> io::Result<()> {
        self.encode(out).map_err(|error| match error {
            ParquetError::External(cause) => match cause.downcast::<io::Error>() {
                Ok(cause) => *cause,
                Err(cause) => io::Error::other(cause),
            },
            error => io::Error::other(error),
        })
    }

    fn encode(&self, out: &mut (dyn Write + Send)) -> ParquetResult<()> {
        let fields = self.columns.iter().map(TableColumn::field).collect::<ParquetResult<_>>()?;
        let schema = Type::group_type_builder("sweep").with_fields(fields).build()?;
        let properties = WriterProperties::builder()
            .set_created_by(concat!("servobench ", env!("CARGO_PKG_VERSION")).into())
            .set_compression(Compression::ZSTD(ZstdLevel::default()))
            .set_key_value_metadata(Some(self.key_values()?));
        let mut file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?;
        for start in (0..self.rows).step_by(ROW_GROUP) {
            let mut group = file.next_row_group()?;
            for column in &self.columns {
                column.add(start..self.rows.min(start + ROW_GROUP), &mut group)?;
            }
            group.close()?;
        }
        file.close()?;
        Ok(())
    }

    fn key_values(&self) -> ParquetResult<Vec<KeyValue>> {
        let fields = self.columns.iter().map(|column| {
            let (kind, may_be_missing) = match column.cells {
                Cells::Numbers(_) => (DataType::Float64, true),
                Cells::Texts(_) => (DataType::Utf8, false),
            };
            arrow::field(&column.name, kind, may_be_missing, &[("unit", column.unit.clone())])
        });
        let units: BTreeMap<_, _> = self.columns.iter().map(|column| (&column.name, &column.unit)).collect();
        let units = serde_json::to_string(&units).map_err(|error| ParquetError::General(error.to_string()))?;
        let schema = arrow::encoded(fields.collect());
        let schema = schema.ok_or_else(|| ParquetError::General("too many columns for an Arrow schema".into()))?;
        Ok(vec![KeyValue::new(arrow::KEY.into(), schema), KeyValue::new(UNITS_KEY.into(), units)])
    }
}

impl TableColumn<'_> {
    fn field(&self) -> ParquetResult<Arc<Type>> {
        let field = match self.cells {
            Cells::Numbers(_) => {
                let number = Type::primitive_type_builder(&self.name, PhysicalType::DOUBLE);
                number.with_repetition(Repetition::OPTIONAL)
            }
            Cells::Texts(_) => {
                let text = Type::primitive_type_builder(&self.name, PhysicalType::BYTE_ARRAY);
                text.with_repetition(Repetition::REQUIRED).with_logical_type(Some(LogicalType::String))
            }
        };
        field.build().map(Arc::new)
    }

    /// Adds these rows as a column of a row group.
    fn add<W: Write + Send>(
        &self,
        rows: std::ops::Range<usize>,
        group: &mut SerializedRowGroupWriter<'_, W>,
    ) -> ParquetResult<()> {
        let mut column = group.next_column()?.ok_or_else(|| ParquetError::General("a column too many".into()))?;
        match &self.cells {
            Cells::Numbers(number) => {
                let all = rows.map(number);
                let (mut numbers, mut is_there) = (Vec::new(), Vec::new());
                for number in all {
                    is_there.push(i16::from(!number.is_nan()));
                    numbers.extend((!number.is_nan()).then_some(number));
                }
                column.typed::<DoubleType>().write_batch(&numbers, Some(&is_there), None)?;
            }
            Cells::Texts(text) => {
                let texts: Vec<ByteArray> = rows.map(|row| text(row).as_bytes().to_vec().into()).collect();
                column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
            }
        }
        column.close()
    }
}

fn separate(line: &mut String) {
    if !line.is_empty() {
        line.push(',');
    }
}

/// A text as one cell.
fn quote(line: &mut String, text: &str) {
    if text.contains(['"', ',', '\n', '\r']) {
        line.push('"');
        line.push_str(&text.replace('"', "\"\""));
        line.push('"');
    } else {
        line.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader as _, SerializedFileReader};
    use parquet::record::RowAccessor as _;

    const NUMBERS: [f64; 4] = [0.1 + 0.2, f64::NAN, -1e-300, 5e20];
    const TEXTS: [&str; 4] = ["plain", "a, \"b\"", "two\nlines", ""];

    fn table<'a>() -> Table<'a> {
        let number = |row: usize| NUMBERS[row % 4];
        let text = |row: usize| Cow::Borrowed(TEXTS[row % 4]);
        Table {
            rows: 4,
            columns: vec![
                TableColumn { name: "jerk".into(), unit: "m/s3".into(), cells: Cells::Numbers(Box::new(number)) },
                TableColumn { name: "what, else".into(), unit: String::new(), cells: Cells::Texts(Box::new(text)) },
            ],
        }
    }

    #[test]
    fn csv_has_units_and_quotes_what_needs_it() {
        let mut bytes = Vec::new();
        table().write_csv(&mut bytes).unwrap();
        let expected =
            "jerk [m/s3],\"what, else\"\n0.30000000000000004,plain\n,\"a, \"\"b\"\"\"\n-1e-300,\"two\nlines\"\n5e20,\n";
        assert_eq!(String::from_utf8(bytes).unwrap(), expected);
    }

    /// Oracle: the library's reader. More rows than a row group has.
    #[test]
    fn parquet_reads_back_with_its_units() {
        let rows = ROW_GROUP + 5;
        let mut file = tempfile::tempfile().unwrap();
        Table { rows, ..table() }.write_parquet(&mut file).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let units = metadata.iter().find(|one| one.key == UNITS_KEY).and_then(|one| one.value.clone()).unwrap();
        assert_eq!(units, r#"{"jerk":"m/s3","what, else":""}"#);
        let mut count = 0;
        for (row, record) in reader.get_row_iter(None).unwrap().enumerate() {
            let record = record.unwrap();
            let number = record.get_double(0).ok();
            assert_eq!(number.map(f64::to_bits), Some(NUMBERS[row % 4]).filter(|n| !n.is_nan()).map(f64::to_bits));
            assert_eq!(record.get_string(1).unwrap(), TEXTS[row % 4]);
            count += 1;
        }
        assert_eq!(count, rows);
    }

    #[test]
    fn a_full_disk_is_said() {
        let refusal = Table { rows: 100_000, ..table() }.write_parquet(&mut Full).unwrap_err();
        assert_eq!(refusal.kind(), io::ErrorKind::StorageFull, "{refusal}");
    }

    struct Full;

    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
}
