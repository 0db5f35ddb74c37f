//! What a motion leaves of the axis to another one on top of it.
use super::Axis;
use super::bounds::Bounds;
use crate::command::{Command, Goal};
use crate::error::BlockError;
use crate::name::BlockName;
use servobench_motion::Limits;

const INPUTS: [&str; 4] = ["Velocity", "Acceleration", "Jerk", "Snap"];

/// What a command uses at most, in the order of the inputs.
fn demand(command: &Command, limits: &Limits) -> [f64; 4] {
    let dynamics = &command.dynamics;
    let velocity = match command.goal {
        Goal::Velocity { velocity, .. } => velocity.abs(),
        Goal::Rest => 0.0,
        _ => dynamics.velocity,
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
    /// Whether a command that does not abort leaves the superimposed motion what it needs.
    pub(super) fn check_beside(&self, command: &Command) -> Result<(), BlockError> {
        match &self.superimposed {
            Some(superimposed) if superimposed.run.is_leading_in() => Err(self.nothing_to_spare(command)),
            Some(superimposed) => self.check_sum(command.block, &superimposed.command, command),
            None => Ok(()),
        }
    }

    /// Two motions on top of each other keep the limits of the axis together.
    pub(super) fn check_sum(&self, block: BlockName, one: &Command, other: &Command) -> Result<(), BlockError> {
        let limits = &self.params.limits;
        let sums = demand(one, limits).into_iter().zip(demand(other, limits)).map(|(one, other)| one + other);
        match sums.zip(supply(limits)).zip(INPUTS).find(|((value, limit), _)| value > limit) {
            Some(((value, limit), input)) => Err(BlockError::SumAboveLimit { block, input, value, limit }),
            None => Ok(()),
        }
    }

    /// The refusal of a motion on top of one that uses all that the axis has for a while.
    pub(super) fn nothing_to_spare(&self, command: &Command) -> BlockError {
        let (limit, own) = (self.params.limits.jerk, demand(command, &self.params.limits)[2]);
        BlockError::SumAboveLimit { block: command.block, input: INPUTS[2], value: limit + own, limit }
    }

    /// What the axis has beside a superimposed motion.
    pub(super) fn beside(&self) -> Bounds {
        self.spare(self.superimposed.as_ref().map(|superimposed| &superimposed.command))
    }

    /// What the axis has beside the commands that run or wait below a superimposed motion.
    pub(super) fn on_top(&self) -> Bounds {
        self.spare(self.below())
    }

    /// The commands that run or wait, without the one on top of them.
    pub(super) fn below(&self) -> impl Iterator<Item = &Command> {
        let active = self.activity.command().map(|(_, command)| command);
        active.into_iter().chain(self.queue.iter().map(|(_, command)| command))
    }

    /// What the axis has beside the most that one of `others` uses.
    pub(super) fn spare<'a>(&self, others: impl IntoIterator<Item = &'a Command>) -> Bounds {
        let limits = &self.params.limits;
        let used = others.into_iter().fold([0.0; 4], |used: [f64; 4], command| {
            let demand = demand(command, limits);
            core::array::from_fn(|k| used[k].max(demand[k]))
        });
        let [velocity, acceleration, jerk, snap] = supply(limits);
        // Of an infinite limit all is left, whatever is used.
        let left = |limit: f64, used: f64| if limit < f64::INFINITY { limit - used } else { limit };
        let acceleration = left(acceleration, used[1]);
        Bounds {
            velocity: left(velocity, used[0]),
            acceleration,
            deceleration: acceleration,
            jerk: left(jerk, used[2]),
            snap: left(snap, used[3]),
        }
    }
}
