//! An axis whose drive is told velocities (profile velocity, pv): from the set-point of the cycle before to that of this one.
//!
//! The drive goes to each velocity in a straight line, and is there a cycle later: at velocity v of the set-point, as one that is told
//! positions is at its position. Its own position is what the trapezoidal rule makes of these velocities, a fraction of the square of the
//! cycle off ([`Stepped`](servobench_motion::position_profile::Stepped) says which), and nobody brings it back.
//!
//! A block that leads the axis along straight lines of velocity which take several cycles gives them itself: one command for each.
use super::Axis;
use crate::ledger::CommandId;
use crate::params::RampStart;
use servobench_base::Stateful;
use servobench_fieldbus::ProfileCommand;
use servobench_motion::position_profile::VelocityRamp;

/// What the drive is told, and was told before.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct VelocityCommands {
    /// Velocity of the set-point before (m/s or rad/s).
    before: f64,
    /// The line of a block that leads to the set-point of this cycle, and to that of the cycle before.
    ramps: [Option<VelocityRamp>; 2],
    /// Acceleration of the last command that changed the velocity (m/s² or rad/s²); 0, which leaves it to the drive, before it.
    acceleration: f64,
}

impl Axis {
    /// The block of the active command `id` goes along `ramp` to the set-point of this cycle: called beside [`lead`](Self::lead).
    pub(crate) fn lead_along(&mut self, id: CommandId, ramp: Option<VelocityRamp>) {
        if self.led_cycles(id).is_some() {
            self.velocity_commands.ramps[0] = ramp;
        }
    }

    /// What the drive is told in this cycle.
    pub(super) fn velocity_command(&mut self, start: RampStart) -> ProfileCommand {
        let VelocityCommands { before, ramps: [led, last], acceleration } = &mut self.velocity_commands;
        if self.superimposed.is_some() {
            // What is on top of the block's motion is not in its lines.
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

    /// The cycle is over.
    pub(super) const fn end_velocity_command(&mut self) {
        let VelocityCommands { before, ramps, .. } = &mut self.velocity_commands;
        (*before, *ramps) = (self.setpoint.v, [None, ramps[0]]);
    }
}
