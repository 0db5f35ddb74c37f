//! Parameters that blocks read and write, and the supervision by them.
//!
//! A command whose target is beyond a software limit is refused. A motion without such a target (endless, led by a block, or
//! superimposed) is stopped with an error as soon as the axis, braking with all it has, would only just stop before the limit.
use super::Axis;
use super::activity::{Activity, Moving};
use super::bounds::Bounds;
use super::modulo;
use crate::blocks::BlockName;
use crate::command::finite_input;
use crate::error::{AxisError, BlockError};
use crate::parameter::{AxisBoolParameter, AxisParameter};
use crate::state::AxisState;
use servobench_base::{Stateful, positive};
use servobench_motion::Limits;
use servobench_motion::online::Target;

/// Supervision set by a program.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Supervision {
    /// Limits of the position, as the program sees it: the negative and the positive one.
    software_limits: [f64; 2],
    limits_hold: [bool; 2],
    /// Largest following error.
    max_lag: f64,
    monitors_lag: bool,
}

impl Supervision {
    /// Initial supervision of an axis.
    pub(super) const NONE: Self = Self {
        software_limits: [f64::NEG_INFINITY, f64::INFINITY],
        limits_hold: [false; 2],
        max_lag: f64::INFINITY,
        monitors_lag: false,
    };

    /// Limit that `position` exceeds, and the direction of the excess, 1 or −1.
    fn passed(&self, position: f64) -> Option<(f64, f64)> {
        let [lowest, highest] = self.software_limits;
        match self.limits_hold {
            [true, _] if position < lowest => Some((lowest, -1.0)),
            [_, true] if position > highest => Some((highest, 1.0)),
            _ => None,
        }
    }
}

impl Axis {
    /// Value of a numeric parameter (SI); infinite if there is no limit.
    pub(crate) fn parameter(&self, parameter: AxisParameter) -> f64 {
        let (limits, system) = (&self.params.limits, &self.system_limits);
        match parameter {
            AxisParameter::CommandedPosition => {
                let position = self.commanded().x;
                self.params.modulo.map_or(position, |period| modulo::within(position, period))
            }
            AxisParameter::PositiveLimit => self.supervision.software_limits[1],
            AxisParameter::NegativeLimit => self.supervision.software_limits[0],
            AxisParameter::MaxLag => self.supervision.max_lag,
            AxisParameter::MaxVelocitySystem => system.velocity,
            AxisParameter::MaxVelocity => limits.velocity,
            AxisParameter::ActualVelocity => self.feedback.velocity,
            AxisParameter::CommandedVelocity => self.setpoint.v,
            AxisParameter::MaxAccelerationSystem | AxisParameter::MaxDecelerationSystem => system.acceleration,
            AxisParameter::MaxAcceleration | AxisParameter::MaxDeceleration => limits.acceleration,
            AxisParameter::MaxJerkSystem => system.jerk,
            AxisParameter::MaxJerk => limits.jerk,
        }
    }

    /// Value of a BOOL parameter.
    pub(crate) const fn bool_parameter(&self, parameter: AxisBoolParameter) -> bool {
        match parameter {
            AxisBoolParameter::EnablePositiveLimit => self.supervision.limits_hold[1],
            AxisBoolParameter::EnableNegativeLimit => self.supervision.limits_hold[0],
            AxisBoolParameter::EnableLagMonitoring => self.supervision.monitors_lag,
        }
    }

    /// Writes a numeric parameter. The limits of motions change only while there is no motion.
    pub(crate) fn write_parameter(
        &mut self,
        block: BlockName,
        parameter: AxisParameter,
        value: f64,
    ) -> Result<(), BlockError> {
        let Limits { velocity, acceleration, jerk, snap } = self.params.limits;
        let system = self.system_limits;
        let [lowest, highest] = self.supervision.software_limits;
        match parameter {
            AxisParameter::PositiveLimit => self.set_software_limits(block, value, [lowest, value]),
            AxisParameter::NegativeLimit => self.set_software_limits(block, value, [value, highest]),
            AxisParameter::MaxLag => {
                self.supervision.max_lag = above_zero(block, value)?;
                Ok(())
            }
            AxisParameter::MaxVelocity => {
                let velocity = up_to(block, value, system.velocity)?;
                self.set_limits(block, Limits { velocity, acceleration, jerk, snap })
            }
            AxisParameter::MaxAcceleration => {
                let acceleration = up_to(block, value, system.acceleration)?;
                self.set_limits(block, Limits { velocity, acceleration, jerk, snap })
            }
            AxisParameter::MaxJerk => {
                let jerk = up_to(block, value, system.jerk)?;
                self.set_limits(block, Limits { velocity, acceleration, jerk, snap })
            }
            AxisParameter::CommandedPosition
            | AxisParameter::MaxVelocitySystem
            | AxisParameter::ActualVelocity
            | AxisParameter::CommandedVelocity
            | AxisParameter::MaxAccelerationSystem
            | AxisParameter::MaxDecelerationSystem
            | AxisParameter::MaxDeceleration
            | AxisParameter::MaxJerkSystem => Err(BlockError::ReadOnly { block, parameter }),
        }
    }

