//! `MC_Reset`: leaves ErrorStop.
use super::execution::{Execution, Report};
use super::outputs::{DoneOutputs, FunctionBlock};
use crate::axis::Axis;
use crate::blocks::BlockName;
use crate::error::BlockError;
use crate::interface::inputs;
use servobench_base::Stateful;

/// Clears the error of the axis, once its cause is gone and the axis at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Reset {
    execution: Execution,
}

inputs! {
    /// Inputs of [`Reset`].
    #[derive(Eq, Default)]
    pub struct ResetInputs on execute {}
}

impl FunctionBlock for Reset {
    const NAME: BlockName = BlockName::Reset;
    type Inputs<'i> = ResetInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ResetInputs) -> DoneOutputs {
        let report = self.execution.step(axis, inputs.execute, |axis| axis.ask_reset().map(|()| None));
        if report == Report::Active && !axis.is_resetting() { self.execution.complete() } else { report }.into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
