//! Checks the defaults in the reference: a file in which a key has its documented default means the same as one without the key.
use serde_json::Value as Json;
use servobench_scenario::{Scenario, json_schema, parse};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A key by its path, with `[]` after a list of tables, and its default.
type Defaults = BTreeMap<String, Value>;

/// An axis with tables that are in no scenario of the repository.
const MORE: &str = r#"
[run]
base_rate = "16 kHz"
duration = "1 s"
[axis]
motion = "linear"
[axis.load]
mass = "10 kg"
[axis.switches.home]
from = "-10 mm"
to = "10 mm"
[motor]
kind = "ideal-source"
mass = "20 kg"
[drive]
max_force = "300 N"
[drive.velocity]
rate = "4 kHz"
bandwidth = "20 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "5 Hz"
[setpoint]
order = 3
velocity = "0.1 m/s"
acceleration = "1 m/s2"
jerk = "10 m/s3"
[[disturbance]]
on = "load"
force = "3 N"
[bus]
cycle = "1 ms"
motion_cycle = "4 ms"
[bus.units]
drive = 1
axis = "1 um"
[[bus.fault]]
kind = "lost"
"#;

/// Added programs: one of moves, one of function blocks. For an FMU any file will do, as only a run opens it.
const PROGRAMS: [&str; 2] = [
    r#"
[setpoint.shaper]
kind = "ei"
frequency = "20 Hz"
[[program]]
move_to = "50 mm"
shaper = { kind = "ei", frequency = "20 Hz" }
[[program]]
table = { file = "scenarios/setpoints/points.csv", relative = true, velocities = "smooth" }
[[program]]
table = { file = "scenarios/setpoints/points.csv", relative = true, follow = "plateaus" }
shaper = { kind = "none" }
[coupling]
method = "iterated"
[[fmu]]
file = "README.md"
[fmu.inputs]
u = "load.position"
[fmu.outputs]
y = "disturbance.load"
"#,
    r#"
[[call]]
block = "MC_Power"
[[call]]
block = "MC_PositionProfile"
start = { after = "MC_Power_0.Status" }
table = { file = "scenarios/setpoints/points.csv", relative = true, follow = "plateaus" }
[[call]]
block = "MC_DigitalCamSwitch"
switches = [{ track = 0, first = "10 mm", last = "20 mm" }]
track_options = [{ track = 0 }]
"#,
];

/// An axis whose mechanics are an FMU.
const OF_FMU: &str = r#"
[run]
base_rate = "16 kHz"
duration = "1 s"
[axis]
motion = "rotary"
[axis.fmu]
file = "README.md"
inputs.tau = "effort.motor"
outputs.phi = "shaft.position"
outputs.w = "shaft.velocity"
outputs.load = { position = "load.position", velocity = "load.velocity" }
[motor]
kind = "prescribed"
"#;

/// A motor with every effect.
const OF_A_MOTOR: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[axis.motor_side]
inertia = "3 kg cm2"
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "1.615 Ohm"
inductance = "3.485 mH"
flux_linkage = "0.0606 V s"
max_current = "13.3 Arms"
[[motor.cogging]]
per_rev = 36
amplitude = "25 mNm"
[[motor.flux_harmonic]]
order = 6
[motor.saturation]
current = "20 Arms"
share = 0.9
[motor.iron_loss]
speed = "3000 rpm"
[motor.temperature]
winding = "80 degC"
[motor.thermal]
ambient = "40 degC"
to_housing = "0.6 K/W"
to_ambient = "1.1 K/W"
winding_capacity = "120 J/K"
housing_capacity = "1.6 kJ/K"
[drive]
model = "servo-16khz"
"#;

/// A synchronous motor under all blocks of the firmware.
const FIRMWARE: &str = r#"
[run]
base_rate = "16 kHz"
duration = "1 s"
[axis]
motion = "rotary"
[motor]
kind = "pmsm"
pole_pairs = 3
resistance = "3.6 Ohm"
inductance = "36 mH"
flux_linkage = "0.5 V s"
inertia = "0.005 kg m2"
max_current = "9 Apk"
[motor.connection]
open = "a"
[drive]
dc_link = "540 V"
gain_schedule = { from = "1 rad/s", to = "2 rad/s" }
i2t.motor = { continuous_current = "5 Apk", time_constant = "3 s" }
i2t.drive = { continuous_current = "5 Apk", peak_time = "3 s" }
[drive.current]
rate = "16 kHz"
bandwidth = "600 Hz"
dead_time_compensation = { dead_time = "2 us", frequency = "8 kHz" }
[drive.velocity]
rate = "8 kHz"
bandwidth = "20 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "5 Hz"
[[drive.filter]]
kind = "low-pass"
frequency = "700 Hz"
[[drive.filter]]
kind = "low-pass"
order = 2
frequency = "700 Hz"
[[drive.filter]]
kind = "notch"
frequency = "300 Hz"
[[drive.cogging]]
order = 12
amplitude = "0.02 Nm"
"#;

/// The same with the velocity measured by `method`, which has these `keys`.
fn measured_by(method: &str, keys: &str) -> String {
    let with = format!("bandwidth = \"20 Hz\"\nmeasurement = \"{method}\"\n{keys}");
    FIRMWARE.replace("bandwidth = \"20 Hz\"", &with)
}

