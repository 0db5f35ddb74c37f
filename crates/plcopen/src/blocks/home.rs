//! `MC_Home`: the reference.
use super::execution::Execution;
use super::outputs::{FunctionBlock, MotionOutputs};
use crate::axis::Axis;
use crate::command::BufferMode;
use crate::error::BlockError;
use crate::name::BlockName;

/// Has the drive look for its reference, by the method that it is set to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Home {
    execution: Execution,
}

/// Inputs of [`Home`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HomeInputs {
    /// Execute.
    pub execute: bool,
    /// Position of the reference (m or rad).
    pub position: f64,
    /// BufferMode. Homing begins at Standstill, where no command is before it, so that all are the same.
    pub buffer_mode: BufferMode,
}

impl FunctionBlock for Home {
    const NAME: BlockName = BlockName::Home;
    type Inputs<'i> = HomeInputs;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HomeInputs) -> MotionOutputs {
        self.execution.step(axis, inputs.execute, |axis| axis.home(inputs.position).map(Some)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
