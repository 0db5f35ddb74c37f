//! A profile that the drive generates itself: what its modes need to be told.
//!
//! In profile position a set-point is handed over by bit 4 of the controlword and bit 12 of the statusword (IEC 61800-7-201,
//! profile position mode): bit 4 rises with the target, bit 12 answers, both fall, and the next one can come.
use super::frame::set_target;
use super::{Params, State};
use crate::{LinkFault, ProfileCommand, ProfileFeedback, TrajectoryPoint};
use servobench_base::Stateful;
use servobench_cia402::{Actuals, Mode, StatusBit};

/// What a link remembers of it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct DriveProfile {
    /// Whether the command is one that was not there at the last step.
    pub(super) has_news: bool,
    /// Number of the set-point that the drive has taken.
    acknowledged: u32,
    starts: bool,
}

impl DriveProfile {
    /// Another task has begun.
    pub(super) const fn restart(&mut self) {
        (self.acknowledged, self.starts) = (0, false);
    }

    pub(super) const fn asks_to_start(self) -> bool {
        self.starts
    }

    pub(super) const fn feedback(self, actuals: &Actuals) -> ProfileFeedback {
        ProfileFeedback {
            acknowledged: self.acknowledged,
            target_reached: actuals.statusword.has(StatusBit::TargetReached),
            is_active: actuals.statusword.has(StatusBit::ModeSpecific12),
            buffer_free: actuals.buffer_free,
            buffer_status: actuals.buffer_status,
        }
    }

    /// A step of the handshake for set-point `number`.
    const fn hand_over(&mut self, number: u32, acknowledges: bool) {
        if self.starts && acknowledges {
            (self.acknowledged, self.starts) = (number, false);
        } else if !self.starts && !acknowledges && number != self.acknowledged {
            self.starts = true;
        }
    }
}

/// The mode that makes the way.
pub(super) const fn mode(way: &ProfileCommand) -> Mode {
    match way {
        ProfileCommand::Position { .. } => Mode::ProfilePosition,
        ProfileCommand::Velocity { .. } => Mode::ProfileVelocity,
        ProfileCommand::Points { .. } => Mode::InterpolatedPosition,
    }
}

impl State {
    /// Leaves `way` to the drive.
    pub(super) fn leave(&mut self, p: &Params, way: &ProfileCommand, follows: bool) {
        (self.commands.trajectory_point, self.commands.interpolation_data) = (None, None);
        if !follows {
            self.drive_profile.starts = false;
            return;
        }
        let rate = |rate: f64| p.scale.rate(rate);
        match *way {
            ProfileCommand::Position { number, position, velocity, acceleration } => {
                let acknowledges = self.actuals.statusword.has(StatusBit::ModeSpecific12);
                self.drive_profile.hand_over(number, acknowledges);
                match p.scale.counts(position) {
                    Some(counts) => set_target(&mut self.commands, p.scale.counter(), counts.into()),
                    None => self.fault = self.fault.or(Some(LinkFault::Command)),
                }
                self.commands.profile_velocity = rate(velocity);
                self.set_acceleration(rate(acceleration));
            }
            ProfileCommand::Velocity { velocity, acceleration } => {
                self.drive_profile.starts = false;
                match p.scale.drive_velocity(velocity) {
                    Some(velocity) => self.commands.target_velocity = velocity,
                    None => self.fault = self.fault.or(Some(LinkFault::Command)),
                }
                self.set_acceleration(rate(acceleration));
            }
            ProfileCommand::Points { point, follow } => {
                self.drive_profile.starts = follow;
                match point.filter(|_| self.drive_profile.has_news) {
                    Some(TrajectoryPoint::MoveSegment(bytes)) => self.commands.trajectory_point = Some(bytes),
                    Some(TrajectoryPoint::DataRecord(data)) => self.commands.interpolation_data = Some(data),
                    None => {}
                }
            }
        }
    }

    const fn set_acceleration(&mut self, acceleration: u32) {
        (self.commands.profile_acceleration, self.commands.profile_deceleration) = (acceleration, acceleration);
    }
}
