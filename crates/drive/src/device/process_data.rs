//! Bus interface of the drive: conversion of frames to targets, and of measurements to frames.
//!
//! Values of a frame beyond the limits are cut, and the drive reports it (bit 11): targets of csp and pp to the software limits (607Dh),
//! profile velocities to the highest one (607Fh, 6080h), accelerations to theirs (60C5h, 60C6h). Efforts are limited by the loops, in every
//! mode, to the lower of the settings (6072h, 60E0h, 60E1h) and of the frame (6072h). A profile velocity, acceleration or deceleration of
//! zero stands for a value that is not in the frame: that of the settings applies.
use super::{Fault, Params, State};
use crate::Demand;
use crate::modes::interpolated::RecordError;
use crate::modes::{Actual, Targets};
use servobench_cia402::interpolated::SegmentCommand;
use servobench_cia402::{Actuals, Commands, InterpolationData, Mode};

impl State {
    /// The frame for the master, as of the last step.
    #[must_use]
    pub fn actuals(&self, p: &Params) -> Actuals {
        let Actual { velocity, effort, negative_limit, positive_limit, home, .. } = self.now.actual;
        let demand = match &self.last {
            Demand::Position { setpoint, .. } => p.units.position_at(setpoint.x),
            Demand::Velocity { .. } | Demand::Effort(_) | Demand::Off => self.position(p),
        };
        let shown = |position: i64| p.counter.words(p.shown(position));
        let ([position, position_high], [position_demand, position_demand_high]) =
            (shown(self.position(p)), shown(demand));
        // The inputs as wired: the master has to know the wiring.
        let closed = |is_met: bool, bit: u32| u32::from(is_met != p.reverse_switches) << bit;
        let follows_position = matches!(self.last, Demand::Position { .. });
        Actuals {
            statusword: self.statusword,
            mode: self.mode.map_or(0, Mode::code),
            position,
            position_high,
            position_demand,
            position_demand_high,
            velocity: p.units.velocity(velocity),
            torque: p.units.effort(effort),
            following_error: if follows_position { p.units.distance(self.following_error) } else { 0 },
            error_code: self.fault.map_or(0, Fault::code),
            digital_inputs: closed(negative_limit, 0) | closed(positive_limit, 1) | closed(home, 2),
            buffer_free: u16::try_from(self.buffer.free()).unwrap_or(u16::MAX),
            buffer_status: self.buffer.status(),
            touch_probe_status: self.probe.status(),
            touch_probe_positions: self.probe.positions(p),
        }
    }

    /// Position in user-defined units, of which the counter of the bus shows the low part.
    fn position(&self, p: &Params) -> i64 {
        p.units.position(self.increments.wrapping_sub(self.origin))
    }

    /// Converts a frame.
    pub(super) fn take(&mut self, p: &Params, frame: &Commands) {
        self.wanted = Mode::from_code(frame.mode);
        (self.probe_function, self.digital_outputs) = (frame.touch_probe_function, frame.digital_outputs);
        if let Some(bytes) = frame.trajectory_point {
            // Errors of the buffer itself are latched in its status (2012h).
            self.has_refused_point = match SegmentCommand::decode(bytes) {
                Ok(command) => self.buffer.apply(command).is_err(),
                Err(_) => true,
            };
        }
        if let Some(data) = frame.interpolation_data {
            self.has_refused_point = self.record(p, data).is_err();
        }
        let here = self.position(p);
        let offset = match self.wanted {
            Some(Mode::CyclicSynchronousPosition) => frame.position_offset,
            _ => 0,
        };
        let asked = p.target(frame) + i128::from(offset);
        let target = match self.wanted {
            Some(Mode::ProfilePosition) => i128::from(here) - p.shown(here) + p.counter.wrap(asked),
            _ => p.nearest(asked, here),
        };
        let position = p.units.from_position(saturated(target));
        let kept = p.limits.position.map_or(position, |[lowest, highest]| position.clamp(lowest, highest));
        let rate = |units: u32, set: f64| if units == 0 { set } else { p.units.from_rate(units) };
        let velocity = rate(frame.profile_velocity, p.profile.velocity);
        let acceleration = rate(frame.profile_acceleration, p.profile.acceleration);
        let deceleration = rate(frame.profile_deceleration, p.profile.deceleration);
        let (profile_limit, limits) = (p.profile_limit(), &p.limits);
        // A master that does not limit the torque leaves it to the settings.
        let max_effort = frame.max_torque.map_or(f64::INFINITY, |thousandths| p.units.effort_magnitude(thousandths));
        self.effort_limits = limits.effort.at_most(max_effort);
        let is_too_steep = acceleration > limits.acceleration || deceleration > limits.deceleration;
        self.is_cut = match self.wanted {
            Some(Mode::CyclicSynchronousPosition) => kept.to_bits() != position.to_bits(),
            Some(Mode::ProfilePosition) => is_too_steep || velocity > profile_limit,
            Some(Mode::ProfileVelocity) => is_too_steep,
            _ => false,
        };
        self.now.targets = Targets {
            controlword: frame.controlword,
            position: if self.wanted == Some(Mode::ProfilePosition) { position } else { kept },
            distance: p.units.from_position(saturated(p.target(frame))),
            velocity: p.units.from_velocity(frame.target_velocity),
            effort: p.units.from_effort(frame.target_torque),
            velocity_offset: p.units.from_velocity(frame.velocity_offset),
            effort_offset: p.units.from_effort(frame.torque_offset),
            profile_velocity: velocity.min(profile_limit),
            profile_acceleration: acceleration.min(limits.acceleration),
            profile_deceleration: deceleration.min(limits.deceleration),
            home_offset: p.units.from_position(frame.home_offset.into()),
            is_new: true,
        };
    }

    /// Writes the data record (60C1h), sub-index by sub-index.
    fn record(&mut self, p: &Params, data: InterpolationData) -> Result<(), RecordError> {
        let InterpolationData { position, time, velocity } = data;
        let values = [Some(position), time.map(i32::from), velocity];
        for (sub_index, value) in (1..).zip(values) {
            if let Some(value) = value {
                self.data_record.write(p.sub_mode, p.segment, &mut self.buffer, sub_index, value)?;
            }
        }
        Ok(())
    }
}

impl Params {
    /// Target position as a signed integer: of 32 bits, or of 64 with a wider counter.
    fn target(&self, frame: &Commands) -> i128 {
        let (low, high) = (frame.target_position, i128::from(frame.target_position_high));
        if self.counter.range() > 1 << i32::BITS { high << 32 | i128::from(low.cast_unsigned()) } else { low.into() }
    }
}

/// Nearest integer of 64 bits.
fn saturated(units: i128) -> i64 {
    i64::try_from(units).unwrap_or(if units < 0 { i64::MIN } else { i64::MAX })
}
