//! Activities of the axis and their advance from cycle to cycle.
use super::Axis;
use super::obstacle::{HomingSteps, Search};
use super::queue::Queue;
use super::run::Run;
use crate::arrows::{Cause, arrow};
use crate::command::{BufferMode, Command, Reference};
use crate::error::{AxisError, BlockError};
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::{Setpoint, Stateful};
use servobench_fieldbus::Homing;
use servobench_motion::online::Target;

/// Activity of the axis.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) enum Activity {
    /// Nothing.
    Rest,
    /// Follows a planned trajectory.
    Moving(Moving),
    /// Gives an effort.
    Effort(EffortRamp),
    /// Waits while the drive searches for its reference.
    Homing(HomingWait),
    /// Searches for an obstacle.
    Search(Search),
    /// Waits for the drive to end a reference run from which another command has taken the axis.
    Leaving(Leaving),
    /// A block gives the set-points.
    Led(Led),
}

/// A command on its planned trajectory.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct Moving {
    pub(super) id: CommandId,
    pub(super) command: Command,
    /// Target, in the unit of the drive and without the override.
    pub(super) target: Target,
    /// Position from which a distance counts: that at the start, or the target before it.
    pub(super) origin: f64,
    /// True if the command rests because of a velocity override of zero.
    pub(super) is_paused: bool,
    pub(super) run: Run,
}

/// A command to an effort.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct EffortRamp {
    pub(super) id: CommandId,
    pub(super) command: Command,
    pub(super) target: f64,
    /// Per cycle.
    pub(super) step: f64,
    pub(super) present: f64,
}

/// A reference run of the drive.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct HomingWait {
    pub(super) id: CommandId,
    pub(super) command: Command,
    pub(super) reference: Reference,
    /// True if the drive has been seen without the result of an earlier run.
    pub(super) has_begun: bool,
}

/// A command that brings the axis to rest once the drive has ended its reference run, so that both count from one zero.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct Leaving {
    pub(super) id: CommandId,
    pub(super) command: Command,
}

/// A command whose set-points its block gives.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct Led {
    pub(super) id: CommandId,
    pub(super) command: Command,
    /// Offset of the program at the start: MC_SetPosition does not move the axis.
    pub(super) offset: f64,
    /// True if the set-point of this cycle has been given.
    pub(super) is_fresh: bool,
    /// Cycles since the start.
    pub(super) cycles: u64,
}

impl Activity {
    /// The command and its number, if there is one.
    pub(super) fn command(&self) -> Option<(CommandId, &Command)> {
        match self {
            Self::Rest => None,
            Self::Moving(Moving { id, command, .. })
            | Self::Effort(EffortRamp { id, command, .. })
            | Self::Homing(HomingWait { id, command, .. })
            | Self::Search(Search { id, command, .. })
            | Self::Leaving(Leaving { id, command })
            | Self::Led(Led { id, command, .. }) => Some((*id, command)),
        }
    }

    /// The number of the command.
    pub(super) fn id(&self) -> Option<CommandId> {
        self.command().map(|(id, _)| id)
    }
}

impl Axis {
    /// Advances by one cycle.
    pub(super) fn advance(&mut self) {
        let cycle_time = self.params.cycle_time;
        match &mut self.activity {
            Activity::Rest => {
                let follows = match self.state {
                    AxisState::Disabled => true,
                    // Under a fault the link reports the position that the drive follows, whatever is commanded.
                    AxisState::ErrorStop => !self.is_powered() || self.feedback.fault.is_some(),
                    _ => false,
                };
                if follows {
                    self.base = Setpoint::at_rest(self.feedback.demanded());
                }
            }
            Activity::Moving(moving) => match moving.run.advance(cycle_time) {
                Ok(setpoint) => {
                    self.base = setpoint;
                    let is_over = moving.run.is_over() && !moving.is_paused;
                    if moving.run.has_passed(setpoint.x) {
                        self.forget_position();
                    }
                    if is_over {
                        self.arrive();
                    }
                }
                Err(error) => self.fail(AxisError::PlanLost { error }),
            },
            Activity::Effort(effort) => {
                let velocity = self.feedback.velocity;
                self.base = Setpoint { v: velocity, ..Setpoint::at_rest(self.feedback.position) };
                if let Some(limit) = effort.command.dynamics.velocity
                    && velocity.abs() > limit
                {
                    return self.fail(AxisError::Overspeed { velocity, limit });
                }
                let missing = effort.target - effort.present;
                if missing.abs() > effort.step {
                    effort.present += effort.step.copysign(missing);
                } else {
                    effort.present = effort.target;
                    let (id, from) = (effort.id, self.base);
                    self.go_on(id, from);
                }
            }
            Activity::Homing(HomingWait { id, reference: Reference::Here(position), .. }) => {
                let (id, offset) = (*id, *position - self.feedback.position);
                self.found_reference(id, offset);
            }
            Activity::Homing(HomingWait { id, reference: Reference::Encoder, .. }) => {
                let id = *id;
                self.found_reference(id, 0.0);
            }
            Activity::Homing(homing) => {
                // The axis still moves to the position at which the drive has stopped its demand.
                self.base = Setpoint { v: self.feedback.velocity, ..Setpoint::at_rest(self.feedback.demanded()) };
                let id = homing.id;
                match self.feedback.homing {
                    Homing::Idle | Homing::Busy => homing.has_begun = true,
                    Homing::Attained if homing.has_begun => self.found_reference(id, 0.0),
                    Homing::Failed if homing.has_begun => self.fail(AxisError::HomingFailed),
                    Homing::Attained | Homing::Failed => {}
                }
            }
            Activity::Search(_) => self.advance_search(),
            Activity::Leaving(Leaving { id, command }) => {
                let (id, command) = (*id, *command);
                self.base = Setpoint { v: self.feedback.velocity, ..Setpoint::at_rest(self.feedback.demanded()) };
                if self.feedback.homing != Homing::Busy {
                    match self.prepared(id, command, self.base, 0.0, &Queue::EMPTY) {
                        Ok(activity) => self.activate(activity, self.base),
                        Err(BlockError::Plan { error, .. }) => self.fail(AxisError::PlanLost { error }),
                        Err(_) => self.halt(),
                    }
                }
            }
            Activity::Led(led) => {
                led.cycles += 1;
                led.is_fresh = false;
            }
        }
    }

