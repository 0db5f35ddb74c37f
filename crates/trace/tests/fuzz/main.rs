//! Fuzz targets: any recording file is read as it was written or refused, without a panic and within
//! the memory that the file's size justifies. `docs/testing.md` describes how to run more of them.
mod seal;

use parquet::basic::{Repetition, Type as PhysicalType};
use parquet::data_type::DoubleType;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use servobench_base::{Rate, Severity};
use servobench_fuzz::{Splice, check, fuzz};
use servobench_testkit::CountingAllocator;
use servobench_trace::{
    About, Call, CallFate, Channel, ChannelSpec, CouplingEstimate, Ending, Event, LimitReversals, LogEntry, Move,
    Recording, Signal, TraceError,
};
use std::fs;
use std::path::Path;
use std::sync::Arc;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// A recording with `instants` instants and `channels` channels, and its file.
fn recording(instants: u32, channels: u32, path: &Path) -> (Recording, Vec<u8>) {
    let rate = Rate::new(16_000).unwrap();
    let channel = |i: u32| Channel {
        spec: ChannelSpec { axis: None, name: format!("c.{i}"), unit: "m".into(), writer: "mechanics".into(), rate },
        values: (0..instants).map(|k| f64::from(k * i) * 1e-3).collect(),
    };
    let recording = Recording {
        about: About {
            scenario: "fuzzed".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into(), "load".into()],
            overrides: vec![],
        },
        rate,
        channels: (0..channels).map(channel).collect(),
        moves: vec![Move {
            label: "move".into(),
            start: 0.0,
            end: 1.3,
            from: 0.0,
            to: 1.0,
            peaks: [1.0, 5.0, 50.0, f64::INFINITY],
            limits: [Some(1.0), Some(5.0), Some(50.0), None],
            cruise: (0.3, 0.7),
            ending: Ending::AtRest,
        }],
        events: vec![Event::bound(0.25, 0.5, "drive", "current limit", true)],
        signals: vec![Signal { source: "axis".into(), name: "state".into(), changes: vec![(0.0, "Disabled".into())] }],
        calls: vec![Call {
            name: "pick".into(),
            block: "MC_MoveAbsolute".into(),
            is_optional: true,
            fate: CallFate::Failed { time: 0.5, id: 7, message: "not homed".into() },
        }],
        limit_reversals: vec![LimitReversals { limit: "effort limit".into(), times: vec![0.25, 0.5] }],
        log: vec![LogEntry {
            source: "FMU load".into(),
            severity: Severity::Warning,
            start: 0.5,
            end: 0.75,
            times: 12,
            text: "stiff".into(),
        }],
        coupling: Some(CouplingEstimate { error: 0.0103, connection: "load.F -> disturbance.load".into() }),
    };
    recording.write_parquet(path).unwrap();
    let bytes = fs::read(path).unwrap();
    (recording, bytes)
}

/// Values that make numbers in files wrong, and the words of the format.
const BYTES: &[&[u8]] = &[
    b"PAR1",
    b"PARE",
    b"servobench.seal\x18\x10",
    b"0000000000000000",
    b"\x00",
    b"\x7f",
    b"\xff",
    b"\x00\x00\x00\x00",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\x00\x00\x00\x80",
    b"\xff\xff\xff\xff\xff\xff\xff\x7f",
    // 2³² − 1, −1 and 2⁶⁴ − 1 as Thrift writes integers, and a list that long.
    b"\xff\xff\xff\xff\x0f",
    b"\x01",
    b"\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01",
    b"\xfc\xff\xff\xff\xff\x0f",
    b"\xf8\xff\xff\xff\xff\x0f",
    b"\xf5\xff\xff\xff\xff\x0f",
];

/// The recording in the file at `path`; reading it must not allocate much more than the size of the file.
fn read(path: &Path) -> Result<Recording, TraceError> {
    let size = usize::try_from(fs::metadata(path).unwrap().len()).unwrap();
    let (outcome, largest) = CountingAllocator::largest_of(|| Recording::read_parquet(path));
    assert!(largest <= (1 << 20) + 16 * size, "{largest} bytes at once for a file of {size}");
    if let Ok(recording) = &outcome {
        let lengths = || recording.channels.iter().map(|channel| channel.values.len());
        assert!(lengths().all(|length| length == recording.len()), "{:?}", lengths().collect::<Vec<_>>());
    }
    outcome
}

