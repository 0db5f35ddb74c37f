//! The worker's side, called as a process would call it: its messages are the results of the same run in this process.
#![cfg(unix)]
use servobench::Engines;
use servobench_metrics::Quantity;
use servobench_plant::Exact;
use servobench_suite::worker::{End, Order, Task, answer};
use servobench_suite::{Source, Workers, execute, jobs};
use std::time::Duration;

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

fn order(text: &str) -> Order {
    Order {
        name: "wild".into(),
        path: None,
        root: None,
        text: text.into(),
        overrides: vec![],
        engine: "exact".into(),
        durations: vec![],
        task: Task::Run { time_limit: None, records_all: true },
    }
}

/// Its end, which is its last message.
fn served(order: &Order) -> End {
    answered(order).0
}

/// The same, and all of its messages.
fn answered(order: &Order) -> (End, Vec<serde_json::Value>) {
    let mut out = Vec::new();
    let end = answer(order, &mut tempfile::tempfile().unwrap(), &ENGINES, &mut out);
    let said: Vec<serde_json::Value> =
        String::from_utf8(out).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let expected = match &end {
        End::Done => serde_json::json!({ "end": "done" }),
        End::Input(why) => serde_json::json!({ "end": { "input": why } }),
        End::Diverged { time, reason } => {
            serde_json::json!({ "end": { "diverged": { "time": time, "reason": reason } } })
        }
        End::GaveUp(why) => serde_json::json!({ "end": { "gaveup": why } }),
        End::Stopped(time) => serde_json::json!({ "end": { "stopped": time } }),
        End::Failed(why) => serde_json::json!({ "end": { "failed": why } }),
    };
    assert_eq!(said.last().unwrap(), &expected);
    (end, said)
}

#[test]
fn a_reason_does_not_depend_on_where_the_run_happened() {
    let scenario =
        servobench_scenario::parse("wild.toml", WILD, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let job = &jobs(vec![Source { scenario, text: WILD.into() }], &[])[0];
    let run = execute(job, &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    let reasons: Vec<String> = run.verdict.reasons().collect();
    let End::Diverged { time, reason } = served(&order(WILD)) else { panic!("it diverges") };
    let told = format!("bounded: the run diverged at {}: {reason}", Quantity::new(time, "s"));
    assert!(reasons.contains(&told), "{told}: {reasons:?}");
}

#[test]
fn a_run_that_reaches_its_limit_of_time_says_how_far_it_came() {
    let endless = WILD.replace("2 MHz", "20 Hz").replace("2 s", "1e6 s") + "[record]\nrate = \"1 Hz\"\n";
    let task = Task::Run { time_limit: Some(Duration::from_millis(100)), records_all: true };
    let End::Stopped(time) = served(&Order { task, ..order(&endless) }) else { panic!("it is stopped") };
    assert!(time < 1e6, "{time}");
}

#[test]
fn wrong_input_is_told_apart_from_a_failure() {
    let end = served(&order(&WILD.replace("20 kg", "-20 kg")));
    assert!(matches!(&end, End::Input(why) if why.contains("wild.toml:8:8")), "{end:?}");
    // A move cannot be made in a hundredth of the time that its limits take.
    let end = served(&Order { durations: vec![0.002], ..order(WILD) });
    assert!(matches!(&end, End::Input(why) if why.contains("`duration`")), "{end:?}");
    let end = served(&Order { engine: "rapier".into(), ..order(WILD) });
    assert!(matches!(&end, End::Failed(why) if why.contains("--features rapier")), "{end:?}");
}

/// The move cannot be made in 2 ms; nothing runs to find that out.
#[test]
fn what_is_only_checked_does_not_run() {
    let (end, said) = answered(&Order { durations: vec![0.002], task: Task::Check, ..order(WILD) });
    assert_eq!(end, End::Done);
    let [said, holds, _] = &said[..] else { panic!("{said:?}") };
    assert!(holds["holds"].as_u64().is_some());
    let [objection] = &said["objections"].as_array().unwrap()[..] else { panic!("{said}") };
    assert_eq!(objection["key"], "program.0");
    assert!(objection["message"].as_str().unwrap().contains("`duration` must be at least"), "{objection}");
}
