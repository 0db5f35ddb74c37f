//! `[drive.supervision]`: supervision of motor and power stage by the drive.
use crate::table::table;
use servobench_drive::supervision::Parameter;

table! {
    /// Supervision of motor and power stage by the drive, which reports faults: docs/faults.md. Each key is a separate supervision, off
    /// without it. Faults need a `[bus]`.
    pub(crate) struct Supervision {
        /// : 3220h.
        undervoltage: f64 = Parameter::UNDERVOLTAGE,
        /// : 3210h.
        overvoltage: f64 = Parameter::OVERVOLTAGE,
        /// : 7310h.
        overspeed: f64 = Parameter::OVERSPEED,
        /// : 2310h.
        overcurrent: f64 = Parameter::OVERCURRENT,
        /// (with `[motor.thermal]`): 4310h.
        winding_temperature: f64 = Parameter::WINDING_TEMPERATURE,
        /// The motor gains speed against its torque-producing current: 7122h.
        commutation: Commutation = (),
        /// The motor is stalled although the loops are at their limit: 7121h.
        stall: Stall = (),
        /// A phase lacks the current requested of it: 3321h.
        phase_loss: PhaseLoss = (),
    }
}

table! {
    /// Criterion of a wrong commutation: the motor gains `speed` against a torque-producing current of `current` or more.
    pub(crate) struct Commutation requires ["speed", "current"] {
        speed: f64 = Parameter::COMMUTATION_SPEED,
        current: f64 = Parameter::COMMUTATION_CURRENT,
    }
}

table! {
    /// Criterion of a blocked motor: it is slower than `speed` for `time` while the torque or force is at a limit.
    pub(crate) struct Stall requires ["speed", "time"] {
        speed: f64 = Parameter::STALL_SPEED,
        time: f64 = Parameter::STALL_TIME,
    }
}

table! {
    /// Criterion of a lost phase: for `time` its leg has less than half of `current` while its reference is `current` or more.
    pub(crate) struct PhaseLoss requires ["current", "time"] {
        current: f64 = Parameter::PHASE_CURRENT,
        time: f64 = Parameter::PHASE_TIME,
    }
}
