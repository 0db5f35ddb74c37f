//! `MC_SetPosition`: sets the position that the program sees.
use super::execution::Execution;
use super::outputs::{DoneOutputs, FunctionBlock};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::error::BlockError;
use crate::interface::{flag, inputs, required};
use servobench_base::Stateful;

/// Shifts the position that the program sees, actual and commanded alike, without a motion; active commands continue to their targets.
/// Refused in Homing, which sets the position itself. ExecutionMode is left out: it is always immediately.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct SetPosition {
    execution: Execution,
}

inputs! {
    /// Inputs of [`SetPosition`].
    #[derive(Default)]
    pub struct SetPositionInputs on execute {
        /// Position (m or rad): the actual one from now on; with Relative, the shift.
        position: f64 = required(Input::Position),
        /// Relative.
        relative: bool = flag(Input::Relative, false),
    }
}

impl FunctionBlock for SetPosition {
    const NAME: BlockName = BlockName::SetPosition;
    type Inputs<'i> = SetPositionInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &SetPositionInputs) -> DoneOutputs {
        let SetPositionInputs { execute, position, relative } = *inputs;
        self.execution.at_once(axis, execute, |axis| axis.set_position(position, relative)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
