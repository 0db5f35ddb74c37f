//! `scenarios/hardware`: each effect of a sensor is within its limits, and out of them where it is off or twice as large.
use super::passes_but_not_with;

/// A file, what switches its effect off, and what doubles it.
const EFFECTS: [(&str, &[&str], &[&str]); 13] = [
    (
        "current-offset",
        &["drive.current.sensor.offset_a=\"0 A\"", "drive.current.sensor.offset_b=\"0 A\""],
        &["drive.current.sensor.offset_a=\"0.3 A\"", "drive.current.sensor.offset_b=\"-0.08 A\""],
    ),
    (
        "current-gain",
        &["drive.current.sensor.gain_error_a=0", "drive.current.sensor.gain_error_b=0"],
        &["drive.current.sensor.gain_error_a=0.06", "drive.current.sensor.gain_error_b=-0.02"],
    ),
    ("current-noise", &["drive.current.sensor.noise=\"0 A\""], &["drive.current.sensor.noise=\"0.2 A\""]),
    ("current-delay", &["drive.current.sensor.delay=0"], &["drive.current.sensor.delay=2"]),
    ("current-quantisation", &["drive.current.sensor.bits=16"], &["drive.current.sensor.bits=7"]),
    ("encoder-increments", &["motor.encoder.counts_per_rev=1048576"], &["motor.encoder.counts_per_rev=8192"]),
    ("sincos-phase", &["motor.encoder.phase_error=\"0 deg\""], &["motor.encoder.phase_error=\"6 deg\""]),
    ("sincos-amplitude", &["motor.encoder.amplitude_error=0"], &["motor.encoder.amplitude_error=0.1"]),
    ("encoder-eccentricity", &["motor.encoder.eccentricity=\"0 um\""], &["motor.encoder.eccentricity=\"40 um\""]),
    ("encoder-noise", &["motor.encoder.noise=\"0 deg\""], &["motor.encoder.noise=\"0.002 deg\""]),
    ("encoder-latency", &["motor.encoder.latency=\"0 us\""], &["motor.encoder.latency=\"200 us\""]),
    (
        "commutation-offset",
        &["motor.encoder.commutation_offset=\"0 deg\""],
        &["motor.encoder.commutation_offset=\"24 deg\""],
    ),
    ("scale-offset", &["drive.load_encoder.offset_sine=0"], &["drive.load_encoder.offset_sine=0.3"]),
];

#[test]
fn each_effect_of_a_sensor_is_what_its_limits_say() {
    for (name, off, doubled) in EFFECTS {
        passes_but_not_with(name, &[off, doubled]);
    }
}
