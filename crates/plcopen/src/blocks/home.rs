//! `MC_Home`: the reference.
use super::execution::Execution;
use super::outputs::{FunctionBlock, MotionOutputs};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::BlockError;
use crate::interface::{buffer_mode, inputs, or};

/// Has the drive look for its reference, by the method that it is set to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Home {
    execution: Execution,
}

inputs! {
    /// Inputs of [`Home`].
    #[derive(Default)]
    pub struct HomeInputs on execute {
        /// Position of the reference (m or rad).
        position: f64 = or(Input::Position, 0.0),
        /// BufferMode: aborting at Standstill, where there is nothing to abort, or buffered behind a command that ends there.
        buffer_mode: BufferMode = buffer_mode(),
    }
}

impl FunctionBlock for Home {
    const NAME: BlockName = BlockName::Home;
    type Inputs<'i> = HomeInputs;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HomeInputs) -> MotionOutputs {
        let HomeInputs { execute, position, buffer_mode } = *inputs;
        let (goal, dynamics) = (Goal::Reference(position), Dynamics::NONE);
        let command = Command { block: Self::NAME, goal, dynamics, buffer_mode };
        self.execution.step(axis, execute, |axis| axis.submit(command).map(Some)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
