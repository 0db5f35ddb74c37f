//! Diagnostics of each kind of mistake, with their places.
mod bus;
mod calls;
mod firmware;
mod fmus;
mod names;
mod quantities;
mod requirements;
mod rules;
mod setpoints;
mod time;

use servobench_scenario::{LoadError, parse};

/// A ball-screw axis with a synchronous motor; line numbers in the tests count from its first line.
const AXIS: &str = r#"description = "an elastic axis"
engine = "exact"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
[axis.table]
mass = "40 kg"
stiffness = "43 N/um"
damping = "1659 N s/m"
coulomb = "20 N"
static = "32 N"
stribeck_velocity = "1 mm/s"
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "1.6 Ohm"
inductance = "3.5 mH"
flux_linkage = "0.06 V s"
inertia = "1.57 kg cm2"
max_current = "13.3 Arms"
[drive]
dc_link = "320 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "60 Hz"
[drive.position]
rate = "4 kHz"
gain = "80 1/s"
[drive.feedforward]
velocity = true
effort = "two-mass"
[setpoint]
order = 3
velocity = "30 m/min"
acceleration = "6 m/s2"
jerk = "200 m/s3"
[[program]]
move_to = "250 mm"
[[disturbance]]
on = "load"
force = "100 N"
[measure]
window = "10 um"
[limits]
settling_time = "50 ms"
"#;

/// `line:column: message; help` of every mistake in `text`.
fn mistakes(text: &str) -> Vec<String> {
    match parse("axis.toml", text, None) {
        Ok(_) => Vec::new(),
        Err(LoadError::Invalid(invalid)) => {
            invalid.diagnostics.iter().map(|one| shortened(&one.line(&invalid.sources))).collect()
        }
        Err(other) => panic!("{other}"),
    }
}

fn shortened(line: &str) -> String {
    line.strip_prefix("axis.toml:").unwrap_or(line).to_owned()
}

/// The mistakes after `old` in the axis was replaced by `new`.
fn after(old: &str, new: &str) -> Vec<String> {
    assert_eq!(AXIS.matches(old).count(), 1, "`{old}` must be there once");
    mistakes(&AXIS.replace(old, new))
}

fn strings(all: &[&str]) -> Vec<String> {
    all.iter().map(ToString::to_string).collect()
}

fn warnings(text: &str) -> Vec<String> {
    let loaded = parse("axis.toml", text, None).unwrap_or_else(|e| panic!("{e}"));
    loaded.warnings.iter().map(|one| shortened(&one.line(&loaded.sources))).collect()
}

#[test]
fn the_axis_itself_is_right() {
    assert_eq!(mistakes(AXIS), [""; 0]);
    assert_eq!(warnings(AXIS), [""; 0]);
}