/// Keys of a table of points that only moves use: no block chooses velocities by these rules.
const OF_MOVES: [&str; 2] = ["call[].table.passes", "call[].table.velocities"];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The value at the beginning of a description, if any: `false, they are wired normally open`, `10 s`, `"linear"`.
fn literal(words: &str, schema: &Json) -> Option<Value> {
    let words = words.split([';', ',']).next()?.split(". ").next()?.trim().trim_end_matches('.');
    let of = |text: &str| format!("x = {text}").parse::<Table>().ok()?.remove("x");
    let is_text = schema["type"] == "string";
    let quantity = |text: &str| {
        let example = schema["examples"][0].as_str()?;
        // A zero needs the unit of the key.
        let text = if text == "0" { format!("0 {}", example.split_once(' ')?.1) } else { text.to_owned() };
        let is_number = text.starts_with(|first: char| first.is_ascii_digit()) && !text.contains('/');
        is_number.then_some(Value::String(text))
    };
    if is_text && !words.starts_with('"') { quantity(words) } else { of(words) }
}

/// All defaults of the schema below `path`.
fn collect(schema: &Json, path: &str, defaults: &mut Defaults) {
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let default = value["description"].as_str().and_then(|words| words.split_once("default: "));
        if let Some(value) = default.and_then(|(_, words)| literal(words, value)) {
            defaults.insert(path.clone(), value);
        }
        collect(value, &path, defaults);
        collect(&value["items"], &format!("{path}[]"), defaults);
        value["oneOf"].as_array().into_iter().flatten().for_each(|one| collect(one, &path, defaults));
    }
}

/// The table of the key at `path`, the `nth` of several; a missing one is created. `None` in a table with a model, which may set the key.
fn place<'a>(table: &'a mut Table, path: &[&str], nth: &mut usize) -> Option<&'a mut Table> {
    let [first, rest @ ..] = path else { return None };
    if table.contains_key("model") {
        return None;
    }
    if rest.is_empty() {
        let is_it = *nth == 0;
        *nth = nth.wrapping_sub(1);
        return is_it.then_some(table);
    }
    if let Some(list) = first.strip_suffix("[]") {
        let list = table.get_mut(list)?.as_array_mut()?;
        return list.iter_mut().find_map(|one| place(one.as_table_mut()?, rest, nth));
    }
    if !table.contains_key(*first) && *nth > 0 {
        *nth -= 1;
        return None;
    }
    let next = table.entry(*first).or_insert_with(|| Value::Table(Table::new()));
    place(next.as_table_mut()?, rest, nth)
}

fn read(table: &Table, folder: &Path) -> Option<Scenario> {
    let read = parse("test.toml", &table.to_string(), Some(folder)).ok()?.scenario;
    // Without the keys as written, and the messages about them.
    Some(Scenario { parameters: Vec::new(), made_of: Vec::new(), warnings: Vec::new(), ..read })
}

#[test]
fn a_key_that_is_written_with_its_default_changes_nothing() {
    let mut defaults = Defaults::new();
    collect(&json_schema(), "", &mut defaults);
    assert!(defaults.len() > 40, "{defaults:?}");
    let folders = ["scenarios", "scenarios/demo", "scenarios/plc", "scenarios/setpoints", "tests/scenarios"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(repository().join(folder)).unwrap());
    let files = files.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|it| it == "toml"));
    let texts = files.map(|path| (std::fs::read_to_string(&path).unwrap(), path.parent().unwrap().to_owned()));
    let on_a_screw = [
        ("motion = \"linear\"", "motion = \"linear\"\nlead = \"10 mm\""),
        ("mass = \"20 kg\"", "inertia = \"0.01 kg m2\""),
        ("max_force = \"300 N\"", "max_torque = \"10 Nm\""),
    ];
    let screw = on_a_screw.into_iter().fold(MORE.to_owned(), |text, (from, to)| text.replace(from, to));
    let more = PROGRAMS.map(|program| MORE.to_owned() + program).into_iter().chain([
        screw,
        OF_FMU.to_owned(),
        OF_A_MOTOR.to_owned(),
        FIRMWARE.to_owned(),
        measured_by("observer", "observer = { bandwidth = \"200 Hz\" }"),
        measured_by("mt", "[motor.encoder]\nstep = \"0.1 deg\""),
    ]);
    let more: Vec<_> = more.map(|text| (text, repository())).collect();
    for (text, folder) in &more {
        parse("more", text, Some(folder)).unwrap_or_else(|error| panic!("{error}"));
    }
    let mut untried = defaults.clone();
    for (text, folder) in texts.chain(more) {
        let Ok(whole) = text.parse::<Table>() else { continue };
        for (path, default) in &defaults {
            let keys: Vec<&str> = path.split('.').collect();
            let key = keys[keys.len() - 1];
            for nth in 0.. {
                let (mut without, mut with) = (whole.clone(), whole.clone());
                let Some(table) = place(&mut without, &keys, &mut nth.clone()) else { break };
                table.remove(key);
                place(&mut with, &keys, &mut nth.clone()).unwrap().insert(key.to_owned(), default.clone());
                // Not every file may have every key, nor omit it.
                if let (Some(without), Some(with)) = (read(&without, &folder), read(&with, &folder)) {
                    let (without, with) = (format!("{without:#?}"), format!("{with:#?}"));
                    let difference = without.lines().zip(with.lines()).find(|(without, with)| without != with);
                    assert_eq!(difference, None, "{path} = {default}");
                    assert_eq!(without.len(), with.len(), "{path} = {default}");
                    untried.remove(path);
                }
            }
        }
    }
    assert_eq!(untried.keys().collect::<Vec<_>>(), OF_MOVES);
}
