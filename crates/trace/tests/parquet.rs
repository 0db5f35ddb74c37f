//! A recording comes back from its file bit for bit, or is refused with the reason.
use proptest::prelude::*;
use servobench_base::{Rate, Severity};
use servobench_trace::{
    About, Call, CallFate, Channel, ChannelSpec, CouplingEstimate, Ending, Event, LimitReversals, LogEntry, Move,
    Recording, Signal, TraceError,
};
use std::fs;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// Every f64 that is not NaN, infinities, zeros of both signs and subnormal numbers among them.
fn number() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("NaN", |value| !value.is_nan())
}

fn rate() -> impl Strategy<Value = Rate> {
    (1..=u32::MAX).prop_map(|hertz| Rate::new(hertz).unwrap())
}

fn one_move() -> impl Strategy<Value = Move> {
    let peaks = prop::array::uniform4(number());
    let limits = prop::array::uniform4(prop::option::of(number()));
    let ending = prop::sample::select(vec![Ending::AtRest, Ending::Aborted, Ending::InMotion]);
    (any::<String>(), prop::array::uniform4(number()), peaks, limits, number(), number(), ending).prop_map(
        |(label, [start, end, from, to], peaks, limits, at, length, ending)| Move {
            label,
            start,
            end,
            from,
            to,
            peaks,
            limits,
            cruise: (at, length),
            ending,
        },
    )
}

fn event() -> impl Strategy<Value = Event> {
    (number(), number(), any::<String>(), any::<String>(), any::<Option<bool>>()).prop_map(
        |(start, end, source, message, limit)| match limit {
            None => Event::new(start, end, source, message),
            Some(is_last_noted) => Event::bound(start, end, source, &message, is_last_noted),
        },
    )
}

fn signal() -> impl Strategy<Value = Signal> {
    let changes = prop::collection::vec((number(), any::<String>()), 0..4);
    (any::<String>(), any::<String>(), changes).prop_map(|(source, name, changes)| Signal { source, name, changes })
}

fn call() -> impl Strategy<Value = Call> {
    let fate = prop_oneof![
        any::<String>().prop_map(CallFate::NeverExecuted),
        Just(CallFate::Executed),
        any::<String>().prop_map(CallFate::Unfinished),
        (number(), any::<u32>(), any::<String>()).prop_map(|(time, id, message)| CallFate::Failed {
            time,
            id,
            message
        }),
    ];
    (any::<String>(), any::<String>(), any::<bool>(), fate).prop_map(|(name, block, is_optional, fate)| Call {
        name,
        block,
        is_optional,
        fate,
    })
}

fn limit_reversals() -> impl Strategy<Value = LimitReversals> {
    (any::<String>(), prop::collection::vec(number(), 0..4)).prop_map(|(limit, times)| LimitReversals { limit, times })
}

fn log_entry() -> impl Strategy<Value = LogEntry> {
    let severity = prop::sample::select(vec![Severity::Info, Severity::Warning, Severity::Error]);
    (any::<String>(), severity, number(), number(), any::<u64>(), any::<String>())
        .prop_map(|(source, severity, start, end, times, text)| LogEntry { source, severity, start, end, times, text })
}

fn spec() -> impl Strategy<Value = ChannelSpec> {
    let axis = prop::option::of("[A-Za-z0-9_-]{1,32}".prop_map(|name| name.parse().unwrap()));
    (axis, "c\\.[a-zµ_]{1,9}(\\.[a-z_]{1,9})?", any::<String>(), any::<String>(), rate())
        .prop_map(|(axis, name, unit, writer, rate)| ChannelSpec { axis, name, unit, writer, rate })
}

fn channels() -> impl Strategy<Value = Vec<Channel>> {
    (prop::collection::vec(spec(), 0..6), 0..300_usize).prop_flat_map(|(mut specs, instants)| {
        specs.sort_by(|one, two| one.full_name().cmp(&two.full_name()));
        specs.dedup_by(|one, two| one.full_name() == two.full_name());
        let values = prop::collection::vec(prop::collection::vec(number(), instants), specs.len());
        values.prop_map(move |values| {
            let pairs = specs.iter().cloned().zip(values);
            pairs.map(|(spec, values)| Channel { spec, values: values.into() }).collect()
        })
    })
}

