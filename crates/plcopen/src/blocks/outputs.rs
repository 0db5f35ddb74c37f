//! The trait of all blocks, and the outputs that most have in common.
use super::execution::Report;
use crate::axis::Axis;
use crate::blocks::{BlockName, Output};
use crate::error::{BlockError, ErrorId};
use crate::interface::{BlockInputs, command_outputs, outputs};

/// A function block: an instance keeps the state of the standard's instance.
pub trait FunctionBlock {
    /// Block name.
    const NAME: BlockName;
    /// Inputs, borrowed for a call at most.
    type Inputs<'i>: BlockInputs<'i>;
    /// Outputs.
    type Outputs: Outputs;

    /// Handles one call: between [`Axis::begin`] and [`Axis::end`], once per cycle.
    fn step(&mut self, axis: &mut Axis, inputs: &Self::Inputs<'_>) -> Self::Outputs;

    /// Error behind ErrorID; `None` while Error is FALSE.
    fn error(&self) -> Option<&BlockError> {
        None
    }
}

/// Outputs that can be recorded.
pub trait Outputs: Copy {
    /// List of the outputs, in the order of the standard.
    const LIST: &'static [Output];

    /// Passes the values to `record`, in the order of the list; TRUE is 1.
    fn each(&self, record: impl FnMut(f64));
}

command_outputs! {
    /// Outputs of a block that moves the axis to an end.
    pub struct MotionOutputs;
    /// Done: the target is reached.
    done = Done by Done
}

outputs! {
    /// Outputs of a block that ends with Done and without a motion.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct DoneOutputs {
        /// Done.
        done: bool = Done,
        /// Busy: not done yet.
        busy: bool = Busy,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
}

impl From<Report> for DoneOutputs {
    fn from(report: Report) -> Self {
        let MotionOutputs { done, busy, error, error_id, .. } = report.into();
        Self { done, busy, error, error_id }
    }
}
