//! Modes of operation (CiA 402): from the commands of the master to the demand on the loops.
//!
//! A mode gets a [`Moment`] and returns an [`Answer`], once per period of the position loop. Positions and velocities are in the axis unit
//! (m or rad), efforts in the motor's (N·m or N): drive units are converted at the bus interface.
pub mod cyclic;
pub mod homing;
pub mod interpolated;
pub mod profile;
mod ramp;
mod reach;
pub mod stop;

use crate::Demand;
use servobench_base::{Setpoint, Stateful};
use servobench_cia402::Controlword;

pub use ramp::Steepness;

/// Input of a mode at a step of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Moment {
    /// Targets from the master.
    pub targets: Targets,
    /// Measured values.
    pub actual: Actual,
    /// Present set-point of the loops if they continue as at the last step: the start of a mode that takes over. Without such a demand it
    /// is the position of the axis.
    pub demanded: Setpoint,
    /// Time since the last step (s).
    pub period: f64,
}

/// Targets from the master.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Targets {
    /// Controlword, with the mode-specific bits.
    pub controlword: Controlword,
    /// Target position (607Ah), in csp with the position offset (60B0h).
    pub position: f64,
    /// Target position (607Ah) as a distance, for relative set-points.
    pub distance: f64,
    /// Target velocity (60FFh).
    pub velocity: f64,
    /// Target effort (6071h).
    pub effort: f64,
    /// Offset of the velocity from the position loop (60B1h).
    pub velocity_offset: f64,
    /// Offset of the effort from the velocity loop (60B2h).
    pub effort_offset: f64,
    /// Highest velocity of a profile (6081h), a magnitude.
    pub profile_velocity: f64,
    /// Acceleration of a profile (6083h), a magnitude.
    pub profile_acceleration: f64,
    /// Deceleration of a profile (6084h), a magnitude.
    pub profile_deceleration: f64,
    /// Position of the reference (607Ch).
    pub home_offset: f64,
    /// True if the frame with these targets came since the last step.
    pub is_new: bool,
}

/// Values measured by the drive.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Actual {
    /// Position, the home offset included.
    pub position: f64,
    /// Velocity.
    pub velocity: f64,
    /// Effort of the motor.
    pub effort: f64,
    /// Switch of the negative end.
    pub negative_limit: bool,
    /// Switch of the positive end.
    pub positive_limit: bool,
    /// Home switch.
    pub home: bool,
    /// Position of the last index pulse, if one came since the last step.
    pub index: Option<f64>,
}

/// Output of a mode at a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Demand on the loops.
    pub demand: Demand,
    /// Bit 10 of the statusword.
    pub target_reached: bool,
    /// Bit 12 of the statusword, whose meaning depends on the mode.
    pub bit_12: bool,
    /// Bit 13 of the statusword, whose meaning depends on the mode.
    pub bit_13: bool,
}
