//! The sensors: `[motor.encoder]`, `[drive.load_encoder]`, `[drive.current.sensor]`.
use crate::field::Slot;
use crate::simple::OneOf;
use crate::source::Span;
use crate::table::table;
use servobench_plant::{CurrentSensorParameter, EncoderParameter, Track};

/// The tables of both encoders, which have the same keys: those of the motor in the motor's coordinate, those of the load in that of the
/// axis; and what they have in common.
macro_rules! encoders {
    (
        $(
            $(#[doc = $table_doc:literal])+
            $table:ident {
                $(#[doc = $step_doc:literal])*
                step = $step:expr, signal_period = $signal_period:expr, zero_offset = $zero_offset:expr, noise = $noise:expr;
                $($(#[doc = $doc:literal])* $own:ident: $own_type:ty = $own_spec:expr,)*
            }
        )+
    ) => {
        $(
            table! {
                $(#[doc = $table_doc])+
                pub(crate) struct $table {
                    /// Increments per revolution: 1048576 for 20 bits.
                    counts_per_rev: u32 = 1..=u32::MAX,
                    $(#[doc = $step_doc])*
                    step: f64 = $step,
                    /// Increments per period of the signals, instead of the two keys before.
                    interpolation: u32 = 1..=u32::MAX,
                    /// (needed by the errors of the signals and by `interpolation`).
                    signal_period: f64 = $signal_period,
                    /// Periods of the signals per revolution, instead of their length.
                    lines_per_rev: u32 = 1..=u32::MAX,
                    amplitude_error: f64 = EncoderParameter::AMPLITUDE_ERROR,
                    offset_sine: f64 = EncoderParameter::OFFSET_SINE,
                    offset_cosine: f64 = EncoderParameter::OFFSET_COSINE,
                    phase_error: f64 = EncoderParameter::PHASE_ERROR,
                    /// Signal whose amplitude falls to zero at `lost_at`: a fault of the encoder; default: none.
                    lost_track: Track = OneOf,
                    /// default: 0.
                    lost_at: f64 = EncoderParameter::LOST_AT,
                    /// (of what turns; with `disc_radius`).
                    eccentricity: f64 = EncoderParameter::ECCENTRICITY,
                    disc_radius: f64 = EncoderParameter::RADIUS,
                    /// default: 0.
                    eccentricity_angle: f64 = EncoderParameter::ECCENTRICITY_ANGLE,
                    /// (the commutation does not depend on it).
                    zero_offset: f64 = $zero_offset,
                    noise: f64 = $noise,
                    /// Seed of the noise; default: 0. The same seed gives the same noise, on every machine.
                    seed: u32 = 0..=u32::MAX,
                    /// default: 0.
                    latency: f64 = EncoderParameter::LATENCY,
                    /// Bits of the revolutions that an absolute encoder counts before it begins again, 0 for one of a single turn; the drive
                    /// counts on. Default: never.
                    turn_bits: u32 = 0..=32,
                    $($(#[doc = $doc])* $own: $own_type = $own_spec,)*
                }
            }

            impl $table {
                pub(crate) const fn keys(&self) -> EncoderKeys<'_> {
                    EncoderKeys {
                        span: self.span,
                        counts_per_rev: &self.counts_per_rev,
                        step: &self.step,
                        interpolation: &self.interpolation,
                        signal_period: &self.signal_period,
                        lines_per_rev: &self.lines_per_rev,
                        amplitude_error: &self.amplitude_error,
                        offset_sine: &self.offset_sine,
                        offset_cosine: &self.offset_cosine,
                        phase_error: &self.phase_error,
                        lost_track: &self.lost_track,
                        lost_at: &self.lost_at,
                        eccentricity: &self.eccentricity,
                        disc_radius: &self.disc_radius,
                        eccentricity_angle: &self.eccentricity_angle,
                        zero_offset: &self.zero_offset,
                        noise: &self.noise,
                        seed: &self.seed,
                        latency: &self.latency,
                        turn_bits: &self.turn_bits,
                    }
                }
            }
        )+
    };
}

/// What the tables of both encoders have in common.
#[derive(Clone, Copy)]
pub(crate) struct EncoderKeys<'a> {
    pub(crate) span: Span,
    pub(crate) counts_per_rev: &'a Slot<u32>,
    pub(crate) step: &'a Slot<f64>,
    pub(crate) interpolation: &'a Slot<u32>,
    pub(crate) signal_period: &'a Slot<f64>,
    pub(crate) lines_per_rev: &'a Slot<u32>,
    pub(crate) amplitude_error: &'a Slot<f64>,
    pub(crate) offset_sine: &'a Slot<f64>,
    pub(crate) offset_cosine: &'a Slot<f64>,
    pub(crate) phase_error: &'a Slot<f64>,
    pub(crate) lost_track: &'a Slot<Track>,
    pub(crate) lost_at: &'a Slot<f64>,
    pub(crate) eccentricity: &'a Slot<f64>,
    pub(crate) disc_radius: &'a Slot<f64>,
    pub(crate) eccentricity_angle: &'a Slot<f64>,
    pub(crate) zero_offset: &'a Slot<f64>,
    pub(crate) noise: &'a Slot<f64>,
    pub(crate) seed: &'a Slot<u32>,
    pub(crate) latency: &'a Slot<f64>,
    pub(crate) turn_bits: &'a Slot<u32>,
}

encoders! {
    /// Position encoder: a resolution, or none for an ideal one, and its errors; what is not given does not err.
    Encoder {
        /// : an angle of a motor that turns, with a `lead` too, a length of a linear motor ("0.1 um").
        step = EncoderParameter::STEP.of_motor("0.01 deg"),
        signal_period = EncoderParameter::SIGNAL_PERIOD.of_motor("0.2 deg"),
        zero_offset = EncoderParameter::ZERO_OFFSET.of_motor("0.1 deg"),
        noise = EncoderParameter::NOISE.of_motor("0.0001 deg");
        commutation_offset: f64 = EncoderParameter::COMMUTATION_OFFSET,
    }
    /// Encoder on the load: a resolution, or none for an ideal one, and its errors; what is not given does not err.
    LoadEncoder {
        step = EncoderParameter::STEP,
        signal_period = EncoderParameter::SIGNAL_PERIOD,
        zero_offset = EncoderParameter::ZERO_OFFSET,
        noise = EncoderParameter::NOISE;
    }
}

table! {
    /// Errors of the current sensors on the phases a and b, and their converter; the third phase is −(a + b). What is not given does not
    /// err.
    pub(crate) struct CurrentSensor {
        offset_a: f64 = CurrentSensorParameter::OFFSET_A,
        offset_b: f64 = CurrentSensorParameter::OFFSET_B,
        gain_error_a: f64 = CurrentSensorParameter::GAIN_ERROR_A,
        gain_error_b: f64 = CurrentSensorParameter::GAIN_ERROR_B,
        noise: f64 = CurrentSensorParameter::NOISE,
        /// Seed of the noise; default: 0. The same seed gives the same noise, on every machine.
        seed: u32 = 0..=u32::MAX,
        /// Bits of the converter, both directions together; with `range`. Default: no steps and no range.
        bits: u32 = 2..=32,
        range: f64 = CurrentSensorParameter::RANGE,
        /// Cycles of the current loop after which a sample is told; default: 0.
        delay: u32 = 0..=2,
        /// (less than a base tick); default: 0.
        shift: f64 = CurrentSensorParameter::SHIFT,
    }
}
