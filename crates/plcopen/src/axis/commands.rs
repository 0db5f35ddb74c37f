//! Submission of commands by blocks: refused, queued or begun at once.
use super::Axis;
use super::activity::{Activity, EffortRamp, HomingWait, Leaving, Led, Moving};
use super::blending::blended;
use super::bounds::{Bounds, Override};
use super::brake_pre_trajectory::{planned, settled};
use super::modulo;
use super::obstacle::Search;
use super::queue::Queue;
use super::run::Run;
use crate::arrows::{Cause, arrow};
use crate::blocks::BlockName;
use crate::command::{BufferMode, Command, Direction, Goal, finite_input};
use crate::error::BlockError;
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::Target;

/// State from which the axis continues.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Start {
    pub(super) from: Setpoint,
    /// Time since that state (s).
    pub(super) lead: f64,
}

impl Axis {
    /// Submits a command: it begins, or waits behind others.
    pub(crate) fn submit(&mut self, command: Command) -> Result<CommandId, BlockError> {
        let block = command.block;
        let Some(arrow) = arrow(self.state_before(&command)?, Cause::Block(block)) else {
            return Err(BlockError::State { block, state: self.state });
        };
        command.check(&self.params)?;
        if let Goal::Absolute { position, .. } = command.goal
            && !self.has_reference(command.buffer_mode)
        {
            return Err(BlockError::NotHomed { block, value: position });
        }
        let is_aborting = command.buffer_mode == BufferMode::Aborting;
        if !is_aborting {
            let is_beside = !command.begins_at_standstill();
            if is_beside {
                self.check_beside(&command)?;
            }
            let is_free = matches!(self.activity, Activity::Rest) && self.queue.first().is_none();
            if !is_free || !is_beside && self.superimposed.is_some() {
                return self.wait(command);
            }
        }
        let start = if is_aborting { self.present() } else { Start { from: self.base, lead: 0.0 } };
        let activity = self.prepared(CommandId::OWN, command, start.from, start.lead, &Queue::EMPTY)?;
        if is_aborting {
            self.end_all(Progress::Aborted);
        }
        let id = self.ledger.issue(block);
        self.begin_activity(id, activity, start);
        self.state = arrow.to;
        Ok(id)
    }

    /// Submits an MC_Stop. Only the instance whose stop `before` still brakes may stop anew.
    pub(crate) fn stop(&mut self, command: Command, before: Option<CommandId>) -> Result<CommandId, BlockError> {
        let block = command.block;
        let is_its_own = self.state == AxisState::Stopping && before.is_some() && self.activity.id() == before;
        if arrow(self.state, Cause::Block(block)).is_none() && !is_its_own {
            return Err(BlockError::State { block, state: self.state });
        }
        command.check(&self.params)?;
        let start = self.present();
        let activity = match self.activity {
            Activity::Homing(_) | Activity::Leaving(_) => Activity::Leaving(Leaving { id: CommandId::OWN, command }),
            _ => self.prepared(CommandId::OWN, command, start.from, start.lead, &Queue::EMPTY)?,
        };
        self.end_all(Progress::Aborted);
        let id = self.ledger.issue(block);
        self.begin_activity(id, activity, start);
        self.stop_holder = Some(id);
        self.follow(Cause::Block(block));
        Ok(id)
    }

    /// Releases the axis from an MC_Stop whose Execute is FALSE.
    pub(crate) fn release_stop(&mut self, id: CommandId) {
        if self.stop_holder != Some(id) {
            return;
        }
        self.stop_holder = None;
        if self.state == AxisState::Stopping && matches!(self.activity, Activity::Rest) {
            self.follow(Cause::StopReleased);
        }
    }

