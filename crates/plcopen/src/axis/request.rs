//! Request of the program: the demand of its commands on the axis in a cycle.
use super::Axis;
use super::activity::{Activity, Led, Moving};
use crate::command::{Command, Ending, Goal};
use crate::state::AxisState;
use servobench_base::Request;

/// Demand of a command's goal while it runs, and once its trajectory has passed the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// Nothing: the drive or the axis searches for a reference.
    Nothing,
    /// To stand still.
    Stand,
    /// To follow the set-point.
    Position,
    /// The velocity of the set-point.
    Velocity,
}

/// Demand of a goal; `is_over`: true if the planned trajectory is over.
const fn wanted(goal: &Goal, is_over: bool) -> Wanted {
    match goal {
        Goal::Absolute { end_velocity: None, .. } | Goal::Relative { end_velocity: None, .. } | Goal::Additive(_) => {
            Wanted::Position
        }
        Goal::Absolute { end_velocity: Some(_), .. } | Goal::Relative { end_velocity: Some(_), .. } => {
            if is_over {
                Wanted::Velocity
            } else {
                Wanted::Position
            }
        }
        Goal::Velocity { .. } => Wanted::Velocity,
        Goal::Rest => Wanted::Stand,
        Goal::Led(Ending::AtRest | Ending::Moving) => Wanted::Position,
        // An effort is a separate activity.
        Goal::Reference(_) | Goal::Obstacle(_) | Goal::Away(_) | Goal::Effort { .. } => Wanted::Nothing,
    }
}

impl Axis {
    /// Request of the cycle that ended last, positions as [sent](Self::sent).
    #[must_use]
    pub const fn request(&self) -> Request {
        self.request
    }

    /// Request of this cycle, while the field still holds that of the cycle before.
    pub(super) fn requested(&self) -> Request {
        if !self.is_powered() || matches!(self.state, AxisState::Disabled | AxisState::ErrorStop | AxisState::Homing) {
            return Request::Nothing;
        }
        let of = |command: &Command, is_over| match wanted(&command.goal, is_over) {
            Wanted::Nothing => Request::Nothing,
            Wanted::Stand => Request::Stand,
            Wanted::Position => Request::Follow(self.setpoint),
            Wanted::Velocity => Request::Velocity(self.setpoint.v),
        };
        match &self.activity {
            Activity::Rest if self.superimposed.is_some() => Request::Follow(self.setpoint),
            // The end of a followed trajectory is a target; any other axis at rest stands.
            Activity::Rest => match self.request {
                Request::Follow(_) | Request::Rest(_) => Request::Rest(self.setpoint.x),
                _ => Request::Stand,
            },
            Activity::Moving(Moving { command, run, .. }) => of(command, run.is_over()),
            Activity::Led(Led { command, .. }) => of(command, false),
            Activity::Effort(effort) => Request::Effort(effort.present),
            Activity::Homing(_) | Activity::Search(_) | Activity::Leaving(_) => Request::Nothing,
        }
    }
}
