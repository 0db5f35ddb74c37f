//! A recording on its way from a worker: a file without a name, which both have open.
//!
//! ```text
//! length of the header (u64, little endian)
//! header (JSON): all of the recording but the values
//! values of each channel (f64, little endian)
//! ```
//! This is not the format of permanent recordings: nothing is compressed or sealed, so that passing one on costs as much as copying it.
use servobench_base::Rate;
use servobench_trace::{
    About, Call, Channel, ChannelSpec, CouplingEstimate, Event, GrowingValues, LimitReversals, LogEntry, Move,
    Recording, Signal, Values,
};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};

/// Values that are converted at a time.
const CHUNK: usize = 1 << 13;
/// Largest header (B): messages of a worker are not trusted.
const LONGEST_HEADER: u64 = 1 << 32;

/// Its origin: scenario, engine, unit of the axis, bodies, overrides.
type AboutParts = (String, String, String, Vec<String>, Vec<String>);
/// Its events.
type Happened =
    (Vec<Move>, Vec<Event>, Vec<Signal>, Vec<Call>, Vec<LimitReversals>, Vec<LogEntry>, Option<CouplingEstimate>);
/// All but the values, with the number of instants.
type Header = (AboutParts, Rate, usize, Vec<ChannelSpec>, Happened);

/// Writes `recording` into `file` in place of the present content.
pub(super) fn write(recording: &Recording, file: &mut File) -> io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    let Recording { about, rate, channels, moves, events, signals, calls, limit_reversals, log, coupling } = recording;
    let About { scenario, engine, axis_unit, bodies, overrides } = about;
    let specs: Vec<&ChannelSpec> = channels.iter().map(|channel| &channel.spec).collect();
    let happened = (moves, events, signals, calls, limit_reversals, log, coupling);
    let header = ((scenario, engine, axis_unit, bodies, overrides), rate, recording.len(), specs, happened);
    let header = serde_json::to_vec(&header)?;
    let mut out = BufWriter::with_capacity(1 << 18, file);
    out.write_all(&(header.len() as u64).to_le_bytes())?;
    out.write_all(&header)?;
    let mut bytes = Vec::with_capacity(CHUNK * size_of::<f64>());
    for channel in channels {
        for values in channel.values.chunks(CHUNK) {
            bytes.clear();
            bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
            out.write_all(&bytes)?;
        }
        channel.values.release();
    }
    out.flush()
}

/// Reads what [`write`] wrote.
pub(super) fn read(file: &mut File) -> io::Result<Recording> {
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(0))?;
    let mut file = BufReader::with_capacity(1 << 18, file);
    let mut size = [0; 8];
    file.read_exact(&mut size)?;
    let size = u64::from_le_bytes(size);
    let too_long = || io::Error::new(io::ErrorKind::InvalidData, "its header says that it is longer than it is");
    if size > length.min(LONGEST_HEADER) {
        return Err(too_long());
    }
    let mut header = Vec::new();
    (&mut file).take(size).read_to_end(&mut header)?;
    let header: Header = serde_json::from_slice(&header)?;
    let ((scenario, engine, axis_unit, bodies, overrides), rate, instants, specs, happened) = header;
    let (moves, events, signals, calls, limit_reversals, log, coupling) = happened;
    let values = (specs.len() as u64).checked_mul(instants as u64).and_then(|values| values.checked_mul(8));
    if values.and_then(|values| values.checked_add(size + 8)) != Some(length) {
        return Err(too_long());
    }
    let channels = specs.into_iter().map(|spec| Ok(Channel { spec, values: values_of(&mut file, instants)? }));
    let channels = channels.collect::<io::Result<_>>()?;
    let about = About { scenario, engine, axis_unit, bodies, overrides };
    Ok(Recording { about, rate, channels, moves, events, signals, calls, limit_reversals, log, coupling })
}

fn values_of(file: &mut impl Read, count: usize) -> io::Result<Values> {
    let mut values = GrowingValues::with_room(count);
    let mut bytes = vec![0; CHUNK.min(count) * size_of::<f64>()];
    while values.len() < count {
        let chunk = &mut bytes[..CHUNK.min(count - values.len()) * size_of::<f64>()];
        file.read_exact(chunk)?;
        values.extend_from(chunk.as_chunks::<8>().0.iter().map(|value| f64::from_le_bytes(*value)))?;
    }
    values.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(instants: usize) -> Recording {
        let about = About {
            scenario: "µ \"x\"\n".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into(), "load".into()],
            overrides: vec!["run.duration=1 s".into()],
        };
        let rate = Rate::new(16_000).unwrap();
        let channel = |name: &str, value: fn(usize) -> f64| Channel {
            spec: ChannelSpec { axis: None, name: name.into(), unit: "m".into(), writer: "mechanics".into(), rate },
            values: (0..instants).map(value).collect(),
        };
        let channels = vec![
            channel("load.position", |k| (k as f64 * 0.1).sin() / 3.0),
            channel("load.velocity", |k| [f64::NAN, f64::INFINITY, -0.0, f64::MIN_POSITIVE / 2.0][k % 4]),
        ];
        let events = vec![Event::new(0.1 + 0.2, f64::INFINITY, "drive", "it said \"no\"")];
        let signals =
            vec![Signal { source: "axis".into(), name: "state".into(), changes: vec![(1e-300, "on".into())] }];
        Recording { channels, events, signals, ..Recording::new(about, rate) }
    }

    #[test]
    fn every_bit_arrives() {
        let mut file = tempfile::tempfile().unwrap();
        for instants in [100_000, 0, 1, CHUNK, CHUNK + 1] {
            let sent = recording(instants);
            write(&sent, &mut file).unwrap();
            let arrived = read(&mut file).unwrap();
            for (sent, arrived) in sent.channels.iter().zip(&arrived.channels) {
                assert!(sent.values.iter().map(|v| v.to_bits()).eq(arrived.values.iter().map(|v| v.to_bits())));
            }
            let without_values = |mut recording: Recording| {
                recording.channels.iter_mut().for_each(|channel| channel.values.to_mut().clear());
                recording
            };
            assert_eq!(without_values(arrived), without_values(sent));
        }
    }

    #[test]
    fn what_is_not_whole_is_none() {
        let mut file = tempfile::tempfile().unwrap();
        write(&recording(100), &mut file).unwrap();
        let whole = file.metadata().unwrap().len();
        for length in [0, 7, 8, 100, whole - 1, whole + 1] {
            write(&recording(100), &mut file).unwrap();
            file.set_len(length).unwrap();
            assert!(read(&mut file).is_err(), "{length}");
        }
        file.set_len(0).unwrap();
        file.rewind().unwrap();
        file.write_all(&[0xff; 1000]).unwrap();
        assert!(read(&mut file).is_err());
    }
}
