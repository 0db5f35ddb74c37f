//! Motions whose set-points come from a block: the axis need not store their trajectory.
use super::Axis;
use super::activity::Activity;
use super::queue::Queue;
use crate::arrows::Cause;
use crate::blocks::BlockName;
use crate::command::{BufferMode, Command, Direction, Ending, Goal};
use crate::error::AxisError;
use crate::ledger::{CommandId, Progress};
use servobench_base::Setpoint;

/// Relative tolerance of a limit for rounding.
const ROUNDING: f64 = 1e-9;

impl Axis {
    /// Cycles since the command `id` became active; `None` when it is not.
    #[must_use]
    pub fn led_cycles(&self, id: CommandId) -> Option<u64> {
        match &self.activity {
            Activity::Led(led) if led.id == id => Some(led.cycles),
            _ => None,
        }
    }

    /// Gives the set-point of this cycle to the active command `id`, which has the goal [`Led`](crate::Goal::Led), in the coordinate
    /// that the program had when the command began. Call it in every cycle after the first until the command is concluded; if a call is
    /// missing, or a limit of the axis is exceeded, the axis stops with an error.
    pub fn lead(&mut self, id: CommandId, setpoint: Setpoint) {
        let Activity::Led(led) = &mut self.activity else { return };
        if led.id != id {
            return;
        }
        let setpoint = Setpoint { x: setpoint.x - led.offset - self.shift, ..setpoint };
        let (block, before, limits, h) = (led.command.block, self.base, &self.params.limits, self.params.cycle_time);
        // Mean velocity and acceleration between two set-points.
        let way = (setpoint.x - before.x) / h;
        let gain = (setpoint.v - before.v) / h;
        let checks = [
            ("velocity", setpoint.v, limits.velocity),
            ("step of position per cycle", way, limits.velocity + ROUNDING * setpoint.x.abs() / h),
            ("acceleration", setpoint.a, limits.acceleration),
            ("step of velocity per cycle", gain, limits.acceleration + ROUNDING * limits.velocity / h),
            ("jerk", setpoint.j, limits.jerk),
        ];
        for (quantity, value, limit) in checks {
            if value.is_nan() || value.abs() > limit * (1.0 + ROUNDING) {
                return self.fail(AxisError::Profile { block, quantity, value, limit });
            }
        }
        led.is_fresh = true;
        self.base = setpoint;
        self.add_up();
    }

    /// Ends a cycle: without a set-point from the leading block the axis stops with an error.
    pub(super) fn watch_leading(&mut self) {
        if let Activity::Led(led) = &self.activity
            && !led.is_fresh
        {
            let block = led.command.block;
            self.fail(AxisError::NotLed { block });
        }
    }

    /// Begins the active command `id` at the position where the program sees the axis now.
    pub(crate) fn begin_leading(&mut self, id: CommandId) {
        if let Activity::Led(led) = &mut self.activity
            && led.id == id
        {
            led.offset = self.offset;
        }
    }

    /// Ends the active command `id`, which exceeds a limit of the axis: the axis stops with an error.
    pub(crate) fn abandon(&mut self, id: CommandId, quantity: &'static str, value: f64, limit: f64) {
        if let Activity::Led(led) = &self.activity
            && led.id == id
        {
            let block = led.command.block;
            self.fail(AxisError::Profile { block, quantity, value, limit });
        }
    }

    /// Concludes the command `id` at the end of its trajectory: it is done. The axis rests there or keeps its velocity, depending on the
    /// goal of the command.
    pub fn conclude(&mut self, id: CommandId) {
        let Activity::Led(led) = &self.activity else { return };
        if led.id != id {
            return;
        }
        let (Command { goal, dynamics, .. }, from) = (led.command, self.base);
        self.ledger.set(id, Progress::Done);
        if self.queue.first().is_some_and(|next| !next.begins_at_standstill()) {
            return self.take_next(from, 0.0);
        }
        if goal == Goal::Led(Ending::AtRest) {
            return self.rest();
        }
        self.follow(Cause::DoneMoving);
        let goal = Goal::Velocity { velocity: from.v, direction: Direction::Positive };
        let command = Command { block: BlockName::MoveVelocity, goal, dynamics, buffer_mode: BufferMode::Aborting };
        match self.prepared(CommandId::OWN, command, from, 0.0, &Queue::EMPTY) {
            Ok(activity) => self.activity = activity,
            Err(_) => self.halt(),
        }
    }
}