    /// State of the axis before `command`: the present one, or Standstill if the command waits for that.
    fn state_before(&self, command: &Command) -> Result<AxisState, BlockError> {
        if command.buffer_mode == BufferMode::Aborting {
            return match self.activity {
                Activity::Homing(_) | Activity::Leaving(_) if self.state == AxisState::Homing => {
                    Err(BlockError::State { block: command.block, state: self.state })
                }
                _ => Ok(self.state),
            };
        }
        let before = self.queue.last().or(self.activity.command().map(|(_, command)| command));
        if command.begins_at_standstill() && before.is_some_and(|before| !before.ends_at_standstill()) {
            return Err(command.wrong_buffer_mode("after a command that ends at Standstill"));
        }
        Ok(match self.state {
            _ if before.is_some_and(Command::is_homing_step) => AxisState::Homing,
            AxisState::Homing if before.is_some() => AxisState::Standstill,
            AxisState::DiscreteMotion if command.begins_at_standstill() => AxisState::Standstill,
            state => state,
        })
    }

    /// True if a program position is referenced when a command with this mode begins.
    pub(crate) fn has_reference(&self, buffer_mode: BufferMode) -> bool {
        let is_homed_before = || buffer_mode != BufferMode::Aborting && self.below().any(Command::ends_homing);
        !self.params.needs_homing || self.is_homed || is_homed_before()
    }

    /// Changes the inputs of an active or waiting command.
    pub(crate) fn update(&mut self, id: CommandId, command: Command) -> Result<(), BlockError> {
        let was_in_target = self.ledger.progress(id) == Progress::InTarget;
        command.check(&self.params)?;
        self.check_beside(&command)?;
        if let Some(waiting) = self.queue.get_mut(id) {
            *waiting = command;
            return self.rejoin(&self.beside());
        }
        let from = self.base;
        match &self.activity {
            Activity::Moving(moving) if moving.id == id => {
                let origin = moving.origin;
                let target = match (command.goal, moving.target) {
                    // The position is behind; only the velocity continues.
                    (
                        Goal::Absolute { end_velocity: Some(v), .. } | Goal::Relative { end_velocity: Some(v), .. },
                        Target::Velocity(_),
                    ) => Target::Velocity(v),
                    (Goal::Relative { distance, end_velocity }, _) => {
                        Target::Position { x: origin + distance, v: end_velocity.unwrap_or(0.0) }
                    }
                    (Goal::Away(distance), _) => Target::Position { x: origin + distance, v: 0.0 },
                    _ => self.target(&command, &from, origin)?,
                };
                self.check_target(command.block, &from, &target)?;
                let (run, is_paused) = self.run(&command, &target, &from, &self.beside(), 0.0, &self.queue)?;
                self.activity = Activity::Moving(Moving { id, command, target, origin, is_paused, run });
            }
            Activity::Effort(effort) if effort.id == id => {
                let present = effort.present;
                if let Activity::Effort(changed) = self.prepared(id, command, from, 0.0, &Queue::EMPTY)? {
                    self.activity = Activity::Effort(EffortRamp { present, ..changed });
                }
            }
            _ => return Err(BlockError::Ended { block: command.block }),
        }
        // A change of neither velocity nor effort leaves the axis in target.
        let is_there = match &self.activity {
            Activity::Moving(moving) => moving.run.is_over(),
            Activity::Effort(effort) => (effort.target - effort.present).abs() <= 0.0,
            _ => false,
        };
        self.ledger.set(id, if was_in_target && is_there { Progress::InTarget } else { Progress::Active });
        Ok(())
    }

    /// MC_SetOverride: replans active motions from the present set-point.
    pub(crate) fn set_factors(&mut self, factors: Override) -> Result<(), BlockError> {
        if factors == self.factors {
            return Ok(());
        }
        let before = core::mem::replace(&mut self.factors, factors);
        let running = self.activity.clone();
        let done = self.rejoin(&self.half_beside()).and_then(|()| {
            let Some(superimposed) = &self.superimposed else { return Ok(()) };
            let Some(end) = superimposed.end else { return Ok(()) };
            let planned = self.superimposed_run(&superimposed.command, &superimposed.now, end)?;
            if let Some(superimposed) = &mut self.superimposed {
                (superimposed.run, superimposed.is_paused) = planned;
            }
            Ok(())
        });
        if done.is_err() {
            (self.factors, self.activity) = (before, running);
        }
        done
    }

