//! Motions whose set-points a block gives itself: its course is one that the axis need not hold.
use super::Axis;
use super::activity::Activity;
use super::queue::Queue;
use crate::arrows::Cause;
use crate::blocks::BlockName;
use crate::command::{BufferMode, Command, Direction, Ending, Goal};
use crate::error::AxisError;
use crate::ledger::{CommandId, Progress};
use servobench_base::Setpoint;

/// What rounding may add to a limit, as a part of it.
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

    /// Gives the set-point of this cycle to the active command `id`, which has the goal [`Led`](crate::Goal::Led), in the
    /// coordinate that the program had when it began. It is called in every cycle after the first until it is concluded; where
    /// it is not, or a limit of the axis is not kept, the axis stops with an error.
    pub fn lead(&mut self, id: CommandId, setpoint: Setpoint) {
        let Activity::Led(led) = &mut self.activity else { return };
        if led.id != id {
            return;
        }
        let setpoint = Setpoint { x: setpoint.x - led.offset - self.shift, ..setpoint };
        let (block, before, limits, h) = (led.command.block, self.base, &self.params.limits, self.params.cycle_time);
        // What lies between two set-points: the mean velocity and acceleration.
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

    /// A cycle ends: without a set-point of the block that leads the axis it stops with an error.
    pub(super) fn watch_leading(&mut self) {
        if let Activity::Led(led) = &self.activity
            && !led.is_fresh
        {
            let block = led.command.block;
            self.fail(AxisError::NotLed { block });
        }
    }

    /// The active command `id` begins where the program sees the axis now.
    pub(crate) fn begin_leading(&mut self, id: CommandId) {
        if let Activity::Led(led) = &mut self.activity
            && led.id == id
        {
            led.offset = self.offset;
        }
    }

    /// The active command `id` leads beyond a limit of the axis: it stops with an error.
    pub(crate) fn abandon(&mut self, id: CommandId, quantity: &'static str, value: f64, limit: f64) {
        if let Activity::Led(led) = &self.activity
            && led.id == id
        {
            let block = led.command.block;
            self.fail(AxisError::Profile { block, quantity, value, limit });
        }
    }

    /// The course of the command `id` has reached its end: it is done. The axis rests there, or keeps the velocity that it has
    /// there, as the goal of the command says.
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
