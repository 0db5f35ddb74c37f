//! What every block is, and the outputs that most have in common.
use super::execution::Report;
use crate::axis::Axis;
use crate::blocks::{BlockName, Output};
use crate::error::{BlockError, ErrorId};
use crate::interface::{BlockInputs, command_outputs, outputs};

/// A function block: an instance keeps what the standard's instance keeps.
pub trait FunctionBlock {
    /// Its name.
    const NAME: BlockName;
    /// Its inputs, borrowed for a call at most.
    type Inputs<'i>: BlockInputs<'i>;
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
    /// Which, in the order of the standard.
    const LIST: &'static [Output];

    /// Hands the values to `record`, in the order of the list; TRUE is 1.
    fn each(&self, record: impl FnMut(f64));
}

command_outputs! {
    /// Outputs of a block that moves the axis to an end.
    pub struct MotionOutputs;
    /// Done: the target is reached.
    done = Done by Done
}

outputs! {
    /// Outputs of a block that does something which is then done.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct DoneOutputs {
        /// Done.
        done: bool = Done,
        /// Busy: there is something left to do.
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
