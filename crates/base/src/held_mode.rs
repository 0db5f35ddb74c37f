//! A mode of a load behind a motor that is held in position.

use crate::state::Stateful;
/// A mode of a load behind a motor that is held in position: the load is at Σ `weight`·z over all modes, with
/// z″ + `decay`·z′ + ω²·(z − y − `lead`·y′) = 0 for the motor position y (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct HeldMode {
    /// Share of the motor's position; those of all modes add up to 1.
    pub weight: f64,
    /// Undamped frequency ω (rad/s).
    pub omega: f64,
    /// 2·ζ·ω (1/s).
    pub decay: f64,
    /// Damping of the coupling to the motor divided by its stiffness (s).
    pub lead: f64,
}
