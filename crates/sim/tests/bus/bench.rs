//! Scenarios run on the exact engine, and what their recordings say.
use servobench_plant::Exact;
use servobench_scenario as scenario;
use servobench_sim::{Bench, Outcome};
use servobench_trace::Recording;

/// A feed axis under a stiff drive; set-points, bus and program are to be given.
pub(crate) const SCREW: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
dc_link = "320 V"
max_torque = "6.09 Nm"
[drive.feedforward]
friction = true
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "100 m/s3"
snap = "5000 m/s4"
"#;

/// After 0.1 s a move to 250 mm.
pub(crate) const MOVE: &str = "[[program]]\nwait = \"0.1 s\"\n[[program]]\nmove_to = \"250 mm\"\n";

/// A bus of 1 ms whose master feeds forward.
pub(crate) const BUS: &str = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\neffort_offset = \"rigid\"\n";

pub(crate) fn run(text: &str) -> Recording {
    let parsed = scenario::parse("bus", text, None).unwrap_or_else(|error| panic!("{error}"));
    let bench = Bench::new(&parsed.scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
    let Outcome { recording, failure } = bench.run(&mut |_| {});
    assert_eq!(failure, None);
    recording
}

pub(crate) fn values<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    recording.channel(name).unwrap_or_else(|| panic!("no channel {name}"))
}

pub(crate) fn last(recording: &Recording, name: &str) -> f64 {
    values(recording, name).last().copied().unwrap_or_default()
}

pub(crate) fn peak(recording: &Recording, name: &str) -> f64 {
    values(recording, name).iter().fold(0.0, |peak, value| value.abs().max(peak))
}

/// The changes of a signal, without their times.
pub(crate) fn states<'a>(recording: &'a Recording, source: &str, name: &str) -> Vec<&'a str> {
    let signal = recording.signal(source, name).unwrap_or_else(|| panic!("no signal {source}.{name}"));
    signal.changes.iter().map(|(_, value)| value.as_str()).collect()
}

/// When a signal first has a value (s).
pub(crate) fn when(recording: &Recording, source: &str, name: &str, value: &str) -> f64 {
    let signal = recording.signal(source, name).unwrap_or_else(|| panic!("no signal {source}.{name}"));
    let change = signal.changes.iter().find(|(_, found)| found == value);
    change.unwrap_or_else(|| panic!("{source}.{name} is never {value}: {:?}", signal.changes)).0
}

/// The largest change of a channel within `seconds`.
pub(crate) fn steepest(recording: &Recording, name: &str, seconds: f64) -> f64 {
    let (values, ticks) = (values(recording, name), recording.index_at(seconds));
    let changes = values.iter().zip(&values[ticks..]).map(|(before, after)| (after - before).abs());
    changes.fold(0.0, f64::max)
}
