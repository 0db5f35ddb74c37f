//! A motion on top of another one.
use super::Axis;
use super::activity::Activity;
use super::bounds::Bounds;
use super::run::Run;
use crate::arrows::{Cause, arrow};
use crate::command::{Command, Goal, finite_input};
use crate::error::{AxisError, BlockError};
use crate::ledger::{CommandId, Progress};
use servobench_base::Setpoint;
use servobench_motion::online::Target;

/// A relative motion on top of the activity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Superimposed {
    pub(super) id: CommandId,
    pub(super) command: Command,
    pub(super) distance: f64,
    pub(super) is_paused: bool,
    pub(super) run: Run,
    pub(super) now: Setpoint,
}

impl Superimposed {
    /// Together with the motion below.
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
        finite_input(block, "Distance", distance)?;
        command.dynamics.check(block, &self.params.limits)?;
        if let Some(input) = self.forbidden(distance) {
            return Err(BlockError::NotPermitted { block, input });
        }
        if matches!(self.activity, Activity::Effort(_) | Activity::Led(_)) {
            return Err(BlockError::State { block, state: self.state });
        }
        for (_, below) in self.activity.command().into_iter().chain(self.queue.iter().map(|(id, below)| (*id, below))) {
            self.check_sum(block, command, below)?;
        }
        let from = self.superimposed.as_ref().map_or(Setpoint::default(), |running| running.now);
        let (run, is_paused) = self.superimposed_run(command, &from, from.x + distance)?;
        let id = self.ledger.issue();
        if let Some(before) = &self.superimposed {
            self.ledger.set(before.id, Progress::Aborted);
        }
        let distance = from.x + distance;
        self.superimposed = Some(Superimposed { id, command: *command, distance, is_paused, run, now: from });
        self.ledger.set(id, Progress::Active);
        self.state = arrow.to;
        Ok(id)
    }

    /// What a superimposed motion has covered since it, or the ones that it replaced, began.
    pub(crate) fn covered(&self, id: CommandId) -> Option<f64> {
        self.superimposed.as_ref().filter(|superimposed| superimposed.id == id).map(|superimposed| superimposed.now.x)
    }

    /// Two motions on top of each other keep the limits of the axis together.
    pub(super) fn check_sum(
        &self,
        block: crate::name::BlockName,
        one: &Command,
        other: &Command,
    ) -> Result<(), BlockError> {
        if other.goal == Goal::Rest {
            return Ok(());
        }
        let limits = &self.params.limits;
        let [one, other] = [one, other].map(|command| {
            let dynamics = &command.dynamics;
            let velocity = match command.goal {
                Goal::Velocity { velocity, .. } => velocity.abs(),
                _ => dynamics.velocity,
            };
            [velocity, dynamics.acceleration.max(dynamics.deceleration), dynamics.jerk.unwrap_or(limits.jerk)]
        });
        let bounds = [("Velocity", limits.velocity), ("Acceleration", limits.acceleration), ("Jerk", limits.jerk)];
        for ((input, limit), (one, other)) in bounds.into_iter().zip(one.into_iter().zip(other)) {
            let value = one + other;
            if value > limit {
                return Err(BlockError::SumAboveLimit { block, input, value, limit });
            }
        }
        Ok(())
    }

    /// One cycle on.
    pub(super) fn advance_superimposed(&mut self) {
        let Some(superimposed) = &mut self.superimposed else { return };
        let cycle_time = self.params.cycle_time;
        match superimposed.run.advance(cycle_time) {
            Ok(now) => superimposed.now = now,
            Err(error) => return self.fail(AxisError::PlanLost { error }),
        }
        if superimposed.run.beyond(cycle_time) >= 0.0 && !superimposed.is_paused {
            self.shift += superimposed.distance;
            self.ledger.set(superimposed.id, Progress::Done);
            self.superimposed = None;
            if matches!(self.activity, Activity::Rest) {
                self.rest();
            }
        }
    }

    /// The way on top, and whether the override holds it.
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
        let way = bounds.plan(from, &target).map_err(|error| BlockError::Plan { block: command.block, error })?;
        Ok((Run::new(way, 0.0, None), is_paused))
    }
}
