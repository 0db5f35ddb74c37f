//! The drive: its firmware, and the encoders that it reads.
use servobench_drive::{Estimate, Params, current};
use servobench_plant::{CurrentSensor, Encoder};

/// A drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// What its firmware is set to.
    pub params: Params,
    /// Which encoder closes the position loop.
    pub position_feedback: Feedback,
    /// What the firmware believes of the axis. The tool fills it from the plant; a scenario overrides single values to express
    /// mismatch.
    pub estimate: Estimate,
    /// What the gains of the current loop follow from; `None` without one.
    pub current_tuning: Option<current::Tuning>,
    /// Errors of the current sensors; `None` for sensors without.
    pub current_sensor: Option<CurrentSensor>,
}

/// Encoder that closes a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feedback {
    /// The one on the motor.
    Motor,
    /// This one, on the load.
    Load(Encoder),
}