    /// Counts the position from a reference from now on: the program sees the drive's position plus `offset`.
    fn found_reference(&mut self, id: CommandId, offset: f64) {
        (self.is_homed, self.offset) = (true, offset);
        self.homing_steps = HomingSteps::default();
        self.ledger.set(id, Progress::Done);
        self.rest();
    }

    /// Ends the trajectory of the active command.
    fn arrive(&mut self) {
        let Activity::Moving(moving) = &self.activity else { return };
        // A trajectory that began a cycle ago may have been over in the cycle before.
        let beyond = moving.run.beyond().min(self.params.cycle_time);
        let (id, end) = (moving.id, moving.run.end());
        if moving.command.is_endless() {
            self.forget_position();
            return self.go_on(id, self.base);
        }
        match self.state {
            AxisState::ErrorStop => self.activity = Activity::Rest,
            AxisState::Stopping => {
                self.ledger.set(id, Progress::Done);
                self.activity = Activity::Rest;
                if self.stop_holder.is_none() {
                    self.follow(Cause::StopReleased);
                }
            }
            AxisState::Homing => {
                self.is_homed = core::mem::take(&mut self.homing_steps).has_reference;
                self.ledger.set(id, Progress::Done);
                self.rest();
            }
            _ => {
                self.ledger.set(id, Progress::Done);
                match self.queue.first() {
                    None => self.rest(),
                    Some(next) if next.begins_at_standstill() => self.rest(),
                    Some(next) if next.buffer_mode == BufferMode::Buffered => self.take_next(end, 0.0),
                    Some(_) => self.take_next(end, beyond),
                }
            }
        }
    }

    /// Drops a target position that was passed, so that no replan returns to it.
    fn forget_position(&mut self) {
        if let Activity::Moving(Moving { target, .. }) = &mut self.activity
            && let Target::Position { v, .. } = *target
        {
            *target = Target::Velocity(v);
        }
    }

    /// Marks an endless command as in target: the next command takes over, or the motion continues.
    fn go_on(&mut self, id: CommandId, from: Setpoint) {
        if self.queue.first().is_some() {
            self.ledger.set(id, Progress::Aborted);
            self.take_next(from, 0.0);
        } else {
            self.ledger.set(id, Progress::InTarget);
        }
    }

    /// Makes the first waiting command the active one, `lead` seconds ago, at `from`.
    pub(super) fn take_next(&mut self, from: Setpoint, lead: f64) {
        let Some((id, command)) = self.queue.pop() else { return };
        match self.prepared(id, command, from, lead, &self.queue) {
            Ok(activity) => {
                self.activate(activity, from);
                if let Activity::Moving(moving) = &mut self.activity {
                    self.base = moving.run.now();
                }
                self.ledger.set(id, Progress::Active);
                self.follow(Cause::Block(command.block));
                if lead > 0.0 {
                    self.arrive_early();
                }
            }
            Err(BlockError::Plan { block, error }) => {
                let error = AxisError::PlanLost { error };
                self.ledger.fail(BlockError::Axis { block, error });
                self.ledger.set(id, Progress::Failed);
                self.fail(error);
            }
            Err(error) => self.refuse_waiting(id, error, from, lead),
        }
    }

    /// Begins `activity` at `from`.
    pub(super) fn activate(&mut self, activity: Activity, from: Setpoint) {
        self.is_homed &= !matches!(activity, Activity::Homing(_) | Activity::Search(_));
        if matches!(activity, Activity::Search(_)) {
            self.homing_steps = HomingSteps::default();
        }
        (self.activity, self.base) = (activity, from);
    }

    /// Handles a trajectory so short that it is over in the cycle in which it is blended in; the next one then follows in that cycle.
    fn arrive_early(&mut self) {
        if let Activity::Moving(moving) = &self.activity
            && moving.run.is_over()
            && !moving.is_paused
        {
            self.arrive();
        }
    }

    /// Refuses a waiting command at its turn, at `from`, `lead` seconds ago, since something was changed in between: the one behind it
    /// takes its place (PLCopen part 1, section 2.2.2). Without one the axis halts.
    fn refuse_waiting(&mut self, id: CommandId, error: BlockError, from: Setpoint, lead: f64) {
        self.ledger.fail(error);
        self.ledger.set(id, Progress::Failed);
        let is_at_rest = from.v == 0.0 && from.a == 0.0 && arrow(self.state, Cause::Done).is_some();
        match self.queue.first() {
            Some(next) if !next.begins_at_standstill() => self.take_next(from, lead),
            _ if is_at_rest => {
                self.base = from;
                self.rest();
            }
            _ => {
                self.end_waiting(Progress::Aborted);
                self.halt();
            }
        }
    }

    /// Ends the activity but for a superimposed motion; without one the axis rests, and a command waiting for standstill begins.
    pub(super) fn rest(&mut self) {
        self.activity = Activity::Rest;
        if self.superimposed.is_none() {
            self.base = Setpoint::at_rest(self.base.x + self.shift);
            self.shift = 0.0;
            self.follow(Cause::Done);
            self.take_next(self.base, 0.0);
        }
    }
}