fn any_recording() -> impl Strategy<Value = Recording> {
    let about = (any::<String>(), any::<String>(), any::<String>(), prop::collection::vec(any::<String>(), 0..3));
    let moves = prop::collection::vec(one_move(), 0..3);
    let events = prop::collection::vec(event(), 0..3);
    let signals = prop::collection::vec(signal(), 0..3);
    let log = prop::collection::vec(log_entry(), 0..3);
    let calls = prop::collection::vec(call(), 0..3);
    let limit_reversals = prop::collection::vec(limit_reversals(), 0..3);
    let coupling = prop::option::of(
        (number(), any::<String>()).prop_map(|(error, connection)| CouplingEstimate { error, connection }),
    );
    let all = (about, rate(), channels(), moves, events, signals, (calls, limit_reversals, coupling), log);
    all.prop_map(|(about, rate, channels, moves, events, signals, (calls, limit_reversals, coupling), log)| {
        let (scenario, engine, axis_unit, bodies) = about;
        let overrides = bodies.iter().rev().cloned().collect();
        let about = About { scenario, engine, axis_unit, bodies, overrides };
        Recording { about, rate, channels, moves, events, signals, calls, limit_reversals, log, coupling }
    })
}

fn said(recording: &Recording) -> String {
    let Recording { moves, events, signals, calls, limit_reversals, log, coupling, .. } = recording;
    format!("{moves:?}{events:?}{signals:?}{calls:?}{limit_reversals:?}{log:?}{coupling:?}")
}

/// Equality bit for bit: `==` alone takes -0 for 0.
fn assert_same(one: &Recording, two: &Recording) {
    assert_eq!(one, two);
    // The shortest text that reads back as the same f64 tells all of them apart, zeros too.
    assert_eq!(said(one), said(two));
    for (one, two) in one.channels.iter().zip(&two.channels) {
        let bits = |channel: &Channel| channel.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(one), bits(two), "{}", one.spec.name);
    }
}

fn small(instants: u32) -> Recording {
    let rate = Rate::new(12_000).unwrap();
    let channel = |name: &str, values: &dyn Fn(f64) -> f64| Channel {
        spec: ChannelSpec { axis: None, name: name.into(), unit: "m".into(), writer: "mechanics".into(), rate },
        values: (0..instants).map(|k| values(f64::from(k) / 12e3)).collect(),
    };
    Recording {
        about: About {
            scenario: "small".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into(), "load".into()],
            overrides: vec![],
        },
        rate,
        channels: vec![channel("motor.position", &f64::sin), channel("load.position", &f64::exp)],
        moves: vec![Move {
            label: "move to 1 m, order 3".into(),
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
        calls: vec![],
        limit_reversals: vec![],
        log: vec![],
        coupling: None,
    }
}

fn written(recording: &Recording, path: &Path) -> Vec<u8> {
    recording.write_parquet(path).unwrap();
    fs::read(path).unwrap()
}

proptest! {
    #[test]
    fn every_recording_comes_back_to_the_bit(recording in any_recording()) {
        let folder = tempfile::tempdir().unwrap();
        let (one, two) = (folder.path().join("one.parquet"), folder.path().join("two.parquet"));
        let bytes = written(&recording, &one);
        assert_same(&Recording::read_parquet(&one).unwrap(), &recording);
        prop_assert_eq!(written(&recording.clone(), &two), bytes, "same recording, other bytes");
        prop_assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is left beside the files");
    }

    #[test]
    fn foreign_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let folder = tempfile::tempdir().unwrap();
        for (ends, name) in [(&b""[..], "bare"), (b"PAR1", "framed")] {
            let path = folder.path().join(name);
            fs::write(&path, [ends, &bytes, ends].concat()).unwrap();
            let refused = Recording::read_parquet(&path).unwrap_err();
            prop_assert!(matches!(refused, TraceError::NotParquet { .. } | TraceError::Missing { .. }), "{}", refused);
        }
    }
}

