//! Velocity commands to a drive in profile velocity mode (pv): from the set-point of the previous cycle to that of this one.
//!
//! The drive ramps linearly to each velocity and reaches it a cycle later: it then has velocity v of the set-point, as a drive in
//! position mode has its position. Its own position is the trapezoidal sum of these velocities, off by a fraction of the square of the
//! cycle (see [`Stepped`](servobench_motion::position_profile::Stepped)), and is not corrected.
//!
//! A block that leads the axis along linear velocity ramps of several cycles sends them itself: one command for each.
use super::Axis;
use crate::ledger::CommandId;
use crate::params::RampStart;
use servobench_base::Stateful;
use servobench_fieldbus::ProfileCommand;
use servobench_motion::position_profile::VelocityRamp;

/// Present and previous velocity commands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct VelocityCommands {
    /// Velocity of the previous set-point (m/s or rad/s).
    before: f64,
    /// Ramp of a block that leads to the set-point of this cycle, and of the cycle before.
    ramps: [Option<VelocityRamp>; 2],
    /// Acceleration of the last command that changed the velocity (m/s² or rad/s²); before one, 0, which leaves it to the drive.
    acceleration: f64,
}

impl Axis {
    /// Leads the axis along `ramp` to the set-point of this cycle for the active command `id`; called beside [`lead`](Self::lead).
    pub(crate) fn lead_along(&mut self, id: CommandId, ramp: Option<VelocityRamp>) {
        if self.led_cycles(id).is_some() {
            self.velocity_commands.ramps[0] = ramp;
        }
    }

    /// Command to the drive in this cycle.
    pub(super) fn velocity_command(&mut self, start: RampStart) -> ProfileCommand {
        let VelocityCommands { before, ramps: [led, last], acceleration } = &mut self.velocity_commands;
        if self.superimposed.is_some() {
            // A superimposed motion is not in the block's ramps.
            *led = None;
        }
        let step = VelocityRamp { begin: 0.0, length: self.params.cycle_time, from: *before, to: self.setpoint.v };
        let ramp = led.unwrap_or(step);
        if led.is_none() || led != last {
            let from = match start {
                RampStart::SetPoint => ramp.from,
                RampStart::Actual => self.feedback.velocity,
            };
            let needed = VelocityRamp { from, ..ramp }.command().acceleration;
            if needed > 0.0 {
                *acceleration = needed;
            }
        }
        ProfileCommand::Velocity { velocity: ramp.to, acceleration: *acceleration }
    }

    /// Ends the cycle.
    pub(super) const fn end_velocity_command(&mut self) {
        let VelocityCommands { before, ramps, .. } = &mut self.velocity_commands;
        (*before, *ramps) = (self.setpoint.v, [None, ramps[0]]);
    }
}
