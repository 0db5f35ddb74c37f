//! A mode in which a load follows a motor that is held to its position.

use crate::state::Stateful;
/// A mode in which a load follows a motor that is held to its position: it is at Σ `weight`·z of all modes, with
/// z″ + `decay`·z′ + ω²·(z − y − `lead`·y′) = 0 where the motor is at y (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct HeldMode {
    /// Share of the motor's position; those of all modes add up to 1.
    pub weight: f64,
    /// Undamped frequency ω (rad/s).
    pub omega: f64,
    /// 2·ζ·ω (1/s).
    pub decay: f64,
    /// Damping of the coupling behind the motor by its stiffness (s).
    pub lead: f64,
}