    /// MC_SetPosition: sets the actual position that the program sees to `position`, or shifts it by that much.
    pub(crate) fn set_position(&mut self, position: f64, is_relative: bool) -> Result<(), BlockError> {
        let block = BlockName::SetPosition;
        if self.state == AxisState::Homing {
            return Err(BlockError::State { block, state: self.state });
        }
        finite_input(block, "Position", position)?;
        self.offset = if is_relative { self.offset + position } else { position - self.feedback.position };
        Ok(())
    }

    /// Start of an aborting command: the set-point, which is that of the cycle before until that of this cycle exists.
    pub(super) fn present(&self) -> Start {
        let cycle_time = self.params.cycle_time;
        match &self.activity {
            // Follows the drive's feedback, which has just arrived.
            Activity::Effort(_) | Activity::Homing(_) | Activity::Leaving(_) if self.is_beginning => {
                Start { from: self.base, lead: 0.0 }
            }
            Activity::Search(search) if search.is_held() => {
                Start { from: Setpoint::at_rest(self.feedback.position), lead: 0.0 }
            }
            Activity::Led(led) => {
                let from = settled(&self.setpoint, &Bounds::of_axis(&self.params.limits));
                Start { from, lead: if led.is_fresh { 0.0 } else { cycle_time } }
            }
            _ => Start { from: self.setpoint, lead: if self.is_beginning { cycle_time } else { 0.0 } },
        }
    }

    fn wait(&mut self, command: Command) -> Result<CommandId, BlockError> {
        let held = self.queue.len();
        if held >= self.params.buffered_commands {
            return Err(BlockError::BufferFull { block: command.block, held });
        }
        let id = self.ledger.issue(command.block);
        self.queue.push(id, command);
        if command.buffer_mode != BufferMode::Buffered
            && let Err(error) = self.rejoin(&self.beside())
        {
            self.queue.drop_last();
            self.ledger.set(id, Progress::Aborted);
            return Err(error);
        }
        Ok(id)
    }

    fn begin_activity(&mut self, id: CommandId, activity: Activity, Start { from, lead }: Start) {
        self.activate(activity, from);
        match &mut self.activity {
            Activity::Moving(moving) => {
                moving.id = id;
                self.base = moving.run.now();
            }
            Activity::Led(led) => {
                led.id = id;
                if lead > 0.0 {
                    (led.cycles, led.is_fresh) = (1, false);
                }
            }
            Activity::Effort(EffortRamp { id: own, .. })
            | Activity::Homing(HomingWait { id: own, .. })
            | Activity::Search(Search { id: own, .. })
            | Activity::Leaving(Leaving { id: own, .. }) => *own = id,
            Activity::Rest => {}
        }
        self.add_up();
        self.ledger.set(id, Progress::Active);
    }

    /// Replans the rest of the active command, with the changes, on the given share of the `axis`.
    fn rejoin(&mut self, axis: &Bounds) -> Result<(), BlockError> {
        let Activity::Moving(moving) = &self.activity else { return Ok(()) };
        if moving.command.goal == Goal::Rest {
            return Ok(());
        }
        let (run, is_paused) = self.run(&moving.command, &moving.target, &self.base, axis, 0.0, &self.queue)?;
        let other = if is_paused { None } else { self.without_turning_round(moving, axis, &run)? };
        let run = other.unwrap_or(run);
        if let Activity::Moving(moving) = &mut self.activity {
            (moving.run, moving.is_paused) = (run, is_paused);
            self.ledger.set(moving.id, Progress::Active);
        }
        Ok(())
    }