/// Two axes in one file need nothing that one with a name does not.
#[test]
fn channels_of_axes_with_names_are_found_by_both_of_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    let unnamed = small(20);
    let mut recording = unnamed.clone();
    for channel in &mut recording.channels {
        channel.spec.axis = Some("x".parse().unwrap());
    }
    recording.write_parquet(&path).unwrap();
    let read = Recording::read_parquet(&path).unwrap();
    assert_same(&read, &recording);
    assert_eq!(columns(&path), ["time", "x.motor.position", "x.load.position"]);
    assert_eq!((read.axis().unwrap().as_str(), unnamed.axis()), ("x", None));
    assert_eq!((read.title().as_str(), unnamed.title().as_str()), ("small (axis x) on exact", "small on exact"));
    for name in ["load.position", "x.load.position"] {
        assert_eq!(read.channel(name), unnamed.channel("load.position"), "{name}");
    }
    assert_eq!(unnamed.channel("x.load.position"), None);
    assert_eq!((read.channel("y.load.position"), read.channel("x.x.load.position")), (None, None));

    let second = unnamed.channels.iter().cloned().map(|mut channel| {
        channel.spec.axis = Some("y".parse().unwrap());
        channel.values.to_mut().reverse();
        channel
    });
    recording.channels.extend(second);
    recording.write_parquet(&path).unwrap();
    let read = Recording::read_parquet(&path).unwrap();
    assert_same(&read, &recording);
    assert_eq!((read.axis(), read.channel("load.position")), (None, None), "of which axis?");
    assert_ne!(read.channel("x.load.position"), read.channel("y.load.position"));
    assert_eq!(read.channel("x.load.position"), unnamed.channel("load.position"));
}

/// Names of the columns of a file.
fn columns(path: &Path) -> Vec<String> {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    schema.columns().iter().map(|column| column.name().to_owned()).collect()
}

/// Recordings of builds before this one were compressed by zstd. Values by hand: 10 m/s² from rest for 10 ms, then −10 m/s².
#[test]
fn a_recording_of_an_older_build_is_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/zstd.parquet");
    let recording = Recording::read_parquet(path).unwrap();
    let (position, velocity) =
        (recording.channel("load.position").unwrap(), recording.channel("load.velocity").unwrap());
    assert_eq!((recording.rate.hertz(), position.len()), (1000, 21));
    for (k, (position, velocity)) in position.iter().zip(velocity).enumerate() {
        let (t, rest) = (k as f64 * 1e-3, (20.0 - k as f64) * 1e-3);
        let (x, v) = if k <= 10 { (5.0 * t * t, 10.0 * t) } else { (1e-3 - 5.0 * rest * rest, 10.0 * rest) };
        assert!((position - x).abs() < 1e-15 && (velocity - v).abs() < 1e-13, "{k}: {position} {velocity}");
    }
}

/// Several row groups, the last one short.
#[test]
fn more_instants_than_a_row_group() {
    let (recording, folder) = (small(300_000), tempfile::tempdir().unwrap());
    let path = folder.path().join("run.parquet");
    recording.write_parquet(&path).unwrap();
    assert_same(&Recording::read_parquet(&path).unwrap(), &recording);
}

/// Each byte in turn is changed, and the file is cut at each length: every one of them is refused, none panics.
#[test]
fn a_damaged_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    let bytes = written(&small(50), &path);
    let mut file = fs::OpenOptions::new().write(true).open(&path).unwrap();
    let mut put = |index: usize, byte: u8| {
        file.seek(SeekFrom::Start(index as u64)).unwrap();
        file.write_all(&[byte]).unwrap();
    };
    for (index, byte) in bytes.iter().enumerate() {
        for flip in [0x01, 0x10, 0x80, 0xff] {
            put(index, byte ^ flip);
            assert!(Recording::read_parquet(&path).is_err(), "byte {index} changed by {flip:#x}");
        }
        put(index, *byte);
    }
    assert!(Recording::read_parquet(&path).is_ok(), "the test must have put every byte back");
    for len in (0..bytes.len()).rev() {
        file.set_len(len as u64).unwrap();
        assert!(Recording::read_parquet(&path).is_err(), "cut to {len} bytes");
    }
}

