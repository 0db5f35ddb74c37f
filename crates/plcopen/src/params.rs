//! Constant parameters of an axis.
use crate::axis::MOST_BUFFERED;
use servobench_base::{ParamError, Stateful, limit, positive};
use servobench_motion::Limits;

servobench_config::choices! {
    /// Velocity from which the acceleration of a velocity command is computed, so that the drive reaches the next velocity a cycle later.
    #[derive(Stateful)]
    pub enum RampStart default SetPoint {
        /// the velocity of the set-point before, which the drive has if it follows exactly
        SetPoint = "set-point",
        /// the velocity that the drive reports
        Actual = "actual",
    }
}

/// Parameters of an axis, in the axis unit (m or rad); constant while it runs.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct AxisParams {
    /// Time of a PLC cycle (s).
    pub cycle_time: f64,
    /// Limits of all commands. Jerk and snap may be infinite: the order of a move is the highest derivative that either the axis or the
    /// command limits.
    pub limits: Limits,
    /// True if an absolute position needs MC_Home before.
    pub needs_homing: bool,
    /// Period of the position of a modulo axis (m or rad); `None` for an axis with ends.
    pub modulo: Option<f64>,
    /// Start of the velocity ramps of an axis in velocity mode (profile velocity, pv); `None` in position mode.
    pub velocity_ramps: Option<RampStart>,
    /// Number of commands that may wait behind the active one, at most [`MOST_BUFFERED`].
    pub buffered_commands: usize,
}

impl AxisParams {
    /// An axis with ends, to be homed, which holds one buffered command.
    #[must_use]
    pub const fn new(cycle_time: f64, limits: Limits) -> Self {
        Self { cycle_time, limits, needs_homing: true, modulo: None, velocity_ramps: None, buffered_commands: 1 }
    }

    /// # Errors
    /// [`ParamError`] names the first parameter outside its bound.
    pub(crate) fn check(&self) -> Result<(), ParamError> {
        positive("cycle_time", self.cycle_time)?;
        positive("limits.velocity", self.limits.velocity)?;
        positive("limits.acceleration", self.limits.acceleration)?;
        let jerk = limit("limits.jerk", self.limits.jerk)?;
        if limit("limits.snap", self.limits.snap)? < f64::INFINITY {
            positive("limits.jerk", jerk)?;
        }
        if let Some(period) = self.modulo {
            positive("modulo", period)?;
        }
        if self.buffered_commands > MOST_BUFFERED {
            let value = self.buffered_commands as f64;
            return Err(ParamError { name: "buffered_commands", value, bound: "at most 8" });
        }
        Ok(())
    }
}
