//! Modes of operation (CiA 402): from what the master sends to what the loops are to do.
//!
//! A mode sees a [`Moment`] and gives an [`Answer`], once per period of the position loop. Positions and velocities are in
//! the axis unit (m or rad), efforts in the motor's (N·m or N): drive units end at the bus interface.
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

/// What a mode sees at a step of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Moment {
    /// What the master sends.
    pub targets: Targets,
    /// What the drive measures.
    pub actual: Actual,
    /// What the loops follow now if they go on as at the last step: where a mode that takes over begins. Where no demand
    /// says so, it is where the axis is.
    pub demanded: Setpoint,
    /// Time since the last step (s).
    pub period: f64,
}

/// What the master sends.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Targets {
    /// With the bits that a mode gives a meaning of its own.
    pub controlword: Controlword,
    /// Target position (607Ah), in csp with the position offset (60B0h).
    pub position: f64,
    /// Target position (607Ah) as a distance, for set-points that are relative.
    pub distance: f64,
    /// Target velocity (60FFh).
    pub velocity: f64,
    /// Target effort (6071h).
    pub effort: f64,
    /// Added to what the position loop asks for (60B1h).
    pub velocity_offset: f64,
    /// Added to what the velocity loop asks for (60B2h).
    pub effort_offset: f64,
    /// Highest velocity of a profile (6081h), a magnitude.
    pub profile_velocity: f64,
    /// Acceleration of a profile (6083h), a magnitude.
    pub profile_acceleration: f64,
    /// Deceleration of a profile (6084h), a magnitude.
    pub profile_deceleration: f64,
    /// Position that the reference gets when it is found (607Ch).
    pub home_offset: f64,
    /// Whether the frame that brought these came since the last step.
    pub is_new: bool,
}

/// What the drive measures.
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
    /// Position at which the last index pulse came, when one came since the last step.
    pub index: Option<f64>,
}

/// What a mode says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// For the loops.
    pub demand: Demand,
    /// Bit 10 of the statusword.
    pub target_reached: bool,
    /// Bit 12 of the statusword, whose meaning depends on the mode.
    pub bit_12: bool,
    /// Bit 13 of the statusword, whose meaning depends on the mode.
    pub bit_13: bool,
}
