//! `MC_MoveSuperimposed`: by a distance, on top of what runs.
use super::execution::Execution;
use super::outputs::{FunctionBlock, MotionOutputs, Outputs};
use crate::axis::Axis;
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::BlockError;
use crate::name::BlockName;
use servobench_motion::Limits;

/// By a distance on top of the motion below, which goes on; at Standstill on its own.
///
/// A command that aborts the motion below aborts this one too; buffered and blended ones leave it alone, and lead to where they
/// lead plus the distance. A second one replaces the first and counts from where that one is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MoveSuperimposed {
    execution: Execution,
    covered: f64,
    distance: f64,
}

/// Inputs of [`MoveSuperimposed`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveSuperimposedInputs {
    /// Execute.
    pub execute: bool,
    /// Distance (m or rad).
    pub distance: f64,
    /// VelocityDiff: the velocity on top (m/s or rad/s).
    pub velocity_diff: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
}

impl MoveSuperimposedInputs {
    /// By no distance as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            distance: 0.0,
            velocity_diff: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
        }
    }
}

/// Outputs of [`MoveSuperimposed`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MoveSuperimposedOutputs {
    /// Done, Busy, Active, CommandAborted, Error, ErrorID.
    pub motion: MotionOutputs,
    /// CoveredDistance since the motion on top began (m or rad).
    pub covered_distance: f64,
}

impl FunctionBlock for MoveSuperimposed {
    const NAME: BlockName = BlockName::MoveSuperimposed;
    type Inputs = MoveSuperimposedInputs;
    type Outputs = MoveSuperimposedOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &MoveSuperimposedInputs) -> MoveSuperimposedOutputs {
        let Self { execution, covered, distance } = self;
        let motion: MotionOutputs = execution
            .step(axis, inputs.execute, |axis| {
                let MoveSuperimposedInputs { velocity_diff: velocity, acceleration, deceleration, jerk, snap, .. } =
                    *inputs;
                let command = Command {
                    block: Self::NAME,
                    goal: Goal::Relative(inputs.distance),
                    dynamics: Dynamics { velocity, acceleration, deceleration, jerk, snap },
                    buffer_mode: BufferMode::Aborting,
                };
                (*covered, *distance) = (0.0, inputs.distance);
                axis.superimpose(&command, inputs.distance).map(Some)
            })
            .into();
        if let Some(now) = execution.running().and_then(|id| axis.covered(id)) {
            *covered = now;
        }
        let covered_distance = if motion.done { *distance } else { *covered };
        let is_idle = !(motion.done || motion.busy || motion.command_aborted || motion.error);
        MoveSuperimposedOutputs { motion, covered_distance: if is_idle { 0.0 } else { covered_distance } }
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

impl Outputs for MoveSuperimposedOutputs {
    const NAMES: &'static [&'static str] =
        &["Done", "Busy", "Active", "CommandAborted", "Error", "ErrorID", "CoveredDistance"];

    fn each(&self, mut record: impl FnMut(f64)) {
        self.motion.each(&mut record);
        record(self.covered_distance);
    }
}
