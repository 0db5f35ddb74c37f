//! Tables of `[drive]` for imperfections of real hardware: I²t, cogging, dead time, gains over speed.
use crate::simple::OneOf;
use crate::table::table;
use servobench_drive::current::dead_time;
use servobench_drive::{cogging, overload, schedule};

table! {
    /// I²t: the thermal load of first order of motor and drive. Each is active if its table is present.
    pub(crate) struct I2t {
        /// The motor.
        motor: ThermalLoad = (),
        /// The drive itself.
        drive: ThermalLoad = (),
    }
}

table! {
    /// A thermal load, of first order in the square of the current. Give `time_constant` or `peak_time`.
    pub(crate) struct ThermalLoad requires ["continuous_current"] {
        continuous_current: f64 = overload::Parameter::CONTINUOUS_CURRENT,
        time_constant: f64 = overload::Parameter::TIME_CONSTANT,
        peak_time: f64 = overload::Parameter::PEAK_TIME,
        /// Reaction of the drive when the load reaches that of the continuous current; default: "derate". A fault needs a `[bus]`.
        reaction: overload::Reaction = OneOf,
    }
}

table! {
    /// A harmonic of the motor's cogging that the drive compensates: amplitude·sin(order·θ + phase).
    pub(crate) struct CoggingHarmonic requires ["order", "amplitude"] {
        /// Periods in a revolution of the motor; of a linear motor in two pole pitches.
        order: u32 = 1..=10_000,
        amplitude: f64 = cogging::Parameter::AMPLITUDE,
        /// default: 0.
        phase: f64 = cogging::Parameter::PHASE,
    }
}

table! {
    /// Compensation of the inverter's dead time t_d: t_d·frequency·`dc_link` in the direction of the current of each leg.
    pub(crate) struct DeadTimeCompensation requires ["dead_time", "frequency"] {
        dead_time: f64 = dead_time::Parameter::DEAD_TIME,
        frequency: f64 = dead_time::Parameter::FREQUENCY,
        /// default: 0, a step.
        linear_zone: f64 = dead_time::Parameter::LINEAR_ZONE,
    }
}

table! {
    /// Gains over speed: those of the other tables up to one speed, multiples of them from another speed, linear between.
    pub(crate) struct GainSchedule requires ["from", "to"] {
        from: f64 = schedule::Parameter::FROM,
        to: f64 = schedule::Parameter::TO,
        /// default: 1.
        position: f64 = schedule::Parameter::POSITION,
        /// default: 1.
        velocity: f64 = schedule::Parameter::VELOCITY_GAIN,
    }
}
