//! What every block is, and the outputs that most have in common.
use super::execution::Report;
use crate::axis::Axis;
use crate::error::{BlockError, ErrorId};
use crate::name::BlockName;

/// A function block: an instance keeps what the standard's instance keeps.
pub trait FunctionBlock {
    /// Its name.
    const NAME: BlockName;
    /// Its inputs, borrowed for a call at most.
    type Inputs<'i>;
    /// Its outputs.
    type Outputs: Outputs;

    /// One call: between [`Axis::begin`] and [`Axis::end`], once per cycle.
    fn step(&mut self, axis: &mut Axis, inputs: &Self::Inputs<'_>) -> Self::Outputs;

    /// What ErrorID stands for, in words; `None` while Error is FALSE.
    fn error(&self) -> Option<&BlockError> {
        None
    }
}

/// Outputs as a recording keeps them.
pub trait Outputs: Copy {
    /// Names in the spelling and order of the standard.
    const NAMES: &'static [&'static str];

    /// Hands the values to `record`, in the order of the names; TRUE is 1.
    fn each(&self, record: impl FnMut(f64));
}

/// Outputs of a block that moves the axis to an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct MotionOutputs {
    /// Done: the target is reached.
    pub done: bool,
    /// Busy: there is something left to do.
    pub busy: bool,
    /// Active: the block has the axis.
    pub active: bool,
    /// CommandAborted: another command took the axis.
    pub command_aborted: bool,
    /// Error.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

/// Outputs of a block that does something which is then done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DoneOutputs {
    /// Done.
    pub done: bool,
    /// Busy: there is something left to do.
    pub busy: bool,
    /// Error.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

impl From<Report> for MotionOutputs {
    fn from(report: Report) -> Self {
        Self {
            done: report == Report::Done,
            busy: report.is_busy(),
            active: report.is_active(),
            command_aborted: report == Report::Aborted,
            error: report.error_id() != ErrorId::None,
            error_id: report.error_id(),
        }
    }
}

impl From<Report> for DoneOutputs {
    fn from(report: Report) -> Self {
        let MotionOutputs { done, busy, error, error_id, .. } = report.into();
        Self { done, busy, error, error_id }
    }
}

impl Outputs for MotionOutputs {
    const NAMES: &'static [&'static str] = &["Done", "Busy", "Active", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { done, busy, active, command_aborted, error, error_id } = *self;
        [done, busy, active, command_aborted, error].map(flag).into_iter().chain([number(error_id)]).for_each(record);
    }
}

impl Outputs for DoneOutputs {
    const NAMES: &'static [&'static str] = &["Done", "Busy", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { done, busy, error, error_id } = *self;
        [done, busy, error].map(flag).into_iter().chain([number(error_id)]).for_each(record);
    }
}

/// A BOOL as it is recorded.
pub(super) fn flag(value: bool) -> f64 {
    f64::from(u8::from(value))
}

/// An ErrorID as it is recorded.
pub(super) fn number(id: ErrorId) -> f64 {
    f64::from(id.number())
}
