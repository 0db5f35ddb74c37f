//! Output of the link: the motion that is read from the buffer, joined and left without a jump.
//!
//! Whenever the motion that is read changes under the output – at the start, when a prediction turns out to be wrong, after a stop – the
//! output continues from its present state, with the difference to the motion from now on,
//!
//! ```text
//! e(t) = output(t) − read(t),     e(now) with its velocity and acceleration,
//! ```
//!
//! except that its acceleration is limited to twice that of the recovery: a higher one comes from contradictory samples, such as positions
//! that follow a moving axis at velocity zero, and is gone with the next interval.
//!
//! That difference is led to zero by a jerk-limited transition with the recovery limits. So the output never jumps, and its acceleration is
//! at most that of the motion plus that of the recovery. A stop is the same kind of transition, to standstill. A difference of torque fades
//! linearly over the same time.
use servobench_base::{Setpoint, Stateful};
use servobench_motion::Order;
use servobench_motion::interpolate::Command;
use servobench_motion::online::{DirectionalLimits, Effort, Target, Transition};

/// Limits of the recovery from differences, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Recovery {
    pub(crate) limits: DirectionalLimits,
    /// Largest acceleration of a difference that is taken into account (m/s² or rad/s²).
    pub(crate) highest_acceleration: f64,
    /// Negligible difference in position (m or rad).
    pub(crate) resolution: f64,
    /// Cycle of the motion task (base ticks).
    pub(crate) cycle: f64,
    /// Length of a base tick (s).
    pub(crate) tick: f64,
}

impl Recovery {
    /// True if a difference exceeds the resolution within a cycle of the motion task.
    fn matters(&self, e: &Setpoint) -> bool {
        let t = self.cycle * self.tick;
        e.x.abs() + t * (e.v.abs() + t * e.a.abs()) > self.resolution
    }
}

/// An active transition.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct ProfileCommand {
    transition: Transition,
    /// Torque at its start, zero at its end (N·m or N).
    torque: f64,
    /// Start time (base ticks).
    from: u64,
    /// Length (base ticks), not rounded: of the transition, and at least a cycle of the motion task, for the torque.
    length: f64,
}

impl ProfileCommand {
    fn plan(from: Command, target: Target, recovery: &Recovery, now: u64) -> Option<Self> {
        let Recovery { limits, cycle, tick, .. } = recovery;
        let transition = Transition::plan(Order::Third, &from.setpoint, &target, limits, Effort::Fast).ok()?;
        let length = (transition.duration() / tick).max(*cycle);
        Some(Self { transition, torque: from.torque, from: now, length })
    }

    fn at(&self, now: u64, tick: f64) -> Command {
        let passed = now.saturating_sub(self.from) as f64;
        let left = if passed < self.length { 1.0 - passed / self.length } else { 0.0 };
        Command { setpoint: self.transition.at(passed * tick), torque: left * self.torque }
    }

    fn is_over(&self, now: u64) -> bool {
        now.saturating_sub(self.from) as f64 >= self.length
    }
}

/// Output of the link.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) enum Course {
    /// At rest at a position.
    Rest(f64),
    /// To standstill.
    Stop(ProfileCommand),
    /// The motion that is read.
    Read,
    /// The motion that is read plus the fading difference of the output.
    Join(ProfileCommand),
}

impl Course {
    /// From `output` to standstill; immediately if no stop can be planned.
    pub(crate) fn stop(output: Command, recovery: &Recovery, now: u64) -> Self {
        match ProfileCommand::plan(output, Target::Velocity(0.0), recovery, now) {
            Some(way) => Self::Stop(way),
            None => Self::Rest(output.setpoint.x),
        }
    }

    /// From `output` to the motion that is read; `None` if that cannot be planned.
    pub(crate) fn join(output: Command, read: Command, recovery: &Recovery, now: u64) -> Option<Self> {
        let (o, r) = (output.setpoint, read.setpoint);
        let highest = recovery.highest_acceleration;
        let e = Setpoint { x: o.x - r.x, v: o.v - r.v, a: (o.a - r.a).clamp(-highest, highest), j: 0.0, s: 0.0 };
        let torque = output.torque - read.torque;
        if !recovery.matters(&e) && torque == 0.0 {
            return Some(Self::Read);
        }
        ProfileCommand::plan(Command { setpoint: e, torque }, Target::Position { x: 0.0, v: 0.0 }, recovery, now)
            .map(Self::Join)
    }

    /// Output at `now`, with the motion that is read then.
    pub(crate) fn at(&self, read: impl FnOnce() -> Option<Command>, now: u64, tick: f64) -> Option<Command> {
        match self {
            Self::Rest(x) => Some(Command { setpoint: Setpoint::at_rest(*x), torque: 0.0 }),
            Self::Stop(way) => Some(way.at(now, tick)),
            Self::Read => read(),
            Self::Join(way) => read().map(|read| sum(read, way.at(now, tick))),
        }
    }

    /// Drops a finished transition.
    pub(crate) fn settle(&mut self, now: u64, tick: f64) {
        match self {
            Self::Stop(way) if way.is_over(now) => *self = Self::Rest(way.at(now, tick).setpoint.x),
            Self::Join(way) if way.is_over(now) => *self = Self::Read,
            _ => {}
        }
    }

    pub(crate) const fn reads(&self) -> bool {
        matches!(self, Self::Read | Self::Join(_))
    }
}

fn sum(a: Command, b: Command) -> Command {
    let (p, q) = (a.setpoint, b.setpoint);
    Command {
        setpoint: Setpoint { x: p.x + q.x, v: p.v + q.v, a: p.a + q.a, j: p.j + q.j, s: p.s + q.s },
        torque: a.torque + b.torque,
    }
}
