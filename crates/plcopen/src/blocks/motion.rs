//! A block that gives one motion command.
use super::execution::{Execution, Report};
use super::outputs::{FunctionBlock, Outputs};
use crate::axis::Axis;
use crate::command::Command;
use crate::error::BlockError;
use crate::name::BlockName;

/// The inputs of a block that gives one motion command.
pub trait MotionInputs: Copy + PartialEq {
    /// Name of the block.
    const NAME: BlockName;
    /// Outputs of the block.
    type Outputs: Outputs + From<Report>;

    /// Execute.
    fn execute(&self) -> bool;

    /// ContinuousUpdate, for the blocks that have it.
    fn continuous_update(&self) -> bool {
        false
    }

    /// The command that these inputs ask for.
    fn command(&self) -> Command;
}

/// A block that gives one motion command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionBlock<I> {
    execution: Execution,
    /// The inputs that act, where they may change.
    updated: Option<I>,
}

impl<I> Default for MotionBlock<I> {
    fn default() -> Self {
        Self { execution: Execution::default(), updated: None }
    }
}

impl<I: MotionInputs> FunctionBlock for MotionBlock<I> {
    const NAME: BlockName = I::NAME;
    type Inputs<'i> = I;
    type Outputs = I::Outputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &I) -> I::Outputs {
        let updated = &mut self.updated;
        let report = self.execution.step(axis, inputs.execute(), |axis| {
            *updated = inputs.continuous_update().then_some(*inputs);
            axis.submit(inputs.command()).map(Some)
        });
        let report = match &mut self.updated {
            Some(latched) if report.is_busy() && inputs.execute() && *latched != *inputs => {
                *latched = *inputs;
                let changed = self.execution.running().map(|id| axis.update(id, inputs.command()));
                match changed {
                    Some(Err(error)) => self.execution.fail(error),
                    _ => report,
                }
            }
            _ => report,
        };
        report.into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