    /// Alternative to `run` for `moving`, if `run` would turn round before a position ahead that it is to pass, because its velocity there
    /// is out of reach since a change of the override: the trajectory straight to that velocity, which passes the position faster or slower
    /// than desired. Close to rest the fastest trajectory may turn round as well: then `moving` continues unchanged, and goes to that
    /// velocity
    /// afterwards.
    fn without_turning_round(&self, moving: &Moving, axis: &Bounds, run: &Run) -> Result<Option<Run>, BlockError> {
        let Target::Position { x, v } = moving.target else { return Ok(None) };
        let from = self.base;
        let (sign, is_ahead) = (v.signum(), (x - from.x) * v > 0.0);
        if !is_ahead || from.v * sign < 0.0 || run.keeps_direction(sign) || !moving.run.keeps_direction(sign) {
            return Ok(None);
        }
        let (straight, _) = self.run(&moving.command, &Target::Velocity(v), &from, axis, 0.0, &self.queue)?;
        let way = if straight.keeps_direction(sign) { straight } else { moving.run.then_as(&straight) };
        Ok(Some(way.passing(x, sign, run)))
    }

    /// Activity of `command` as it begins at `from`, `lead` seconds ago, with the commands waiting behind it.
    pub(super) fn prepared(
        &self,
        id: CommandId,
        command: Command,
        from: Setpoint,
        lead: f64,
        behind: &Queue,
    ) -> Result<Activity, BlockError> {
        let block = command.block;
        match command.goal {
            Goal::Effort { effort, ramp, direction } => {
                let target = self.directed(effort, direction);
                let (step, present) = (ramp * self.params.cycle_time, self.feedback.effort);
                Ok(Activity::Effort(EffortRamp { id, command, target, step, present }))
            }
            Goal::Reference(reference) => Ok(Activity::Homing(HomingWait { id, command, reference, has_begun: false })),
            Goal::Obstacle(obstacle) => {
                if let Some(input) = self.forbidden(obstacle.sign()) {
                    return Err(BlockError::NotPermitted { block, input });
                }
                Ok(Activity::Search(Search::new(id, command, obstacle, self.feedback.position)))
            }
            Goal::Led(_) => {
                let offset = self.offset;
                Ok(Activity::Led(Led { id, command, offset, is_fresh: true, cycles: 0 }))
            }
            _ => {
                let is_aborting = command.buffer_mode == BufferMode::Aborting;
                let origin = if is_aborting { self.last_target().unwrap_or(from.x) } else { from.x };
                let target = self.target(&command, &from, origin)?;
                self.check_target(block, &from, &target)?;
                // An aborting command has the whole axis.
                let axis = if is_aborting { Bounds::of_axis(&self.params.limits) } else { self.beside() };
                let (run, is_paused) = self.run(&command, &target, &from, &axis, lead, behind)?;
                let origin = if matches!(command.goal, Goal::Additive(_)) { origin } else { from.x };
                Ok(Activity::Moving(Moving { id, command, target, origin, is_paused, run }))
            }
        }
    }

    /// Checks that MC_Power permits the direction to `target`, and that a position is within the software limits.
    fn check_target(&self, block: BlockName, from: &Setpoint, target: &Target) -> Result<(), BlockError> {
        let direction = match target {
            Target::Position { x, .. } => {
                self.check_software_limits(block, *x)?;
                x - from.x
            }
            Target::Velocity(v) => *v,
        };
        match self.forbidden(direction) {
            Some(input) => Err(BlockError::NotPermitted { block, input }),
            None => Ok(()),
        }
    }

    /// Target of the active command plus the distance of finished superimposed motions: MC_MoveAdditive counts from there.
    fn last_target(&self) -> Option<f64> {
        match (&self.activity, self.state) {
            (Activity::Moving(Moving { target: Target::Position { x, .. }, .. }), AxisState::DiscreteMotion) => {
                Some(x + self.shift)
            }
            _ => None,
        }
    }

