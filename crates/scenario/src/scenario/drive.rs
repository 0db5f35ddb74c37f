//! The firmware of the drive.
use super::motor::{Encoder, Pmsm};
use servobench_base::Rate;

/// The drive's firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Whether the power stage is on. Off: no current, no force, and the axis is free.
    pub enabled: bool,
    /// DC-link voltage (V); infinite without a limit.
    pub dc_link: f64,
    /// Largest effort it asks for (motor coordinate); infinite without a limit.
    pub max_effort: f64,
    /// Current loop; `None` for an ideal source.
    pub current: Option<CurrentLoop>,
    /// Velocity loop.
    pub velocity: VelocityLoop,
    /// Position loop.
    pub position: PositionLoop,
    /// Feedforward.
    pub feedforward: Feedforward,
    /// What the firmware believes of the axis.
    pub estimate: Estimate,
    /// Encoder on the load, when the axis has one.
    pub load_encoder: Option<Encoder>,
    /// Which encoder closes the position loop.
    pub position_feedback: Feedback,
}

/// Encoder that closes a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feedback {
    /// Motor encoder.
    Motor,
    /// Load encoder.
    Load,
}

/// Current loop in dq.
#[derive(Debug, Clone, PartialEq)]
pub struct CurrentLoop {
    /// Task rate.
    pub rate: Rate,
    /// Closed-loop bandwidth (rad/s); gains are derived from it and the estimated motor.
    pub bandwidth: f64,
    /// Proportional gains (V/A) d and q, when given instead of derived.
    pub gain: Option<(f64, f64)>,
    /// Integral times (s) d and q, when given.
    pub integral_time: Option<(f64, f64)>,
}

/// Velocity loop.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain in effort per velocity of the motor coordinate (N·s/m or N·m·s/rad).
    pub gain: f64,
    /// Integral time (s); `None` for a P controller.
    pub integral_time: Option<f64>,
    /// Time constant of the low-pass on the measured velocity (s); 0 for none.
    pub filter_time: f64,
}

/// Position loop.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain, `K_v` (1/s).
    pub gain: f64,
}

/// Feedforward.
#[derive(Debug, Clone, PartialEq)]
pub struct Feedforward {
    /// Share of the reference velocity that is fed forward, 0 to 1.
    pub velocity: f64,
    /// Model behind the effort feedforward.
    pub effort: EffortFeedforward,
    /// Whether estimated Coulomb friction and bias are fed forward too.
    pub friction: bool,
    /// How long the reference waits for the feedforward path (s); `None`: as long as the effort path takes.
    pub delay: Option<f64>,
}

/// Model behind the effort feedforward.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EffortFeedforward {
    /// None.
    Off,
    /// One rigid body: inertia and viscous friction.
    Rigid,
    /// Two bodies and a spring: velocity, acceleration, jerk and snap; the set-point is the load's.
    TwoMass,
}

/// What the firmware believes, all in the axis coordinate unless said otherwise. The tool fills it from the plant;
/// a scenario overrides single values to express mismatch.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Mass or inertia on the motor's side of the spring (two-mass), rotor included.
    pub motor_inertia: f64,
    /// Mass or inertia beyond the spring; 0 for a rigid axis.
    pub load_inertia: f64,
    /// Spring stiffness (N/m or N·m/rad); infinite for a rigid axis.
    pub stiffness: f64,
    /// Viscous friction on the motor's side.
    pub motor_viscous: f64,
    /// Viscous friction on the load.
    pub load_viscous: f64,
    /// Coulomb friction, all bodies.
    pub coulomb: f64,
    /// Constant resisting effort, all bodies.
    pub bias: f64,
    /// Motor as the firmware knows it; `None` for an ideal source.
    pub motor: Option<Pmsm>,
}
