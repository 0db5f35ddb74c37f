//! The blocks that a scenario describes and those that the bench executes are the same.
use crate::rig::run_bench;
use servobench_plant::Exact;
use servobench_scenario as scenario;
use servobench_sim::Bench;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Outputs that a condition of a scenario cannot name: numbers, and a state that an axis alone never has.
const NOT_IN_CONDITIONS: [&str; 15] = [
    "ErrorID",
    "AxisErrorID",
    "DriveCode",
    "CoveredDistance",
    "Position",
    "Velocity",
    "Torque",
    "SynchronizedMotion",
    "Simulation",
    "Value",
    "RecordedPosition",
    "Acceleration",
    "pref_add",
    "Jerk",
    "dJerk",
];

const BENCH: &str = r#"
[run]
base_rate = "16 kHz"
duration = "20 ms"
[axis]
model = "ball-screw"
modulo = "100 mm"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
[bus]
cycle = "1 ms"
[setpoint]
order = 4
velocity = "1 m/s"
acceleration = "20 m/s2"
jerk = "1000 m/s3"
snap = "100000 m/s4"
"#;

/// Something to say for an input of `block`.
fn said(block: &str, input: &str) -> String {
    let value = match input {
        "position" | "distance" | "position_offset" | "first_position" => "\"10 mm\"",
        "velocity" | "velocity_difference" | "velocity_offset" | "value" => "\"0.1 m/s\"",
        "end_velocity" => "\"0.05 m/s\"",
        "acceleration" | "deceleration" | "acceleration_offset" => "\"2 m/s2\"",
        "jerk" | "deceleration_jerk" => "\"100 m/s3\"",
        "move_type" => "\"incremental\"",
        "shape" => "\"s-curve\"",
        // Other ways to say the same.
        key if key.contains("jerk_of_") || key.contains("jerk_time") => return String::new(),
        "snap" => "\"10000 m/s4\"",
        "direction" => "\"positive\"",
        "buffer_mode" => "\"aborting\"",
        "torque" | "torque_limit" => "\"0.1 Nm\"",
        "torque_tolerance" => "\"0.01 Nm\"",
        "detection_velocity_limit" => "\"1 mm/s\"",
        "detection_velocity_time" | "time_limit" => "\"1 s\"",
        "distance_limit" => "\"10 mm\"",
        "torque_ramp" => "\"1 Nm/s\"",
        "velocity_factor" | "acceleration_factor" | "jerk_factor" | "time_scale" | "value_scale" => "0.5",
        "continuous_update" | "relative" | "reversed" | "enable_positive" | "enable_negative" | "bool_value" => "true",
        "settling_time" => "\"50 ms\"",
        "parameter" => "\"max-velocity-appl\"",
        "bool_parameter" => "\"enable-limit-pos\"",
        "input_number" | "output_number" => "2",
        "trigger_input" => "\"index-pulse\"",
        "last_position" => "\"20 mm\"",
        "switches" => {
            "[{ track = 0, first = \"90 mm\", last = \"10 mm\" }, { track = 1, first = \"20 mm\", duration = \"5 ms\" }]"
        }
        "track_options" => {
            "[{ track = 1, on_compensation = \"-1 ms\", off_compensation = \"1 ms\", hysteresis = \"1 mm\" }]"
        }
        "value_source" => "\"actual\"",
        "enable_mask" | "order" => "3",
        "table" => return format!("table = {{ file = \"{block}.csv\" }}\n"),
        other => panic!("{block}.{other} is an input that nobody knows here"),
    };
    format!("{input} = {value}\n")
}

/// Each block of the schema, with all its inputs, in one program: the recording has a signal for what triggers it and for each of
/// its outputs, and no others.
#[test]
fn every_block_has_the_trigger_the_inputs_and_the_outputs_that_the_scenario_knows() {
    let schema = scenario::json_schema();
    let blocks = schema["properties"]["call"]["items"]["properties"]["block"]["oneOf"].as_array().unwrap();
    assert!(blocks.len() >= 23, "{}", blocks.len());
    let words = |block: &serde_json::Value, key: &str| -> Vec<String> {
        block[key].as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
    };
    let mut text = BENCH.to_owned();
    for block in blocks {
        let name = block["const"].as_str().unwrap();
        write!(text, "[[call]]\nblock = \"{name}\"\nname = \"{name}\"\nstart = {{ at = \"5 ms\" }}\n").unwrap();
        text.extend(words(block, "x-inputs").iter().map(|input| said(name, input)));
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, quantity) in [
        ("MC_PositionProfile", "position [mm]"),
        ("MC_VelocityProfile", "velocity [mm/s]"),
        ("MC_AccelerationProfile", "acceleration [mm/s2]"),
    ] {
        std::fs::write(folder.path().join(format!("{name}.csv")), format!("time [ms],{quantity}\n100,1\n200,0\n"))
            .unwrap();
    }
    let path = folder.path().join("blocks.toml");
    std::fs::write(&path, text).unwrap();
    let loaded = scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let recording = run_bench(Bench::new(&loaded.scenario, &Exact).unwrap_or_else(|error| panic!("{error}")));
    for block in blocks {
        let name = block["const"].as_str().unwrap();
        let signals = recording.signals.iter().filter(|signal| signal.source == name);
        let signals: BTreeSet<_> = signals.map(|signal| signal.name.clone()).collect();
        let mut described: BTreeSet<_> = words(block, "x-outputs").into_iter().collect();
        described.insert(block["x-trigger"].as_str().unwrap().to_owned());
        assert!(described.is_subset(&signals), "{name}: {described:?} {signals:?}");
        let others: Vec<_> = signals.difference(&described).collect();
        assert!(others.iter().all(|other| NOT_IN_CONDITIONS.contains(&other.as_str())), "{name}: {others:?}");
    }
}
