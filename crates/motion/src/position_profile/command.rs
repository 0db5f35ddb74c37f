//! Commands to the drive.

use servobench_base::Stateful;
/// A command of the profile velocity mode: from `t` on change to `velocity` with `acceleration`, then stay there.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Command {
    /// Time at which it is sent (s).
    pub t: f64,
    /// Velocity to reach (m/s or rad/s).
    pub velocity: f64,
    /// Magnitude of both acceleration and deceleration (m/s² or rad/s²); zero if the velocity does not change.
    pub acceleration: f64,
}

/// A linear change of velocity: the response of a drive to a [`Command`] received at `begin` and completed after `length`.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct VelocityRamp {
    /// Start (s).
    pub begin: f64,
    /// Duration (s), above zero.
    pub length: f64,
    /// Velocity at its beginning (m/s or rad/s).
    pub from: f64,
    /// Velocity at its end (m/s or rad/s).
    pub to: f64,
}

impl VelocityRamp {
    /// End (s).
    #[must_use]
    pub fn end(&self) -> f64 {
        self.begin + self.length
    }

    /// Acceleration with its sign (m/s² or rad/s²).
    #[must_use]
    pub fn slope(&self) -> f64 {
        (self.to - self.from) / self.length
    }

    /// The command for it, sent at its beginning.
    #[must_use]
    pub fn command(&self) -> Command {
        Command { t: self.begin, velocity: self.to, acceleration: self.slope().abs() }
    }
}