#[test]
fn a_channel_that_cannot_be_a_column_is_named_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.parquet");
    let refusal = |change: fn(&mut Recording)| {
        let mut recording = small(10);
        change(&mut recording);
        recording.write_parquet(&path).unwrap_err().to_string()
    };
    assert_eq!(
        refusal(|recording| recording.channels[1].spec.name = "motor.position".into()),
        "channel `motor.position` cannot be written: the name is taken by another channel; every channel needs its own name"
    );
    assert_eq!(
        refusal(|recording| recording.channels[0].spec.name = "time".into()),
        "channel `time` cannot be written: the name is taken by the column of instants; every channel needs its own name"
    );
    assert_eq!(
        refusal(|recording| recording.channels[1].values.to_mut().truncate(9)),
        "channel `load.position` has 9 values where the first channel has 10; all channels are sampled together"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_missing_folder_or_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none/run.parquet");
    let message = small(1).write_parquet(&path).unwrap_err().to_string();
    assert!(message.starts_with("cannot create `") && message.contains("none"), "{message}");
    let message = Recording::read_parquet(&path).unwrap_err().to_string();
    assert!(message.starts_with(&format!("cannot read `{}`: ", path.display())), "{message}");
}

/// A Parquet file that is none of ours, made here with the bare writer.
#[test]
fn a_foreign_parquet_file_is_told_what_it_lacks() {
    use parquet::file::properties::WriterProperties;
    use parquet::file::{metadata::KeyValue, writer::SerializedFileWriter};
    use parquet::schema::parser::parse_message_type;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.parquet");
    let refusal = |keys: &[(&str, &str)]| {
        let schema = parse_message_type("message other { required double x; }").unwrap();
        let keys = keys.iter().map(|(key, value)| KeyValue::new((*key).into(), (*value).to_owned())).collect();
        let properties = WriterProperties::builder().set_key_value_metadata(Some(keys)).build();
        let file = fs::File::create(&path).unwrap();
        SerializedFileWriter::new(file, schema.into(), properties.into()).unwrap().close().unwrap();
        Recording::read_parquet(&path).unwrap_err()
    };
    let lacks = |missing: &str| format!("`{}` is not a recording of servobench: it lacks {missing}", path.display());
    assert_eq!(refusal(&[]).to_string(), lacks("the key `servobench.format` in its file metadata"));
    let format = ("servobench.format", "2");
    assert_eq!(refusal(&[format]).to_string(), lacks("the key `servobench.recording` in its file metadata"));
    let json = r#"{"scenario":"s","engine":"e","axis_unit":"m","bodies":[],"rate":1,"instants":0,"channels":[{"name":"y","unit":"m","writer":"w","rate":1}],"moves":[],"events":[],"signals":[]}"#;
    let keys = [format, ("servobench.recording", json)];
    assert_eq!(refusal(&keys).to_string(), lacks("the column `y` of type DOUBLE, without nulls"));
    for axis in ["", "a.b", "a\u{1b}[2J", "ä", &"a".repeat(10_000)] {
        let axis = serde_json::to_string(axis).unwrap();
        let json = json.replace(r#"{"name":"y""#, &format!(r#"{{"axis":{axis},"name":"y""#));
        let damage = refusal(&[format, ("servobench.recording", &json)]).to_string();
        assert!(damage.contains("cannot be read: the name of an axis ") && damage.len() < 400, "{damage}");
        assert!(!damage.contains('\u{1b}'), "{damage}");
    }
    let damage = refusal(&[format, ("servobench.recording", "{}")]).to_string();
    assert!(damage.contains("`servobench.recording` cannot be read: missing field `scenario`"), "{damage}");
    let format = ("servobench.format", "3");
    assert_eq!(refusal(&[format]).to_string(), lacks("the key `servobench.recording` in its file metadata"));
    for (other, what) in [("1", "older"), ("4", "newer"), ("", "of another kind")] {
        let error = refusal(&[("servobench.format", other)]);
        assert!(matches!(&error, TraceError::Format { found, .. } if found == other), "{error}");
        let message = error.to_string();
        assert!(message.contains(&format!("format `{other}`, {what}")) && message.contains("2 and 3"), "{message}");
    }
}
