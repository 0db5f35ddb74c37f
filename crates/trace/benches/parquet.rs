//! A recording of 20 channels and a million instants (62.5 s at 16 kHz), to disk and back, and thinned.
//! `cargo bench -p servobench-trace`
use divan::Bencher;
use divan::counter::BytesCount;
use servobench_base::Rate;
use servobench_trace::{About, ChannelSpec, Recorder, Recording};
use std::f64::consts::TAU;

const INSTANTS: u32 = 1_000_000;
const CHANNELS: u32 = 20;

fn main() {
    divan::main();
}

/// Damped oscillations of different frequencies: smooth and never repeating, as the signals of an axis are.
fn recording() -> Recording {
    let rate = Rate::new(16_000).expect("not zero");
    let spec =
        |k| ChannelSpec { axis: None, name: format!("channel.{k}"), unit: "m".into(), writer: "bench".into(), rate };
    let about = About {
        scenario: "bench".into(),
        engine: "none".into(),
        axis_unit: "m".into(),
        bodies: vec!["motor".into()],
        overrides: vec![],
    };
    let mut recorder = Recorder::new(about, rate, (0..CHANNELS).map(spec).collect(), INSTANTS as usize);
    let mut row = vec![0.0; CHANNELS as usize];
    for instant in 0..INSTANTS {
        let t = f64::from(instant) * rate.period();
        for (value, k) in row.iter_mut().zip(1..) {
            *value = f64::from(k) * (1.0 - (-t / 20.0).exp() * (TAU * f64::from(k) * t).cos());
        }
        recorder.push(&row);
    }
    recorder.finish().0
}

fn raw_size() -> BytesCount {
    BytesCount::of_many::<f64>((INSTANTS * CHANNELS) as usize)
}

#[divan::bench(sample_count = 5)]
fn write(bencher: Bencher) {
    let (recording, folder) = (recording(), tempfile::tempdir().expect("a temporary folder"));
    let path = folder.path().join("run.parquet");
    bencher.counter(raw_size()).bench(|| recording.write_parquet(&path).expect("writes"));
    let size = std::fs::metadata(&path).expect("was written").len();
    println!("{:.1} MB on disk for {:.1} MB of values", size as f64 / 1e6, f64::from(8 * INSTANTS * CHANNELS) / 1e6);
}

#[divan::bench(sample_count = 5)]
fn read(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("run.parquet");
    recording().write_parquet(&path).expect("writes");
    bencher.counter(raw_size()).bench(|| Recording::read_parquet(&path).expect("reads"));
}

#[divan::bench(sample_count = 5)]
fn envelope_of_all_channels(bencher: Bencher) {
    let recording = recording();
    let thinned = |k| recording.envelope(&format!("channel.{k}"), 2_000).map(|kept| kept.len());
    bencher.counter(raw_size()).bench(|| (0..CHANNELS).filter_map(thinned).sum::<usize>());
}
