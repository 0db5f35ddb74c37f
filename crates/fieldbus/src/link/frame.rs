//! Output of the link: the frame for the drive.
//!
//! Torques are whole thousandths of the rated one (6071h, 60B2h), often coarser than the feedforward of an axis model. The rounding error
//! of one is carried into the next, so that their mean is exact: the axis integrates them twice and hardly sees the steps.
use super::drive_profile;
use super::effort::Ramp;
use super::position::Position;
use super::position_loop::Law;
use super::stream::Post;
use super::{Control, Params, Sequencing, State};
use crate::{LinkFault, Task};
use servobench_base::Setpoint;
use servobench_cia402::counter::Counter;
use servobench_cia402::{Commands, Mode};
use servobench_motion::interpolate;

impl State {
    /// Requests the mode that the task needs, and supervises the time for the change.
    pub(super) fn ask_for_the_mode(&mut self, p: &Params, now: u64) {
        let mode = match (&self.command.task, &p.settings.control) {
            _ if self.homing.is_interrupted() => Mode::Homing,
            (Task::Follow(_), Control::Position { .. }) => Mode::CyclicSynchronousPosition,
            (Task::Follow(_), Control::Velocity { .. }) => Mode::CyclicSynchronousVelocity,
            (Task::Effort(_), _) => Mode::CyclicSynchronousTorque,
            (Task::Home { .. }, _) => Mode::Homing,
            (Task::Drive(way), _) => drive_profile::mode(way),
        };
        if self.commands.mode != mode.code() {
            (self.commands.mode, self.mode_since) = (mode.code(), now);
        }
        if !self.was_on || self.is_in_mode(p) {
            self.in_mode_or_off = now;
        }
        if now.saturating_sub(self.in_mode_or_off) > p.settings.drive_timeout {
            self.fault = self.fault.or(Some(LinkFault::DriveTimeout));
        }
    }

    /// True if the drive shows the requested mode, in an answer that reflects the request; the simplified sequence does not check.
    fn is_in_mode(&self, p: &Params) -> bool {
        p.settings.sequencing == Sequencing::Simplified
            || self.actuals.mode == self.commands.mode && self.mode_since + p.round_trip <= self.received_at
    }

    /// True if the drive follows the task.
    pub(super) fn follows(&self, p: &Params) -> bool {
        self.was_on && self.fault.is_none() && self.is_in_mode(p)
    }

    pub(super) fn put_out(&mut self, p: &Params, post: Post, now: u64) {
        self.end_homing(p);
        let follows = self.follows(p) && !self.homing.is_interrupted();
        self.own_effort = self.own_effort(p, follows);
        if !(follows && matches!(self.command.task, Task::Follow(_))) {
            let own = interpolate::Command { setpoint: self.own_motion(p), torque: self.own_effort };
            self.stream.switch_off(own, now);
            self.position_loop.open();
        }
        if !(follows && matches!(self.command.task, Task::Effort(_))) {
            self.ramp = Ramp::off(p.scale.effort(self.actuals.torque));
        }
        self.limited = false;
        match self.command.task {
            Task::Follow(_) if follows => self.follow(p, post, now),
            Task::Effort(_) if follows => self.push(p, post, now),
            Task::Follow(_) | Task::Effort(_) => self.rest(p),
            Task::Home { position } => {
                self.rest(p);
                self.home(p, position, follows, now);
            }
            Task::Drive(way) => {
                self.rest(p);
                self.leave(p, &way, follows);
            }
        }
    }

    pub(super) fn follow(&mut self, p: &Params, post: Post, now: u64) {
        if self.stream.step(&p.stream, post, now).is_err() {
            self.fault = self.fault.or(Some(LinkFault::Command));
        }
        self.limited = self.stream.is_limited();
        let interpolate::Command { setpoint, torque } = *self.stream.output();
        self.compare(p, &setpoint, now);
        let offset = |wanted: bool, value: f64| if wanted { value } else { 0.0 };
        let target = p.scale.counts(setpoint.x);
        let rest = &mut self.torque_rest;
        let mut sent = Sent { commands: &mut self.commands, complete: true };
        match target {
            Some(counts) => set_target(sent.commands, p.scale.counter(), counts.into()),
            None => sent.complete = false,
        }
        match p.settings.control {
            Control::Position { velocity_offset, torque_offset } => {
                let (v, torque) = (offset(velocity_offset, setpoint.v), offset(torque_offset, torque));
                sent.set(p.scale.drive_velocity(v), |commands| &mut commands.velocity_offset);
                sent.set(p.scale.thousandths_with(torque, rest), |commands| &mut commands.torque_offset);
            }
            Control::Velocity { gains, feedforward, limit, torque_offset } => {
                let law = Law { gains, feedforward, limit };
                let cycle = p.stream.bus_cycle as f64 * p.stream.timing.tick;
                let (v, is_cut) = self.position_loop.velocity(&law, setpoint.v, cycle);
                self.limited |= is_cut;
                sent.set(p.scale.drive_velocity(v), |commands| &mut commands.target_velocity);
                sent.set(p.scale.thousandths_with(offset(torque_offset, torque), rest), |commands| {
                    &mut commands.torque_offset
                });
            }
        }
        if !sent.complete {
            self.fault = self.fault.or(Some(LinkFault::Command));
        }
    }