/// Damage is found: a file that can be read is as it was written.
#[test]
fn damaged_recordings() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    let written = [recording(50, 2, &path), recording(1, 1, &path), recording(0, 0, &path)];
    let files: Vec<&[u8]> = written.iter().map(|(_, bytes)| &bytes[..]).collect();
    fuzz(check!(), 1_000, Splice::bytes(&files, BYTES), |bytes| {
        fs::write(&path, bytes).unwrap();
        let original = written.iter().find(|(_, original)| original == bytes).map(|(recording, _)| recording);
        assert_eq!(read(&path).ok().as_ref(), original);
    });
}

/// A file that was edited and sealed again is a recording or is refused.
#[test]
fn edited_recordings() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    let written = [recording(50, 2, &path), recording(1, 1, &path), recording(0, 0, &path)];
    let files: Vec<&[u8]> = written.iter().map(|(_, bytes)| &bytes[..]).collect();
    fuzz(check!(), 1_000, Splice::bytes(&files, BYTES), |bytes| {
        let mut bytes = bytes.clone();
        seal::apply(&mut bytes);
        fs::write(&path, bytes).unwrap();
        drop(read(&path));
    });
}

const HEADERS: [&str; 2] = [
    r#"{"scenario":"s","engine":"exact","axis_unit":"m","bodies":["motor","load"],"rate":16000,"instants":7,"channels":
    [{"name":"c.0","unit":"m","writer":"mechanics","rate":16000},{"name":"c.1","unit":"m","writer":"drive","rate":8000}],
    "moves":[{"label":"move","start":0.0,"end":1.3,"from":0.0,"to":1.0,"peaks":[1.0,5.0,50.0,"inf"],"limits":[1.0,5.0,
    null,null],"cruise":[0.3,0.7]}],"events":[{"start":0.25,"end":0.5,"source":"drive","message":"current limit"}],"signals":[{"source":"axis","name":"state","changes":[[0.0,"Disabled"]]}]}"#,
    r#"{"scenario":"","engine":"","axis_unit":"","bodies":[],"rate":1,"instants":0,"channels":[],"moves":[],"events":[],"signals":[]}"#,
];

const WORDS: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "null",
    "true",
    "NaN",
    "inf",
    "-inf",
    "time",
    "c.0",
    "c.1",
    "c.2",
    "0",
    "1",
    "6",
    "8",
    "-1",
    "4294967295",
    "4294967296",
    "1000000000",
    "9223372036854775807",
    "18446744073709551615",
    "1e400",
    "\\u0000",
];

/// A valid Parquet file, sealed, in which our header may be wrong.
#[test]
fn edited_headers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    fuzz(check!(), 1_000, Splice::text(&HEADERS, WORDS), |header| {
        let mut bytes = with_header(header);
        seal::apply(&mut bytes);
        fs::write(&path, &bytes).unwrap();
        let Ok(recording) = read(&path) else { return };
        // An accepted recording is like any other.
        recording.write_parquet(&path).unwrap();
        let again = Recording::read_parquet(&path).unwrap();
        assert_eq!(format!("{recording:?}"), format!("{again:?}"));
    });
}

/// Two channels of seven instants behind `header`.
fn with_header(header: &str) -> Vec<u8> {
    let column = |name: &str| {
        let column = Type::primitive_type_builder(name, PhysicalType::DOUBLE);
        Arc::new(column.with_repetition(Repetition::REQUIRED).build().unwrap())
    };
    let fields = ["time", "c.0", "c.1"].map(column).to_vec();
    let schema = Type::group_type_builder("recording").with_fields(fields).build().unwrap();
    let keys = [("servobench.format", "2"), ("servobench.seal", "0000000000000000"), ("servobench.recording", header)];
    let keys = keys.map(|(key, value)| KeyValue::new(key.into(), value.to_owned())).to_vec();
    let properties = WriterProperties::builder().set_key_value_metadata(Some(keys)).build();
    let mut bytes = vec![];
    let mut file = SerializedFileWriter::new(&mut bytes, schema.into(), properties.into()).unwrap();
    let mut group = file.next_row_group().unwrap();
    while let Some(mut column) = group.next_column().unwrap() {
        column.typed::<DoubleType>().write_batch(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], None, None).unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    file.close().unwrap();
    bytes
}
