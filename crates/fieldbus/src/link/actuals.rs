//! Input of the link: the answer of the drive, and the command of the motion task.
use super::mailbox::{Letter, Mailbox};
use super::position::Position;
use super::stream::{Arrival, Post};
use super::{Params, State};
use crate::{LinkFault, Task};
use servobench_cia402::Actuals;
use servobench_motion::interpolate::Sample;

impl State {
    pub(super) fn receive(&mut self, p: &Params, actuals: Option<Actuals>, now: u64) {
        let Some(actuals) = actuals else { return };
        (self.actuals, self.received_at) = (actuals, now);
        self.sequencer.receive(actuals.statusword, now);
        let followed = match &mut self.position {
            Some(position) => position.follow(&p.scale, &actuals, now),
            none => Position::start(&p.scale, &actuals, now).map(|position| *none = Some(position)),
        };
        if followed.is_err() {
            self.fault = self.fault.or(Some(LinkFault::PositionLost));
        }
    }

    /// Reads the command, and its sample if there is a new one.
    pub(super) fn open(&mut self, p: &Params, mailbox: &Mailbox, now: u64) -> Post {
        self.drive_profile.has_news = false;
        let Some(Letter { number, tick, command }) = mailbox.read() else { return Post::Torn };
        if number == self.read {
            return Post::Nothing;
        }
        let missed = number.wrapping_sub(self.read).saturating_sub(1);
        self.read = number;
        self.drive_profile.has_news = true;
        if command.reset && !self.command.reset {
            self.reset(p);
        }
        if core::mem::discriminant(&command.task) != core::mem::discriminant(&self.command.task) {
            self.homing.leave(now);
            self.drive_profile.restart();
        }
        let (before, sample) = (self.command, command.task);
        self.command = command;
        match sample {
            Task::Follow(sample) if is_followable(p, &sample) => Post::Sample(Arrival { sample, due: tick, missed }),
            Task::Effort(effort) if p.scale.thousandths(effort).is_some() => {
                let sample = Sample { torque: effort, ..Sample::default() };
                Post::Sample(Arrival { sample, due: tick, missed })
            }
            Task::Home { .. } | Task::Drive(_) => Post::Nothing,
            Task::Follow(_) | Task::Effort(_) => {
                self.command.task = before.task;
                self.fault = self.fault.or(Some(LinkFault::Command));
                Post::Nothing
            }
        }
    }

    pub(super) fn reset(&mut self, p: &Params) {
        self.sequencer.reset();
        if self.fault == Some(LinkFault::PositionLost) {
            self.position = Position::start(&p.scale, &self.actuals, self.received_at).ok();
        }
        self.fault = None;
    }
}

/// True if the axis can follow a sample: its numbers fit the drive's units, and neither its velocity nor the change of velocity by its
/// acceleration within a cycle is beyond twice the velocity limit.
fn is_followable(p: &Params, sample: &Sample) -> bool {
    let Sample { x, v, a, torque } = *sample;
    let highest = 2.0 * p.settings.velocity_limit;
    let within = |v: f64| v.abs() <= highest;
    p.scale.counts(x).is_some() && within(v) && within(a * p.cycle) && p.scale.thousandths(torque).is_some()
}