    /// Writes a BOOL parameter.
    pub(crate) const fn write_bool_parameter(&mut self, parameter: AxisBoolParameter, value: bool) {
        match parameter {
            AxisBoolParameter::EnablePositiveLimit => self.supervision.limits_hold[1] = value,
            AxisBoolParameter::EnableNegativeLimit => self.supervision.limits_hold[0] = value,
            AxisBoolParameter::EnableLagMonitoring => self.supervision.monitors_lag = value,
        }
    }

    fn set_software_limits(&mut self, block: BlockName, value: f64, limits: [f64; 2]) -> Result<(), BlockError> {
        finite_input(block, "Value", value)?;
        if limits[0] >= limits[1] {
            let bound = "such that SWLimitNeg is below SWLimitPos";
            return Err(BlockError::Input { block, input: "Value", value, bound });
        }
        self.supervision.software_limits = limits;
        Ok(())
    }

    fn set_limits(&mut self, block: BlockName, limits: Limits) -> Result<(), BlockError> {
        if !matches!(self.activity, Activity::Rest) || self.superimposed.is_some() {
            return Err(BlockError::State { block, state: self.state });
        }
        self.params.limits = limits;
        Ok(())
    }

    /// Checks a position in the unit of the drive against the software limits.
    pub(super) fn check_software_limits(&self, block: BlockName, position: f64) -> Result<(), BlockError> {
        let value = position + self.offset;
        match self.supervision.passed(value) {
            Some((limit, _)) => Err(BlockError::SoftwareLimit { block, value, limit }),
            None => Ok(()),
        }
    }

    /// Stops an axis that is about to exceed a software limit.
    pub(super) fn watch_software_limits(&mut self) {
        let is_motion = matches!(self.state, AxisState::DiscreteMotion | AxisState::ContinuousMotion);
        let leads_to_a_target =
            matches!(&self.activity, Activity::Moving(Moving { target: Target::Position { v: 0.0, .. }, .. }));
        if self.supervision.limits_hold == [false; 2] || !is_motion || leads_to_a_target && self.superimposed.is_none()
        {
            return;
        }
        // The next cycle would be too late; a trajectory that cannot be planned counts as over.
        let next = self.setpoint.after(self.params.cycle_time);
        let bounds = Bounds::of_axis(&self.params.limits).faster(next.v.abs());
        let stop = next.x + self.offset + bounds.covered(&next, 0.0).unwrap_or(0.0);
        // An axis beyond a limit may come back.
        if let Some((limit, direction)) = self.supervision.passed(stop)
            && direction * next.v > 0.0
        {
            self.fail(AxisError::SoftwareLimit { limit });
        }
    }

    /// Stops an axis whose following error is too large.
    pub(super) fn watch_lag(&mut self) {
        let (lag, limit) = (self.feedback.following_error, self.supervision.max_lag);
        let is_following = matches!(
            self.state,
            AxisState::Standstill | AxisState::DiscreteMotion | AxisState::ContinuousMotion | AxisState::Stopping
        );
        if self.supervision.monitors_lag && is_following && lag.abs() > limit {
            self.fail(AxisError::PositionLag { lag, limit });
        }
    }
}

fn above_zero(block: BlockName, value: f64) -> Result<f64, BlockError> {
    positive("Value", value).map_err(|_| BlockError::Input { block, input: "Value", value, bound: "positive" })
}

/// A limit of motions, at most the system limit.
fn up_to(block: BlockName, value: f64, limit: f64) -> Result<f64, BlockError> {
    if above_zero(block, value)? > limit {
        return Err(BlockError::AboveLimit { block, input: "Value", value, limit });
    }
    Ok(value)
}
