//! `MC_TouchProbe`, `MC_AbortTrigger`: position of the axis at a trigger.
//!
//! The drive latches the position (60B8h to 60BBh) and the link passes it on. It has one probe: another MC_TouchProbe takes it over.
use super::execution::Execution;
use super::outputs::{DoneOutputs, FunctionBlock, MotionOutputs};
use crate::axis::{Axis, Probed};
use crate::blocks::{BlockName, Input};
use crate::error::{BlockError, ErrorId};
use crate::interface::{inputs, optional, outputs, required};
use servobench_base::Stateful;
use servobench_fieldbus::ProbeTrigger;

/// Records the position at the first trigger.
///
/// A trigger outside the window does not count: the block requests the next one, and misses one that comes before the drive is armed again.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct TouchProbe {
    execution: Execution,
    /// Number of the request to the drive, while it is active.
    number: Option<u32>,
    latched: Option<TouchProbeInputs>,
    recorded: f64,
}

/// Aborts a waiting MC_TouchProbe.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct AbortTrigger {
    execution: Execution,
}

inputs! {
    /// Inputs of [`TouchProbe`].
    pub struct TouchProbeInputs on execute {
        /// TriggerInput.
        trigger: ProbeTrigger = required(Input::TriggerInput),
        /// FirstPosition (m or rad); `None` for a window without a beginning.
        first_position: Option<f64> = optional(Input::FirstPosition),
        /// LastPosition (m or rad); `None` for a window without an end.
        last_position: Option<f64> = optional(Input::LastPosition),
    }
}

inputs! {
    /// Inputs of [`AbortTrigger`].
    #[derive(Eq, Default)]
    pub struct AbortTriggerInputs on execute {}
}

outputs! {
    /// Outputs of [`TouchProbe`].
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct TouchProbeOutputs {
        /// Done: the position is recorded.
        done: bool = Done,
        /// Busy: the block waits for the trigger.
        busy: bool = Busy,
        /// CommandAborted: by MC_AbortTrigger, or another MC_TouchProbe.
        command_aborted: bool = CommandAborted,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// RecordedPosition (m or rad) of the last trigger.
        recorded_position: f64 = RecordedPosition,
    }
}

impl TouchProbeInputs {
    /// Checks the window for an axis with the period `modulo`, or with ends.
    fn check(&self, modulo: Option<f64>) -> Result<(), BlockError> {
        let window = [("FirstPosition", self.first_position), ("LastPosition", self.last_position)];
        for (input, value) in window.into_iter().filter_map(|(input, value)| Some((input, value?))) {
            crate::command::finite_input(BlockName::TouchProbe, input, value)?;
        }
        match (self.first_position, self.last_position) {
            (Some(first), Some(last)) if first > last && modulo.is_none() => Err(BlockError::Input {
                block: BlockName::TouchProbe,
                input: "LastPosition",
                value: last,
                bound: "at FirstPosition or beyond it",
            }),
            _ => Ok(()),
        }
    }

    fn accepts(&self, position: f64) -> bool {
        let is_behind = self.first_position.is_none_or(|first| position >= first);
        let is_before = self.last_position.is_none_or(|last| position <= last);
        match (self.first_position, self.last_position) {
            // Across the zero of a modulo axis.
            (Some(first), Some(last)) if first > last => is_behind || is_before,
            _ => is_behind && is_before,
        }
    }
}

impl FunctionBlock for TouchProbe {
    const NAME: BlockName = BlockName::TouchProbe;
    type Inputs<'i> = TouchProbeInputs;
    type Outputs = TouchProbeOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &TouchProbeInputs) -> TouchProbeOutputs {
        let Self { execution, number, latched, recorded } = self;
        let mut report = execution.step(axis, inputs.execute, |axis| {
            *number = None;
            inputs.check(axis.params().modulo)?;
            (*latched, *number) = (Some(*inputs), Some(axis.probe(inputs.trigger)));
            Ok(None)
        });
        if let (Some(asked), Some(latched)) = (*number, latched) {
            match axis.probed(asked) {
                Probed::Waiting => {}
                Probed::At(position) if latched.accepts(position) => {
                    axis.end_probe();
                    (*recorded, *number) = (position, None);
                    report = execution.complete();
                }
                Probed::At(_) => *number = Some(axis.probe(latched.trigger)),
                Probed::Aborted => {
                    *number = None;
                    report = execution.abort();
                }
            }
        }
        let MotionOutputs { done, busy, command_aborted, error, error_id, .. } = report.into();
        TouchProbeOutputs { done, busy, command_aborted, error, error_id, recorded_position: *recorded }
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

impl FunctionBlock for AbortTrigger {
    const NAME: BlockName = BlockName::AbortTrigger;
    type Inputs<'i> = AbortTriggerInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &AbortTriggerInputs) -> DoneOutputs {
        let abort = |axis: &mut Axis| {
            axis.end_probe();
            Ok(())
        };
        self.execution.at_once(axis, inputs.execute, abort).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
