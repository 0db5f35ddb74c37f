//! A motor that turns at a constant speed, and what is read of its recordings.
use crate::rig::values;
use servobench_trace::Recording;
use std::f64::consts::TAU;

/// N·m per ampere (peak): 1.5·p·ψ.
pub(crate) const TORQUE_CONSTANT: f64 = 1.5 * POLE_PAIRS * 0.0817;
pub(crate) const POLE_PAIRS: f64 = 4.0;
/// Base ticks per second.
pub(crate) const RATE: f64 = 16e3;

/// A motor without saliency that turns `turns` at `rpm` against 1.9 N·m, with these keys besides; `encoder` and `sensor` are
/// inline tables.
pub(crate) fn turning(rpm: f64, turns: f64, encoder: &str, sensor: &str) -> String {
    turning_with(rpm, turns, encoder, sensor, ["40 Hz", "6 Hz"])
}

/// The same with these bandwidths of velocity and position loop.
pub(crate) fn turning_with(rpm: f64, turns: f64, encoder: &str, sensor: &str, bandwidths: [&str; 2]) -> String {
    let [velocity, position] = bandwidths;
    format!(
        r#"
run.base_rate = "16 kHz"
axis = {{ motion = "rotary", motor_side = {{ inertia = "0.004 kg m2" }} }}
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "0.9 Ohm"
inductance = "4.3 mH"
flux_linkage = "81.7 mV s"
inertia = "0.0003 kg m2"
max_current = "20 Apk"
encoder = {encoder}
[drive]
dc_link = "320 V"
current = {{ rate = "16 kHz", bandwidth = "700 Hz", sensor = {sensor} }}
velocity = {{ rate = "8 kHz", bandwidth = "{velocity}" }}
position = {{ rate = "4 kHz", bandwidth = "{position}" }}
feedforward = {{ velocity = true, effort = "rigid" }}
[setpoint]
order = 3
velocity = "{rpm} rpm"
acceleration = "400 rad/s2"
jerk = "8000 rad/s3"
[[program]]
move_to = "{turns} rev"
[[disturbance]]
on = "load"
torque = "-1.9 Nm"
"#
    )
}

/// Rows of the middle of the move, in which the motor makes a whole number of turns: from one that is passed to another.
pub(crate) fn whole_turns(recording: &Recording, first: f64, last: f64) -> std::ops::Range<usize> {
    let position = values(recording, "motor.position");
    let passed = |turns: f64| position.iter().position(|x| *x >= turns * TAU).unwrap();
    passed(first)..passed(last)
}

/// Amplitude of `wave` at so many periods per turn of the motor: over the angle, which need not pass at a constant speed.
pub(crate) fn harmonic(recording: &Recording, rows: std::ops::Range<usize>, wave: &[f64], per_turn: f64) -> f64 {
    let position = values(recording, "motor.position");
    let angle = position[rows.end] - position[rows.start];
    let sum = rows.fold([0.0; 2], |sum, k| {
        let (sine, cosine) = (per_turn * position[k]).sin_cos();
        let weighted = wave[k] * (position[k + 1] - position[k - 1]) / 2.0;
        [sum[0] + weighted * cosine, sum[1] + weighted * sine]
    });
    2.0 * sum[0].hypot(sum[1]) / angle
}

/// Torque of the motor less that which the velocity loop asks for.
pub(crate) fn torque_error(recording: &Recording) -> Vec<f64> {
    let [given, asked] = ["effort.motor", "effort.reference"].map(|name| values(recording, name));
    given.iter().zip(asked).map(|(given, asked)| given - asked).collect()
}