    /// Compares the position with the delayed set-point for the position loop of the master.
    fn compare(&mut self, p: &Params, setpoint: &Setpoint, now: u64) {
        let Control::Velocity { gains, .. } = &p.settings.control else { return };
        self.position_loop.put_out(now, setpoint);
        if self.received_at == now {
            let then = now.saturating_sub(p.reference_delay);
            self.position_loop.receive(gains, self.position(p), then, now, p.stream.timing.tick);
        }
    }

    /// Commands the axis' own motion, as far as the mode of the task carries it: the position that its drive follows, its velocity, and its
    /// commanded effort.
    pub(super) fn rest(&mut self, p: &Params) {
        let ahead = self.following_error(p);
        let Setpoint { v, .. } = self.own_motion(p);
        let velocity = p.scale.nearest_velocity(v);
        let effort_offset = p.scale.thousandths(self.own_effort).unwrap_or(0);
        let commands = &mut self.commands;
        if let Some(position) = &self.position {
            let travel = v * (p.reference_delay as f64 * p.stream.timing.tick);
            let travel = p.scale.counts(travel).unwrap_or(0);
            set_target(commands, p.scale.counter(), position.counts() + ahead + i128::from(travel));
        }
        (commands.target_velocity, commands.target_torque) = (0, 0);
        (commands.velocity_offset, commands.torque_offset) = (0, 0);
        match (&self.command.task, p.settings.control) {
            (Task::Follow(_), Control::Position { velocity_offset, torque_offset }) => {
                commands.velocity_offset = if velocity_offset { velocity } else { 0 };
                commands.torque_offset = if torque_offset { effort_offset } else { 0 };
            }
            (Task::Follow(_), Control::Velocity { torque_offset, .. }) => {
                commands.target_velocity = velocity;
                commands.torque_offset = if torque_offset { effort_offset } else { 0 };
            }
            (Task::Effort(_), _) => commands.target_torque = self.actuals.torque,
            (Task::Home { .. } | Task::Drive(_), _) => {}
        }
        self.torque_rest = 0.0;
    }

    pub(super) fn push(&mut self, p: &Params, post: Post, now: u64) {
        let effort = match post {
            Post::Sample(arrival) => Some(arrival.sample.torque),
            Post::Nothing | Post::Torn => None,
        };
        let effort = self.ramp.step(&p.stream.timing, effort, now);
        let mut left = self.torque_rest;
        self.rest(p);
        // The ramp runs between efforts that fit.
        self.commands.target_torque = p.scale.thousandths_with(effort, &mut left).unwrap_or(0);
        self.torque_rest = left;
    }

    pub(super) fn home(&mut self, p: &Params, position: f64, follows: bool, now: u64) {
        let reference = p.scale.counts(position).and_then(|counts| i32::try_from(counts).ok());
        let Some(reference) = reference else {
            self.fault = self.fault.or(Some(LinkFault::Command));
            return;
        };
        self.commands.home_offset = reference;
        if !follows {
            return self.homing.fail();
        }
        // The present answer reflects commands of a round trip ago.
        if self.homing.step(self.actuals.statusword, self.received_at.saturating_sub(p.round_trip), now) {
            self.count_from_reference(p);
        }
    }

    /// Ends an interrupted homing when the drive is known to rest, or is off.
    fn end_homing(&mut self, p: &Params) {
        if !self.follows(p) {
            if self.homing.is_interrupted() && !self.was_on {
                self.homing.fail();
            }
        } else if self.homing.end(self.actuals.statusword, self.received_at.saturating_sub(p.round_trip)) {
            self.count_from_reference(p);
        }
    }

    /// Counts from the found reference: of all positions with the present reading, the nearest to the reference is taken.
    fn count_from_reference(&mut self, p: &Params) {
        let reference = self.commands.home_offset;
        match Position::near(&p.scale, reference.into(), &self.actuals, self.received_at) {
            Ok(position) => self.position = Some(position),
            Err(_) => self.fault = self.fault.or(Some(LinkFault::PositionLost)),
        }
    }
}

/// Sets the target position, in as many words as the counter needs.
pub(super) const fn set_target(commands: &mut Commands, counter: Counter, counts: i128) {
    [commands.target_position, commands.target_position_high] = counter.words(counts);
}

/// A frame under construction.
struct Sent<'a> {
    commands: &'a mut Commands,
    /// True if the drive's units could express every value; the others keep their old value.
    complete: bool,
}

impl Sent<'_> {
    fn set<T>(&mut self, value: Option<T>, object: impl FnOnce(&mut Commands) -> &mut T) {
        match value {
            Some(value) => *object(self.commands) = value,
            None => self.complete = false,
        }
    }
}
