//! Scenarios run on the exact engine, and what their recordings have.
use servobench_plant::Exact;
use servobench_scenario::{Document, Scenario};
use servobench_sim::{Bench, Outcome};
use servobench_trace::Recording;
use std::path::Path;

/// A ball screw under a stiff drive; feedforward may go on, set-points, bus and program are to be given.
macro_rules! axis {
    () => {
        r#"
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
"#
    };
}
pub(crate) use axis;

/// The same with set-points of order 4.
pub(crate) const SCREW: &str = concat!(
    axis!(),
    "[setpoint]\norder = 4\nvelocity = \"30 m/min\"\nacceleration = \"5 m/s2\"\njerk = \"100 m/s3\"\nsnap = \"5000 m/s4\"\n"
);

/// The scenario `text` for `duration`.
pub(crate) fn lasting(text: &str, duration: &str) -> String {
    text.replace("[run]\n", &format!("[run]\nduration = \"{duration}\"\n"))
}

/// The feed axis with these keys of its own, for `duration`.
pub(crate) fn screw_with(keys: &str, duration: &str) -> String {
    let model = "model = \"ball-screw\"\n";
    lasting(SCREW, duration).replace(model, &format!("{model}{keys}\n"))
}

/// After 0.1 s a move to 250 mm.
pub(crate) const MOVE: &str = "[[program]]\nwait = \"0.1 s\"\n[[program]]\nmove_to = \"250 mm\"\n";

/// A bus of 1 ms whose master feeds forward.
pub(crate) const BUS: &str = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\neffort_offset = \"rigid\"\n";

/// The scenario `text`, whose files are those of `scenarios/plc`.
pub(crate) fn scenario(text: &str) -> Scenario {
    scenario_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc"), text)
}

/// The scenario `text`, whose files are in `folder`.
pub(crate) fn scenario_in(folder: &Path, text: &str) -> Scenario {
    let loaded =
        Document::parse("test", text, Some(folder), Some(Path::new("/"))).and_then(|document| document.scenario(&[]));
    loaded.unwrap_or_else(|error| panic!("{error}\n{text}")).scenario
}

/// The reason why no bench is built of `text`.
pub(crate) fn refusal(text: &str) -> String {
    Bench::new(&scenario(text), &Exact).err().map(|error| error.to_string()).unwrap_or_default()
}

pub(crate) fn bench(text: &str) -> Bench {
    Bench::new(&scenario(text), &Exact).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn run(text: &str) -> Recording {
    run_bench(bench(text))
}

/// A run that does not fail.
pub(crate) fn run_bench(bench: Bench) -> Recording {
    let Outcome { recording, failure } = bench.run(&mut |_| {});
    assert_eq!(failure, None);
    recording
}

/// The text of the file `name` of `scenarios/plc`, with something else in the place of what it says.
pub(crate) fn text_of(name: &str, changes: &[(&str, &str)]) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc").join(name);
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}"));
    changes.iter().fold(text, |text, (said, instead)| {
        assert_eq!(text.matches(said).count(), 1, "{said}");
        text.replace(said, instead)
    })
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
