//! `MC_Halt` and `MC_Stop`: brake to rest.
use super::execution::{Execution, Report};
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::{FunctionBlock, MotionOutputs};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::{BlockError, ErrorId};
use crate::interface::{braking, buffer_mode, inputs, limit_if_any, outputs};
use crate::ledger::CommandId;
use servobench_base::Stateful;
use servobench_motion::Limits;

/// Brakes to rest; another command may take over meanwhile.
pub type Halt = MotionBlock<HaltInputs>;

inputs! {
    /// Inputs of [`Halt`].
    pub struct HaltInputs on execute {
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 = braking(),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
        /// BufferMode.
        buffer_mode: BufferMode = buffer_mode(),
    }
}

impl HaltInputs {
    /// Inputs of braking as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        let StopInputs { execute, deceleration, jerk, snap } = StopInputs::within(limits);
        Self { execute, deceleration, jerk, snap, buffer_mode: BufferMode::default() }
    }
}

impl MotionInputs for HaltInputs {
    const NAME: BlockName = BlockName::Halt;
    type Outputs = MotionOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn command(&self) -> Command {
        let Self { deceleration, jerk, snap, buffer_mode, .. } = *self;
        let dynamics = Dynamics::braking(deceleration, jerk, snap);
        Command { block: Self::NAME, goal: Goal::Rest, dynamics, buffer_mode }
    }
}

/// Brakes to rest; the axis takes no other command until Execute is FALSE and it stands still.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Stop {
    execution: Execution,
    /// The command while Execute is TRUE.
    holding: Option<CommandId>,
}

inputs! {
    /// Inputs of [`Stop`].
    pub struct StopInputs on execute {
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 = braking(),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
    }
}

impl StopInputs {
    /// Inputs of braking as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
        }
    }
}

outputs! {
    /// Outputs of [`Stop`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct StopOutputs {
        /// Done: the axis stands still.
        done: bool = Done,
        /// Busy: the axis brakes.
        busy: bool = Busy,
        /// CommandAborted: the power was taken away.
        command_aborted: bool = CommandAborted,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
}

impl From<Report> for StopOutputs {
    fn from(report: Report) -> Self {
        let MotionOutputs { done, busy, command_aborted, error, error_id, .. } = report.into();
        Self { done, busy, command_aborted, error, error_id }
    }
}

impl FunctionBlock for Stop {
    const NAME: BlockName = BlockName::Stop;
    type Inputs<'i> = StopInputs;
    type Outputs = StopOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &StopInputs) -> StopOutputs {
        let StopInputs { execute, deceleration, jerk, snap } = *inputs;
        if !execute && let Some(id) = self.holding.take() {
            axis.release_stop(id);
        }
        let (holding, before) = (&mut self.holding, self.execution.running());
        let report = self.execution.step(axis, execute, |axis| {
            let dynamics = Dynamics::braking(deceleration, jerk, snap);
            let buffer_mode = BufferMode::Aborting;
            let id = axis.stop(Command { block: Self::NAME, goal: Goal::Rest, dynamics, buffer_mode }, before)?;
            *holding = Some(id);
            Ok(Some(id))
        });
        report.into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