    /// Target of a command, in the unit of the drive.
    pub(super) fn target(
        &self,
        command: &Command,
        from: &Setpoint,
        additive_origin: f64,
    ) -> Result<Target, BlockError> {
        Ok(match command.goal {
            Goal::Absolute { position, direction, end_velocity } => {
                let position = position - self.offset;
                let x = match self.params.modulo {
                    None => position,
                    Some(period) => {
                        let stop = self.stopping_place(command, from)?;
                        modulo::place(position, period, stop, direction, self.last_direction)
                    }
                };
                Target::Position { x, v: end_velocity.unwrap_or(0.0) }
            }
            Goal::Relative { distance, end_velocity } => {
                Target::Position { x: from.x + distance, v: end_velocity.unwrap_or(0.0) }
            }
            Goal::Away(distance) => Target::Position { x: from.x + distance, v: 0.0 },
            Goal::Additive(distance) => Target::Position { x: additive_origin + distance, v: 0.0 },
            Goal::Velocity { velocity, direction } => Target::Velocity(self.directed(velocity, direction)),
            Goal::Rest | Goal::Reference(_) | Goal::Obstacle(_) | Goal::Effort { .. } | Goal::Led(_) => {
                Target::Velocity(0.0)
            }
        })
    }

    /// `value` with its sign in `direction`.
    fn directed(&self, value: f64, direction: Direction) -> f64 {
        match direction {
            Direction::Positive | Direction::Shortest => value,
            Direction::Negative => -value,
            Direction::Current => value.copysign(value * self.last_direction),
        }
    }

    /// Position at which the axis comes to rest if `command` only brakes.
    fn stopping_place(&self, command: &Command, from: &Setpoint) -> Result<f64, BlockError> {
        if from.v == 0.0 && from.a == 0.0 {
            return Ok(from.x);
        }
        let unpaused = Override { velocity: 1.0, ..self.factors };
        let bounds = Bounds::of(&command.dynamics, &self.params.limits, &unpaused);
        let covered = bounds.covered(from, 0.0).map_err(|error| BlockError::Plan { block: command.block, error })?;
        Ok(from.x + covered)
    }

    /// Trajectory of `command` to `target` on this share of the axis, blended with those `behind`; and true if the override holds it.
    fn run(
        &self,
        command: &Command,
        target: &Target,
        from: &Setpoint,
        axis: &Bounds,
        lead: f64,
        behind: &Queue,
    ) -> Result<(Run, bool), BlockError> {
        let plan_error = |error: PlanError| BlockError::Plan { block: command.block, error };
        // A command without its own velocity uses the spare one; on an axis that has none left it stands.
        let spare = Some(axis.velocity.max(from.v.abs())).filter(|spare| *spare > 0.0);
        let bounds_with = |factors: &Override| {
            let bounds = Bounds::of(&command.dynamics, &self.params.limits, factors);
            Bounds { velocity: bounds.velocity.min(spare.unwrap_or(bounds.velocity)), ..bounds }
        };
        if command.goal == Goal::Rest {
            let bounds = bounds_with(&Override::NONE);
            return Ok((planned(from, target, &bounds, axis, lead).map_err(plan_error)?, false));
        }
        if self.factors.velocity == 0.0 {
            let bounds = bounds_with(&Override { velocity: 1.0, ..self.factors });
            return Ok((planned(from, &Target::Velocity(0.0), &bounds, axis, lead).map_err(plan_error)?, true));
        }
        let bounds = bounds_with(&self.factors);
        let target = match *target {
            Target::Velocity(v) => Target::Velocity(v * self.factors.velocity),
            Target::Position { x, v } => Target::Position { x, v: v * self.factors.velocity },
        };
        if let Target::Position { x, v: 0.0 } = target
            && !command.is_endless()
            && !command.ends_homing()
        {
            let direction = if x < from.x { -1.0 } else { 1.0 };
            let wanted = self.exit_speed(x, direction, bounds.velocity, behind, 0)?;
            if wanted > 0.0 {
                return Ok((blended(from, x, [&bounds, axis], wanted, lead).map_err(plan_error)?, false));
            }
        }
        if let Activity::Moving(Moving { run, .. }) = &self.activity
            && lead == 0.0
            && run.is_for(from, target, bounds, axis)
        {
            return Ok((*run, false));
        }
        Ok((planned(from, &target, &bounds, axis, lead).map_err(plan_error)?, false))
    }
}
