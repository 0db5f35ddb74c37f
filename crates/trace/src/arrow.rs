//! A recording for readers of Apache Arrow: each column with unit, writer and rate.
//!
//! They look for an Arrow schema in the file's key-value metadata, under `ARROW:schema`: the IPC message of the schema behind
//! the continuation mark and its length, in base64. Source: Apache Arrow, *Columnar Format*, "Encapsulated message format";
//! Apache Arrow C++, `cpp/src/parquet/arrow/writer.cc` (`GetSchemaMetadata`).
use crate::TIME;
use crate::recording::Recording;
use arrow_ipc::writer::{DictionaryTracker, IpcDataGenerator, IpcWriteOptions};
use arrow_schema::{DataType, Field, Schema};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use std::collections::HashMap;

/// Key of the schema.
pub(crate) const KEY: &str = "ARROW:schema";
/// Beginning of an encapsulated message.
const CONTINUATION: [u8; 4] = [0xff; 4];

/// The schema of `recording`, as the value of [`KEY`]; `None` if it were longer than a message can be.
pub(crate) fn schema(recording: &Recording) -> Option<String> {
    let time = field(TIME, DataType::Float64, false, &[("unit", "s".to_owned())]);
    let channels = recording.channels.iter().map(|channel| {
        let spec = &channel.spec;
        let rate = format!("{} Hz", spec.rate.hertz());
        let metadata = [("unit", spec.unit.clone()), ("writer", spec.writer.clone()), ("rate", rate)];
        field(&spec.full_name(), DataType::Float64, false, &metadata)
    });
    encoded(std::iter::once(time).chain(channels).collect())
}

/// A column with its metadata.
pub(crate) fn field(name: &str, kind: DataType, may_be_missing: bool, metadata: &[(&str, String)]) -> Field {
    let metadata: HashMap<_, _> = metadata.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    Field::new(name, kind, may_be_missing).with_metadata(metadata)
}

/// A schema of these columns, as the value of [`KEY`]; `None` if it were longer than a message can be.
pub(crate) fn encoded(fields: Vec<Field>) -> Option<String> {
    let schema = Schema::new(fields);
    let (mut dictionaries, options) = (DictionaryTracker::new(true), IpcWriteOptions::default());
    let message =
        IpcDataGenerator::default().schema_to_bytes_with_dictionary_tracker(&schema, &mut dictionaries, &options);
    let message = message.ipc_message;
    let length = u32::try_from(message.len()).ok()?.to_le_bytes();
    Some(BASE64_STANDARD.encode([&CONTINUATION[..], &length, &message].concat()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{About, Channel, ChannelSpec};
    use servobench_base::Rate;

    fn recording() -> Recording {
        let rate = Rate::new(12_000).unwrap();
        let about = About {
            scenario: "a".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec![],
            overrides: vec![],
        };
        let mut recording = Recording::new(about, rate);
        for (name, unit) in [("load.position", "m"), ("ratio", "")] {
            let spec = ChannelSpec { axis: None, name: name.into(), unit: unit.into(), writer: "plant".into(), rate };
            recording.channels.push(Channel { spec, values: vec![0.0].into() });
        }
        recording
    }

    /// Read back by the format's own reader.
    #[test]
    fn columns_have_unit_writer_and_rate() {
        let bytes = BASE64_STANDARD.decode(schema(&recording()).unwrap()).unwrap();
        assert_eq!(bytes[..4], CONTINUATION);
        let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap());
        assert_eq!(length as usize, bytes.len() - 8);
        let schema = arrow_ipc::convert::try_schema_from_ipc_buffer(&bytes).unwrap();
        let names: Vec<_> = schema.fields().iter().map(|field| field.name().as_str()).collect();
        assert_eq!(names, ["time", "load.position", "ratio"]);
        let of = |index: usize, key: &str| schema.field(index).metadata().get(key).map(String::as_str);
        assert_eq!((of(0, "unit"), of(0, "writer")), (Some("s"), None));
        assert_eq!((of(1, "unit"), of(1, "writer"), of(1, "rate")), (Some("m"), Some("plant"), Some("12000 Hz")));
        assert_eq!(of(2, "unit"), Some(""), "a pure number");
        assert!(schema.fields().iter().all(|field| !field.is_nullable()));
    }

    /// A map has no order; the bytes of a recording have.
    #[test]
    fn the_same_recording_gives_the_same_text() {
        let first = schema(&recording());
        assert!((0..50).all(|_| schema(&recording()) == first));
    }
}
