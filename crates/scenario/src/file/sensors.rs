//! The sensors: `[motor.encoder]`, `[drive.load_encoder]`, `[drive.current.sensor]`.
use crate::field::{Field as _, Slot};
use crate::simple::OneOf;
use crate::table::{GroupKey, OpenTable, table};
use servobench_config::Parameter;
use servobench_plant::{self as plant, CurrentSensorParameter, EncoderErrors, EncoderParameter, Track};
use std::iter;

/// Body that carries an encoder: its lengths and angles are in the coordinate of that body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mount {
    /// The motor.
    Motor,
    /// The load.
    Load,
}

impl Mount {
    /// `parameter` in the coordinate of the body, with a separate example for the motor.
    const fn of(self, parameter: &Parameter, example_of_motor: &'static str) -> Parameter {
        match self {
            Self::Motor => parameter.of_motor(example_of_motor),
            Self::Load => *parameter,
        }
    }

    const fn step(self) -> Parameter {
        let step = self.of(EncoderParameter::STEP, "0.01 deg");
        match self {
            Self::Motor => Parameter {
                meaning: "One increment: an angle of a motor that turns, with a `lead` too, a length of a linear motor (\"0.1 um\")",
                ..step
            },
            Self::Load => step,
        }
    }
}

table! {
    /// Position encoder: a resolution, or none for an ideal one, and its errors; an error that is not given is zero.
    pub(crate) struct Encoder of (mount: Mount) sets EncoderErrors {
        /// Increments per revolution: 1048576 for 20 bits.
        counts_per_rev: u32 = 1..=u32::MAX,
        step: f64 = mount.step(),
        /// Increments per period of the signals, instead of the two keys above.
        interpolation: u32 = 1..=u32::MAX,
        /// (needed by the errors of the signals and by `interpolation`).
        signal_period: f64 = mount.of(EncoderParameter::SIGNAL_PERIOD, "0.2 deg"),
        /// Periods of the signals per revolution, instead of their length.
        lines_per_rev: u32 = 1..=u32::MAX,
        amplitude_error: f64 = EncoderParameter::AMPLITUDE_ERROR => signals.amplitude_error,
        offset_sine: f64 = EncoderParameter::OFFSET_SINE => signals.offset[1],
        offset_cosine: f64 = EncoderParameter::OFFSET_COSINE => signals.offset[0],
        phase_error: f64 = EncoderParameter::PHASE_ERROR => signals.phase_error,
        /// Signal whose amplitude falls to zero at `lost_at`: a fault of the encoder; default: none.
        lost_track: Track = OneOf,
        /// default: 0.
        lost_at: f64 = EncoderParameter::LOST_AT,
        /// (of a disc that turns; with `disc_radius`).
        eccentricity: f64 = EncoderParameter::ECCENTRICITY => eccentricity,
        disc_radius: f64 = EncoderParameter::RADIUS => radius,
        /// default: 0.
        eccentricity_angle: f64 = EncoderParameter::ECCENTRICITY_ANGLE => eccentricity_angle,
        /// (the commutation does not depend on it).
        zero_offset: f64 = mount.of(EncoderParameter::ZERO_OFFSET, "0.1 deg") => zero,
        noise: f64 = mount.of(EncoderParameter::NOISE, "0.0001 deg") => noise,
        /// Seed of the noise; default: 0. The same seed gives the same noise, on every machine.
        seed: u32 = 0..=u32::MAX => seed,
        /// default: 0.
        latency: f64 = EncoderParameter::LATENCY => latency,
        /// Bits of the revolutions that an absolute encoder counts before it wraps, 0 for a single-turn encoder; the drive continues
        /// the count. Default: it never wraps.
        turn_bits: u32 = 0..=32,
        ..commutation: Commutation = mount
    }
}

/// The key of encoders on a motor only.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Commutation {
    pub(crate) offset: Slot<f64>,
}

impl Commutation {
    const KEY: &'static str = "commutation_offset";
    const PARAMETER: &'static Parameter = EncoderParameter::COMMUTATION_OFFSET;

    fn keys(mount: Mount) -> impl Iterator<Item = &'static str> {
        iter::once(Self::KEY).filter(move |_| mount == Mount::Motor)
    }

    fn read(open: &mut OpenTable<'_>, _: Mount) -> Self {
        Self { offset: open.field(Self::KEY, &Self::PARAMETER) }
    }

    fn schemas(mount: Mount) -> Vec<GroupKey<0>> {
        Self::keys(mount).map(|key| (key, (Self::PARAMETER.meaning, []), f64::schema(&Self::PARAMETER))).collect()
    }
}

table! {
    /// Errors of the current sensors on the phases a and b, and their converter; the third phase is −(a + b). An error that is not
    /// given is zero.
    pub(crate) struct CurrentSensor sets plant::CurrentSensor {
        offset_a: f64 = CurrentSensorParameter::OFFSET_A => offset[0],
        offset_b: f64 = CurrentSensorParameter::OFFSET_B => offset[1],
        gain_error_a: f64 = CurrentSensorParameter::GAIN_ERROR_A => gain_error[0],
        gain_error_b: f64 = CurrentSensorParameter::GAIN_ERROR_B => gain_error[1],
        noise: f64 = CurrentSensorParameter::NOISE => noise,
        /// Seed of the noise; default: 0. The same seed gives the same noise, on every machine.
        seed: u32 = 0..=u32::MAX => seed,
        /// Bits of the converter, both directions together; with `range`. Default: no quantisation and no range.
        bits: u32 = 2..=32,
        range: f64 = CurrentSensorParameter::RANGE,
        /// Delay of a sample, in cycles of the current loop; default: 0.
        delay: u32 = 0..=2 => delay,
        /// (less than a base tick); default: 0.
        shift: f64 = CurrentSensorParameter::SHIFT => shift,
    }
}
