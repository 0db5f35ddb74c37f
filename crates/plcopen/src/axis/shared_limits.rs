//! Sharing of the axis's limits between a motion and a superimposed one.
use super::Axis;
use super::activity::Activity;
use super::bounds::Bounds;
use crate::blocks::BlockName;
use crate::command::{Command, Goal};
use crate::error::BlockError;
use servobench_motion::Limits;

const INPUTS: [&str; 4] = ["Velocity", "Acceleration", "Jerk", "Snap"];

/// Most that a command uses, in the order of the inputs.
fn demand(command: &Command, limits: &Limits) -> [f64; 4] {
    let dynamics = &command.dynamics;
    let velocity = match command.goal {
        Goal::Velocity { velocity, .. } => velocity.abs(),
        Goal::Rest => dynamics.velocity.unwrap_or(0.0),
        _ => dynamics.velocity.unwrap_or(limits.velocity),
    };
    [
        velocity,
        dynamics.acceleration.max(dynamics.deceleration),
        dynamics.jerk.unwrap_or(limits.jerk),
        dynamics.snap.unwrap_or(limits.snap),
    ]
}

const fn supply(limits: &Limits) -> [f64; 4] {
    [limits.velocity, limits.acceleration, limits.jerk, limits.snap]
}

impl Axis {
    /// Checks that a command that does not abort leaves enough of the limits to the superimposed motion.
    pub(super) fn check_beside(&self, command: &Command) -> Result<(), BlockError> {
        match &self.superimposed {
            Some(superimposed) if superimposed.run.is_leading_in() => Err(self.nothing_to_spare(command)),
            Some(superimposed) => self.check_sum(command.block, &superimposed.command, command),
            None => Ok(()),
        }
    }

    /// Checks that two superimposed motions keep the limits of the axis together.
    pub(super) fn check_sum(&self, block: BlockName, one: &Command, other: &Command) -> Result<(), BlockError> {
        let limits = &self.params.limits;
        let sums = demand(one, limits).into_iter().zip(demand(other, limits)).map(|(one, other)| one + other);
        match sums.zip(supply(limits)).zip(INPUTS).find(|((value, limit), _)| value > limit) {
            Some(((value, limit), input)) => Err(BlockError::SumAboveLimit { block, input, value, limit }),
            None => Ok(()),
        }
    }

    /// Refusal of a motion on top of one that uses the whole axis for a while.
    pub(super) fn nothing_to_spare(&self, command: &Command) -> BlockError {
        let (limit, own) = (self.params.limits.jerk, demand(command, &self.params.limits)[2]);
        BlockError::SumAboveLimit { block: command.block, input: INPUTS[2], value: limit + own, limit }
    }

    /// Bounds left by a superimposed motion.
    pub(super) fn beside(&self) -> Bounds {
        self.without(&self.used_on_top())
    }

    /// Bounds left by the active and waiting commands below a superimposed motion.
    pub(super) fn on_top(&self) -> Bounds {
        let used = match &self.activity {
            Activity::Moving(moving) => moving.run.bounds_beyond_command().map_or([0.0; 4], used_of),
            _ => [0.0; 4],
        };
        self.without(&most(used, self.used_below()))
    }

    /// Bounds of the motion below when it and the superimposed one are replanned: half of what neither command requests is added.
    pub(super) fn half_beside(&self) -> Bounds {
        let (limits, below) = (supply(&self.params.limits), self.used_below());
        let Some(superimposed) = &self.superimposed else { return self.beside() };
        let on_top = demand(&superimposed.command, &self.params.limits);
        let half = |k: usize| if limits[k] < f64::INFINITY { 0.5 * (limits[k] - below[k] - on_top[k]) } else { 0.0 };
        self.without(&core::array::from_fn(|k| on_top[k] + half(k).max(0.0)))
    }

    /// Active and waiting commands, without the superimposed one.
    pub(super) fn below(&self) -> impl Iterator<Item = &Command> {
        let active = self.activity.command().map(|(_, command)| command);
        active.into_iter().chain(self.queue.iter().map(|(_, command)| command))
    }

    /// Most that any of the commands below a superimposed motion requests.
    fn used_below(&self) -> [f64; 4] {
        self.below().fold([0.0; 4], |used, command| most(used, demand(command, &self.params.limits)))
    }

    /// Most that a superimposed motion uses.
    fn used_on_top(&self) -> [f64; 4] {
        let Some(superimposed) = &self.superimposed else { return [0.0; 4] };
        let used = superimposed.run.bounds_beyond_command().map_or([0.0; 4], used_of);
        most(used, demand(&superimposed.command, &self.params.limits))
    }

    /// Bounds of the axis minus `used`.
    fn without(&self, used: &[f64; 4]) -> Bounds {
        let limits = supply(&self.params.limits);
        // An infinite limit stays infinite, whatever is used.
        let left = |k: usize| if limits[k] < f64::INFINITY { limits[k] - used[k] } else { limits[k] };
        Bounds { velocity: left(0), acceleration: left(1), deceleration: left(1), jerk: left(2), snap: left(3) }
    }
}

const fn used_of(bounds: &Bounds) -> [f64; 4] {
    [bounds.velocity, bounds.acceleration.max(bounds.deceleration), bounds.jerk, bounds.snap]
}

fn most(one: [f64; 4], other: [f64; 4]) -> [f64; 4] {
    core::array::from_fn(|k| one[k].max(other[k]))
}
