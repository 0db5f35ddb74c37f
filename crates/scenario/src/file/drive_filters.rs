//! `[[drive.filter]]`: filters in the torque path.
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::choices;
use servobench_drive::filter;

choices! {
    /// Kind of a filter.
    pub(crate) enum FilterKind {
        /// attenuates above its `frequency`
        LowPass = "low-pass",
        /// attenuates around its `frequency`
        Notch = "notch",
        /// zeros and poles, each with a frequency and a damping ratio
        BiQuad = "bi-quad",
    }
}

table! {
    /// A filter between velocity loop and current loop, at the rate of the velocity loop; its gain is 1 at standstill. Filters act
    /// in the order of the file, four at most, and the limits of torque and current act after them.
    pub(crate) struct TorqueFilter requires ["kind"] {
        /// Kind of the filter.
        kind: FilterKind = OneOf,
        frequency: f64 = filter::Parameter::FREQUENCY,
        /// Order of a low-pass; default: 1.
        order: u32 = 1..=2,
        /// default: 0.7.
        damping: f64 = filter::Parameter::DAMPING,
        zero_frequency: f64 = filter::Parameter::ZERO_FREQUENCY,
        /// default: 0. The gain of a notch at its frequency is the ratio of this to `pole_damping`.
        zero_damping: f64 = filter::Parameter::ZERO_DAMPING,
        pole_frequency: f64 = filter::Parameter::POLE_FREQUENCY,
        /// default: 0.7.
        pole_damping: f64 = filter::Parameter::POLE_DAMPING,
    }
}
