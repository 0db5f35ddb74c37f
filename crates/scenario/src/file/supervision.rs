//! `[drive.supervision]`: supervision of motor and power stage by the drive.
use crate::table::table;
use servobench_drive::supervision::Parameter;

table! {
    /// What the drive watches of motor and power stage, and tells as a fault: docs/faults.md. Each key is a supervision of its own, off
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
        /// , with `[motor.thermal]`: 4310h.
        winding_temperature: f64 = Parameter::WINDING_TEMPERATURE,
        /// The motor gains speed against its torque-producing current: 7122h.
        commutation: Commutation = (),
        /// The motor stands although the loops are at their limit: 7121h.
        stall: Stall = (),
        /// A phase has no current that it is to have: 3321h.
        phase_loss: PhaseLoss = (),
    }
}

table! {
    /// When the commutation is taken to be wrong: the motor gains `speed` against a torque-producing current of `current` or more.
    pub(crate) struct Commutation requires ["speed", "current"] {
        speed: f64 = Parameter::COMMUTATION_SPEED,
        current: f64 = Parameter::COMMUTATION_CURRENT,
    }
}

table! {
    /// When the motor is taken to be blocked: it is slower than `speed` for `time` while a limit cuts the torque or force.
    pub(crate) struct Stall requires ["speed", "time"] {
        speed: f64 = Parameter::STALL_SPEED,
        time: f64 = Parameter::STALL_TIME,
    }
}

table! {
    /// When a phase is taken to be lost: for `time` its leg has less than half of `current` while it is to have `current` or more.
    pub(crate) struct PhaseLoss requires ["current", "time"] {
        current: f64 = Parameter::PHASE_CURRENT,
        time: f64 = Parameter::PHASE_TIME,
    }
}
