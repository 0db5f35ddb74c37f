//! `MC_MoveSuperimposed`: moves by a distance on top of the active motion.
use super::execution::{Execution, Report};
use super::outputs::{FunctionBlock, MotionOutputs};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::{BlockError, ErrorId};
use crate::interface::{flag, inputs, like, limit, limit_if_any, outputs, required};
use servobench_base::Stateful;
use servobench_motion::Limits;

/// Moves by a distance on top of the motion below, which continues; at Standstill it is the only motion.
///
/// A command that aborts the motion below aborts this one too; buffered and blended ones leave it alone, and end at their target plus the
/// distance. A second one replaces the first and counts from its present position.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct MoveSuperimposed {
    execution: Execution,
    /// Inputs in effect.
    latched: Option<MoveSuperimposedInputs>,
    covered: f64,
}

inputs! {
    /// Inputs of [`MoveSuperimposed`].
    pub struct MoveSuperimposedInputs on execute {
        /// Distance (m or rad).
        distance: f64 = required(Input::Distance),
        /// VelocityDiff: the velocity on top (m/s or rad/s).
        velocity_diff: f64 = required(Input::VelocityDifference),
        /// Acceleration (m/s² or rad/s²).
        acceleration: f64 = limit(Input::Acceleration),
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 = like(Input::Deceleration, Input::Acceleration),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
        /// ContinuousUpdate.
        continuous_update: bool = flag(Input::ContinuousUpdate, false),
    }
}

impl MoveSuperimposedInputs {
    /// Inputs of a zero distance as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            distance: 0.0,
            velocity_diff: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
        }
    }

    fn command(&self) -> Command {
        let Self { velocity_diff, acceleration, deceleration, jerk, snap, .. } = *self;
        Command {
            block: BlockName::MoveSuperimposed,
            goal: Goal::Relative { distance: self.distance, end_velocity: None },
            dynamics: Dynamics { velocity: Some(velocity_diff), acceleration, deceleration, jerk, snap },
            buffer_mode: BufferMode::Aborting,
        }
    }
}

outputs! {
    /// Outputs of [`MoveSuperimposed`].
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct MoveSuperimposedOutputs {
        /// Done: the distance is covered.
        done: bool = Done,
        /// Busy: the distance is not yet covered.
        busy: bool = Busy,
        /// CommandAborted: another command took the axis.
        command_aborted: bool = CommandAborted,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// CoveredDistance since the superimposed motion began (m or rad).
        covered_distance: f64 = CoveredDistance,
    }
}

impl FunctionBlock for MoveSuperimposed {
    const NAME: BlockName = BlockName::MoveSuperimposed;
    type Inputs<'i> = MoveSuperimposedInputs;
    type Outputs = MoveSuperimposedOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &MoveSuperimposedInputs) -> MoveSuperimposedOutputs {
        let Self { execution, latched, covered } = self;
        let mut report = execution.step(axis, inputs.execute, |axis| {
            (*latched, *covered) = (Some(*inputs), 0.0);
            axis.superimpose(&inputs.command(), inputs.distance).map(Some)
        });
        if let Some(id) = execution.running() {
            if let Some(latched) = latched
                && latched.continuous_update
                && inputs.execute
                && latched != inputs
            {
                *latched = *inputs;
                if let Err(error) = axis.update_superimposed(id, &inputs.command(), inputs.distance) {
                    report = execution.fail(error);
                }
            }
            *covered = axis.covered(id).unwrap_or(*covered);
        } else if report == Report::Done {
            *covered = latched.map_or(0.0, |latched| latched.distance);
        } else if report == Report::Idle {
            *covered = 0.0;
        }
        let MotionOutputs { done, busy, command_aborted, error, error_id, .. } = report.into();
        MoveSuperimposedOutputs { done, busy, command_aborted, error, error_id, covered_distance: *covered }
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
