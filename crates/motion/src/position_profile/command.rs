//! What the drive is told.

/// A command of the profile velocity mode: from `t` on go to `velocity` with `acceleration`, then stay there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// Time at which it is sent (s).
    pub t: f64,
    /// Velocity to reach (m/s or rad/s).
    pub velocity: f64,
    /// Magnitude of acceleration and deceleration alike (m/s² or rad/s²); zero if the velocity stays what it is.
    pub acceleration: f64,
}
