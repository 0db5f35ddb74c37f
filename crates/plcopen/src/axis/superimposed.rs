//! Superimposed motion.
use super::Axis;
use super::activity::Activity;
use super::bounds::Bounds;
use super::brake_pre_trajectory::planned;
use super::run::Run;
use crate::arrows::{Cause, arrow};
use crate::command::{Command, Dynamics, finite_input};
use crate::error::{AxisError, BlockError};
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::online::Target;

/// A relative motion on top of the activity.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct Superimposed {
    pub(super) id: CommandId,
    pub(super) command: Command,
    /// Distance that the motion replaced by this one had covered.
    pub(super) origin: f64,
    /// Target; `None`: to rest.
    pub(super) end: Option<f64>,
    pub(super) is_paused: bool,
    pub(super) run: Run,
    pub(super) now: Setpoint,
}

impl Superimposed {
    /// Sum with the motion below.
    pub(super) fn on(&self, base: &Setpoint, shift: f64) -> Setpoint {
        let top = &self.now;
        Setpoint {
            x: base.x + (shift + top.x),
            v: base.v + top.v,
            a: base.a + top.a,
            j: base.j + top.j,
            s: base.s + top.s,
        }
    }
}

impl Axis {
    /// MC_MoveSuperimposed.
    pub(crate) fn superimpose(&mut self, command: &Command, distance: f64) -> Result<CommandId, BlockError> {
        let block = command.block;
        let Some(arrow) = arrow(self.state, Cause::Block(block)) else {
            return Err(BlockError::State { block, state: self.state });
        };
        self.check_superimposed(command, distance)?;
        if let Some(input) = self.forbidden(distance) {
            return Err(BlockError::NotPermitted { block, input });
        }
        if matches!(self.activity, Activity::Effort(_) | Activity::Led(_)) {
            return Err(BlockError::State { block, state: self.state });
        }
        let from = self.superimposed.as_ref().map_or(Setpoint::default(), |running| running.now);
        let (run, is_paused) = self.superimposed_run(command, &from, from.x + distance)?;
        let id = self.ledger.issue(block);
        if let Some(before) = &self.superimposed {
            self.ledger.set(before.id, Progress::Aborted);
        }
        let (origin, end) = (from.x, Some(from.x + distance));
        self.superimposed = Some(Superimposed { id, command: *command, origin, end, is_paused, run, now: from });
        self.ledger.set(id, Progress::Active);
        self.state = arrow.to;
        Ok(id)
    }

    /// MC_HaltSuperimposed; `None` if there is no superimposed motion.
    pub(crate) fn halt_superimposed(&mut self, command: &Command) -> Result<Option<CommandId>, BlockError> {
        let block = command.block;
        if !matches!(self.state, AxisState::Standstill | AxisState::DiscreteMotion | AxisState::ContinuousMotion) {
            return Err(BlockError::State { block, state: self.state });
        }
        command.dynamics.check(block, &self.params.limits)?;
        let Some(&Superimposed { id: before, now: from, command: halted, .. }) = self.superimposed.as_ref() else {
            return Ok(None);
        };
        // Until it rests it may be as fast as the motion that it halts.
        let dynamics = Dynamics { velocity: halted.dynamics.velocity, ..command.dynamics };
        let command = &Command { dynamics, ..*command };
        self.below().try_for_each(|below| self.check_sum(block, command, below))?;
        let bounds = Bounds::of(&command.dynamics, &self.params.limits, &super::Override::NONE);
        let run = planned(&from, &Target::Velocity(0.0), &bounds, &self.on_top(), 0.0)
            .map_err(|error| BlockError::Plan { block, error })?;
        let id = self.ledger.issue(block);
        self.ledger.set(before, Progress::Aborted);
        let origin = from.x;
        self.superimposed =
            Some(Superimposed { id, command: *command, origin, end: None, is_paused: false, run, now: from });
        self.ledger.set(id, Progress::Active);
        Ok(Some(id))
    }

    /// Changes the inputs of an active superimposed motion.
    pub(crate) fn update_superimposed(
        &mut self,
        id: CommandId,
        command: &Command,
        distance: f64,
    ) -> Result<(), BlockError> {
        self.check_superimposed(command, distance)?;
        let Some(running) = self.superimposed.as_ref().filter(|running| running.id == id) else {
            return Err(BlockError::Ended { block: command.block });
        };
        let target = running.origin + distance;
        let (run, is_paused) = self.superimposed_run(command, &running.now, target)?;
        if let Some(running) = &mut self.superimposed {
            (running.command, running.end, running.run, running.is_paused) = (*command, Some(target), run, is_paused);
        }
        Ok(())
    }

    fn check_superimposed(&self, command: &Command, distance: f64) -> Result<(), BlockError> {
        finite_input(command.block, "Distance", distance)?;
        command.dynamics.check(command.block, &self.params.limits)?;
        if let Activity::Moving(moving) = &self.activity
            && moving.run.is_leading_in()
        {
            return Err(self.nothing_to_spare(command));
        }
        self.below().try_for_each(|below| self.check_sum(command.block, command, below))
    }

    /// Distance that a superimposed motion has covered since it began.
    pub(crate) fn covered(&self, id: CommandId) -> Option<f64> {
        self.superimposed
            .as_ref()
            .filter(|superimposed| superimposed.id == id)
            .map(|superimposed| superimposed.now.x - superimposed.origin)
    }

    /// Advances by one cycle.
    pub(super) fn advance_superimposed(&mut self) {
        let Some(superimposed) = &mut self.superimposed else { return };
        let cycle_time = self.params.cycle_time;
        match superimposed.run.advance(cycle_time) {
            Ok(now) => superimposed.now = now,
            Err(error) => return self.fail(AxisError::PlanLost { error }),
        }
        if superimposed.run.is_over() && !superimposed.is_paused {
            self.shift += superimposed.end.unwrap_or(superimposed.now.x);
            self.ledger.set(superimposed.id, Progress::Done);
            self.superimposed = None;
            if matches!(self.activity, Activity::Rest) {
                self.rest();
            }
        }
    }

    /// Trajectory of the superimposed motion, and true if the override holds it.
    pub(super) fn superimposed_run(
        &self,
        command: &Command,
        from: &Setpoint,
        x: f64,
    ) -> Result<(Run, bool), BlockError> {
        let is_paused = self.factors.velocity == 0.0;
        let factors = super::Override { velocity: if is_paused { 1.0 } else { self.factors.velocity }, ..self.factors };
        let bounds = Bounds::of(&command.dynamics, &self.params.limits, &factors);
        let target = if is_paused { Target::Velocity(0.0) } else { Target::Position { x, v: 0.0 } };
        let run = planned(from, &target, &bounds, &self.on_top(), 0.0);
        Ok((run.map_err(|error| BlockError::Plan { block: command.block, error })?, is_paused))
    }
}
