//! Errors of sensors and effects of the inverter, as given in the file.
use super::*;
use servobench_plant::{Converter, CurrentSensor, EncoderErrors, Signals, Track};

const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[axis.motor_side]
inertia = "3 kg cm2"
[motor]
model = "wittenstein-premo-1f"
[drive]
model = "servo-16khz"
dc_link = "320 V"
"#;

/// Oracle: by hand, in SI. All values differ, so that a mix-up shows.
#[test]
fn every_key_of_an_encoder_becomes_its_parameter() {
    let found = scenario(&format!(
        "{AXIS}[motor.encoder]\nlines_per_rev = 2048\ncounts_per_rev = 4096\namplitude_error = 0.01\noffset_sine = 0.02\n\
         offset_cosine = 0.03\nphase_error = \"0.04 rad\"\nlost_track = \"sine\"\nlost_at = \"5 ms\"\neccentricity = \"6 um\"\n\
         disc_radius = \"7 mm\"\neccentricity_angle = \"0.08 rad\"\nzero_offset = \"0.09 rad\"\nnoise = \"1e-5 rad\"\nseed = 11\n\
         latency = \"12 us\"\nturn_bits = 4\n"
    ));
    let Actuator::Pmsm { encoder, .. } = found.actuator else { panic!("a synchronous motor") };
    let signals = Signals {
        period: TAU / 2048.0,
        amplitude_error: 0.01,
        offset: [0.03, 0.02],
        phase_error: 0.04,
        lost: Some((Track::Sine, 0.005)),
    };
    let errors = EncoderErrors {
        signals,
        eccentricity: 6e-6,
        radius: 0.007,
        eccentricity_angle: 0.08,
        zero: 0.09,
        commutation: 0.0,
        noise: 1e-5,
        seed: 11,
        latency: 12e-6,
        range: Some(16.0 * TAU),
    };
    assert_eq!(encoder, Encoder { increment: Some(TAU / 4096.0), errors: Some(errors) });
}

#[test]
fn without_errors_sensors_are_ideal() {
    let found =
        scenario(&format!("{AXIS}[motor.encoder]\nseed = 3\nnoise = \"0 deg\"\n[drive.current.sensor]\nseed = 3\n"));
    let Actuator::Pmsm { encoder, ref drive, .. } = found.actuator else { panic!("a synchronous motor") };
    assert_eq!((encoder.errors, drive.current_sensor), (None, None));
}

/// Oracle: by hand, in SI.
#[test]
fn every_key_of_current_sensors_and_inverter_becomes_its_parameter() {
    let found = scenario(&format!(
        "{AXIS}[drive.current.sensor]\noffset_a = \"1 A\"\noffset_b = \"2 A\"\ngain_error_a = 0.3\ngain_error_b = 0.4\n\
         noise = \"5 mA\"\nseed = 6\nbits = 7\nrange = \"80 A\"\ndelay = 2\nshift = \"9 us\"\n\
         [drive.inverter]\ncarrier = \"16 kHz\"\ndead_time = \"1 us\"\ndevice_drop = \"2 V\"\non_resistance = \"3 mOhm\"\n"
    ));
    let Actuator::Pmsm { drive, inverter: found, .. } = found.actuator else { panic!("a synchronous motor") };
    let sensor = CurrentSensor {
        offset: [1.0, 2.0],
        gain_error: [0.3, 0.4],
        noise: 0.005,
        seed: 6,
        converter: Some(Converter { bits: 7, range: 80.0 }),
        delay: 2,
        shift: 9e-6,
    };
    assert_eq!(drive.current_sensor, Some(sensor));
    let inverter = inverter::Params {
        modulation: inverter::Modulation::Averaged,
        carrier: 16e3,
        dead_time: 1e-6,
        device_drop: 2.0,
        on_resistance: 0.003,
    };
    assert_eq!(found, Some(inverter));
}
