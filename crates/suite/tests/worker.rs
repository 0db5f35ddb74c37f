//! The worker's side, called as a process would call it: what it says is what the same run here says of itself.
use servobench_metrics::Quantity;
use servobench_plant::{EngineName, Exact};
use servobench_suite::worker::{End, Order, serve};
use servobench_suite::{Engines, Source, WorkerCommand, execute, jobs};
use servobench_trace::Recording;
use std::path::Path;

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

/// With a bandwidth of 2 MHz at a rate of 1 kHz the axis leaves the finite numbers. The limit on jerk is not used: a
/// warning.
const WILD: &str = r#"
[run]
base_rate = "1 kHz"
duration = "2 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "1 kHz"
bandwidth = "2 MHz"
[drive.position]
rate = "1 kHz"
gain = "20 1/s"
[setpoint]
order = 2
velocity = "1 m/s"
acceleration = "1 m/s2"
jerk = "1 m/s3"
[[program]]
move_to = "10 mm"
"#;

fn order(folder: &Path) -> Order {
    Order {
        name: "wild".into(),
        path: None,
        overrides: vec![],
        engine: EngineName::Exact,
        durations: vec![],
        recording: Some(folder.join("wild.parquet")),
    }
}

/// How it ended, which is what it said last.
fn served(order: &Order, text: &str) -> End {
    let mut out = Vec::new();
    let end = serve(order, text, &ENGINES, &mut out);
    let said = String::from_utf8(out).unwrap();
    let last: serde_json::Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
    let expected = match &end {
        End::Done => serde_json::json!({ "end": "done" }),
        End::Input(why) => serde_json::json!({ "end": { "input": why } }),
        End::Diverged { time, reason } => {
            serde_json::json!({ "end": { "diverged": { "time": time, "reason": reason } } })
        }
        End::GaveUp(why) => serde_json::json!({ "end": { "gaveup": why } }),
        End::Failed(why) => serde_json::json!({ "end": { "failed": why } }),
    };
    assert_eq!(last, expected);
    end
}

#[test]
fn a_reason_and_a_recording_do_not_depend_on_where_the_run_happened() {
    let folder = tempfile::tempdir().unwrap();
    let scenario =
        servobench_scenario::parse("wild.toml", WILD, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let job = &jobs(vec![Source { scenario, text: WILD.into() }], &[])[0];
    let nowhere = WorkerCommand { program: "none".into(), folder: "none".into(), timeout: std::time::Duration::ZERO };
    let run = execute(job, &ENGINES, &nowhere, &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    let reasons: Vec<String> = run.verdict.reasons().collect();

    let order = order(folder.path());
    let End::Diverged { time, reason } = served(&order, WILD) else { panic!("it diverges") };
    let told = format!("bounded: the run diverged at {}: {reason}", Quantity::new(time, "s"));
    assert!(reasons.contains(&told), "{told}: {reasons:?}");
    let own = folder.path().join("here.parquet");
    run.recording.write_parquet(&own).unwrap();
    assert!(std::fs::read(own).unwrap() == std::fs::read(order.recording.unwrap()).unwrap(), "up to where it came");
}

#[test]
fn a_run_that_comes_to_its_end_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let order = Order { durations: vec![1.5], ..order(folder.path()) };
    assert_eq!(served(&order, &WILD.replace("2 MHz", "20 Hz")), End::Done);
    let recording = Recording::read_parquet(order.recording.as_deref().unwrap()).unwrap();
    assert!((recording.moves[0].end - 1.5).abs() < 1e-12 && recording.about.scenario == "wild");
}

/// Oracle: the same run in this process.
#[test]
fn overrides_reach_the_worker() {
    let folder = tempfile::tempdir().unwrap();
    let overrides =
        vec!["drive.velocity.bandwidth=20 Hz".parse().unwrap(), "program[0].move_to='5 mm'".parse().unwrap()];
    let order = Order { overrides: overrides.clone(), ..order(folder.path()) };
    assert_eq!(served(&order, WILD), End::Done);
    let recording = Recording::read_parquet(order.recording.as_deref().unwrap()).unwrap();
    assert_eq!(recording.about.overrides, ["drive.velocity.bandwidth=20 Hz", "program[0].move_to='5 mm'"]);
    let loaded = servobench_scenario::parse_with("wild.toml", WILD, None, &overrides);
    let scenario = loaded.unwrap_or_else(|error| panic!("{error}")).scenario;
    let job = &jobs(vec![Source { scenario, text: WILD.into() }], &[])[0];
    let nowhere = WorkerCommand { program: "none".into(), folder: "none".into(), timeout: std::time::Duration::ZERO };
    let run = execute(job, &ENGINES, &nowhere, &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    assert_eq!(recording, run.recording);
    assert!((recording.moves[0].to - 5e-3).abs() < 1e-15, "{:?}", recording.moves[0]);
}

#[test]
fn wrong_input_is_told_apart_from_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    let end = served(&order(folder.path()), &WILD.replace("20 kg", "-20 kg"));
    assert!(matches!(&end, End::Input(why) if why.contains("wild.toml:8:8")), "{end:?}");
    // A move cannot be made in a hundredth of the time that its limits take.
    let end = served(&Order { durations: vec![0.002], ..order(folder.path()) }, WILD);
    assert!(matches!(&end, End::Input(why) if why.contains("`duration`")), "{end:?}");
    let end = served(&Order { engine: EngineName::Rapier, ..order(folder.path()) }, WILD);
    assert!(matches!(&end, End::Failed(why) if why.contains("--features rapier")), "{end:?}");
}

/// The move cannot be made in 2 ms; nothing runs to find that out.
#[test]
fn without_a_recording_the_scenario_is_only_checked() {
    let order = Order { durations: vec![0.002], recording: None, ..order("none".as_ref()) };
    let mut out = Vec::new();
    assert_eq!(serve(&order, WILD, &ENGINES, &mut out), End::Done);
    let lines: Vec<serde_json::Value> =
        String::from_utf8(out).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [said, end] = &lines[..] else { panic!("{lines:?}") };
    assert_eq!(end, &serde_json::json!({ "end": "done" }));
    let [objection] = &said["objections"].as_array().unwrap()[..] else { panic!("{said}") };
    assert_eq!(objection["key"], "program.0");
    assert!(objection["message"].as_str().unwrap().contains("`duration` must be at least"), "{objection}");
}
