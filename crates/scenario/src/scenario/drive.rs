//! The drive: its firmware, and the encoders it reads.
use servobench_drive::{Estimate, Params, current};
use servobench_plant::{CurrentSensor, Encoder};

/// A drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Settings of its firmware.
    pub params: Params,
    /// Encoder that closes the position loop.
    pub position_feedback: Feedback,
    /// Estimate of the axis in the firmware. The tool derives it from the plant; a scenario overrides single values to express mismatch.
    pub estimate: Estimate,
    /// Tuning from which the gains of the current loop follow; `None` without a current loop.
    pub current_tuning: Option<current::Tuning>,
    /// Errors of the current sensors; `None` for ideal sensors.
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
