//! What the loops said last.
use crate::feedforward::MotorReference;
use crate::{current, velocity};
use servobench_base::{Dq, Setpoint, Stateful};

/// What each loop said at its last turn, which is what a faster one and a recording see until the next.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Held {
    /// Load-side reference, delay-matched (axis coordinate).
    pub reference: Setpoint,
    /// Motor's own reference (axis coordinate).
    pub motor_reference: MotorReference,
    /// Velocity reference of the velocity loop at its last cycle (axis coordinate).
    pub velocity_reference: f64,
    /// True where the speed limit cut it.
    pub speed_is_cut: bool,
    /// Effort fed forward (motor coordinate).
    pub feedforward: f64,
    /// Effort reference (motor coordinate) and what cut it: the effort limit, or the current limit below it.
    pub effort: velocity::Output,
    /// q-axis current reference (A, peak).
    pub current_reference: f64,
    /// References of both axes (A, peak), where the d axis has no constant one.
    pub references: Dq,
    /// Output of the current loop.
    pub current: current::Output,
}
