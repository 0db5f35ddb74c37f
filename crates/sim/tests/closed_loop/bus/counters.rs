//! Counters of the bus that wrap: no jump, no lost count.
use crate::rig::{last, run, steepest, values, when};
use servobench_trace::Recording;

/// Lambrechts' motor and load under an ideal force, 4 kHz.
const AXIS: &str = r#"
[run]
base_rate = "4 kHz"
[axis]
model = "lambrechts"
[motor]
kind = "ideal-source"
limit = "1 kN"
[drive.velocity]
rate = "4 kHz"
bandwidth = "15 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "4 Hz"
[setpoint]
order = 4
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
[bus]
cycle = "1 ms"
velocity_offset = true
effort_offset = "two-mass"
"#;

/// `from` and `to` are ends of a way through the counter; units of `unit` metres.
fn through(bits: u32, signed: bool, unit: &str, ends: [f64; 2]) -> Recording {
    let [one, other] = ends;
    run(&format!(
        "{AXIS}counter = {{ bits = {bits}, signed = {signed} }}\nunits = {{ drive = 1, axis = \"{unit}\" }}\n\
         [[program]]\nmove_to = \"{one} m\"\n[[program]]\nmove_to = \"{other} m\"\n"
    ))
}

/// Oracle: the load itself. What the master reads is as old as a frame, two cycles, and whole units.
fn assert_counts(recording: &Recording, unit: f64, target: f64, what: &str) {
    let [bus, load] = ["bus.position", "load.position"].map(|name| values(recording, name));
    let old = recording.index_at(2e-3);
    // 1 m/s for a cycle of the bus and a spring of 0.1 m/s² · m/k.
    let apart = bus[old..].iter().zip(load).map(|(bus, load)| (bus - load).abs()).fold(0.0, f64::max);
    println!("{what}: {apart:.2e} m apart");
    assert!(apart < 2.2e-3 + unit, "{what}: {apart}");
    assert!(steepest(recording, "bus.position", 1e-3) < 2.1e-3 + 2.0 * unit, "{what}: jumps");
    let end = (last(recording, "bus.position") - last(recording, "load.position")).abs();
    assert!(end <= unit, "{what}: {end}");
    assert!((last(recording, "load.position") - target).abs() <= unit, "{what}: {}", last(recording, "load.position"));
}

/// Ten turns of 2¹⁶ · 10 µm forwards, and eleven back through zero.
#[test]
fn an_axis_runs_ten_times_through_a_counter_of_16_bits() {
    for signed in [true, false] {
        let recording = through(16, signed, "10 um", [6.6, -0.7]);
        assert_counts(&recording, 10e-6, -0.7, &format!("16 bits, signed {signed}"));
    }
}

/// Ten turns of 2³² nm are 43 m.
#[test]
fn an_axis_runs_ten_times_through_a_counter_of_32_bits() {
    for (signed, end) in [(true, 43.0), (false, -43.0)] {
        let recording = through(32, signed, "1 nm", [end, end]);
        assert_counts(&recording, 1e-9, end, &format!("32 bits, signed {signed}"));
    }
}

/// A rotary table without ends that function blocks turn, behind a counter of 16 bits in hundredths of a degree.
fn turning(more: &str) -> Recording {
    run(&format!(
        r#"
[run]
base_rate = "4 kHz"
duration = "4 s"
[axis]
motion = "rotary"
modulo = "360 deg"
[axis.motor_side]
inertia = "0.001 kg m2"
[motor]
kind = "ideal-source"
limit = "20 Nm"
[drive.velocity]
rate = "4 kHz"
bandwidth = "60 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "15 Hz"
[setpoint]
velocity = "1000 deg/s"
acceleration = "10000 deg/s2"
jerk = "1000000 deg/s3"
[bus]
cycle = "1 ms"
velocity_offset = true
effort_offset = "rigid"
counter = {{ bits = 16, signed = false }}
units = {{ drive = 100, axis = "1 deg" }}
[plc]
homing_required = false
[[call]]
block = "MC_Power"
name = "power"
{more}"#
    ))
}

/// Where the axis ends (degrees).
fn degrees(recording: &Recording) -> f64 {
    last(recording, "load.position").to_degrees()
}

#[test]
fn an_endless_axis_turns_on_and_on() {
    let recording = turning(
        r#"
[[call]]
block = "MC_MoveVelocity"
name = "turn"
start = "power.Status"
velocity = "1000 deg/s"
[[call]]
block = "MC_MoveAbsolute"
name = "end"
start = { at = "3 s" }
position = "90 deg"
direction = "current"
"#,
    );
    // A little less than 3 s at 1000 °/s: eight turns and some, so the ninth ends at 90°;
    // that is five times through 2¹⁶ hundredths.
    let end = degrees(&recording);
    println!("{end}°");
    assert!(end > 2_900.0 && (end - 3_330.0).abs() < 0.02, "{end}");
    let apart = last(&recording, "bus.position") - last(&recording, "load.position");
    assert!(apart.abs().to_degrees() <= 0.01, "{apart}");
    assert!(steepest(&recording, "bus.position", 1e-3).to_degrees() < 2.1);
    assert!(when(&recording, "end", "Done", "TRUE") < 4.0);
}

/// Oracle: the ways by hand. The axis is first brought to 300°, forwards.
#[test]
fn a_modulo_axis_goes_the_way_that_it_is_told() {
    for (direction, expected) in [("positive", 390.0), ("negative", 30.0), ("shortest", 390.0), ("current", 390.0)] {
        let recording = turning(&format!(
            r#"
[[call]]
block = "MC_MoveAbsolute"
name = "first"
start = "power.Status"
position = "300 deg"
direction = "positive"
[[call]]
block = "MC_MoveAbsolute"
name = "second"
start = "first.Done"
position = "30 deg"
direction = "{direction}"
"#
        ));
        let end = degrees(&recording);
        assert!((end - expected).abs() < 0.02, "{direction}: {end}");
        assert!(when(&recording, "second", "Done", "TRUE") > when(&recording, "first", "Done", "TRUE"));
    }
}
