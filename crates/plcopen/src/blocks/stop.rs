//! `MC_Halt` and `MC_Stop`: to rest.
use super::execution::{Execution, Report};
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::{FunctionBlock, MotionOutputs, Outputs, flag, number};
use crate::axis::Axis;
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::{BlockError, ErrorId};
use crate::ledger::CommandId;
use crate::name::BlockName;
use servobench_motion::Limits;

/// To rest; another command may take the axis on the way.
pub type Halt = MotionBlock<HaltInputs>;

/// Inputs of [`Halt`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HaltInputs {
    /// Execute.
    pub execute: bool,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl HaltInputs {
    /// As fast as `limits` allow, not executed.
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

/// To rest; the axis takes no other command until Execute is FALSE and it stands still.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stop {
    execution: Execution,
    /// The command while Execute is TRUE.
    holding: Option<CommandId>,
}

/// Inputs of [`Stop`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopInputs {
    /// Execute.
    pub execute: bool,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
}

impl StopInputs {
    /// As fast as `limits` allow, not executed.
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

/// Outputs of [`Stop`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct StopOutputs {
    /// Done: the axis stands still.
    pub done: bool,
    /// Busy: it brakes.
    pub busy: bool,
    /// CommandAborted: the power was taken away.
    pub command_aborted: bool,
    /// Error.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

impl From<Report> for StopOutputs {
    fn from(report: Report) -> Self {
        let MotionOutputs { done, busy, command_aborted, error, error_id, .. } = report.into();
        Self { done, busy, command_aborted, error, error_id }
    }
}

impl Outputs for StopOutputs {
    const NAMES: &'static [&'static str] = &["Done", "Busy", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { done, busy, command_aborted, error, error_id } = *self;
        [done, busy, command_aborted, error].map(flag).into_iter().chain([number(error_id)]).for_each(record);
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
