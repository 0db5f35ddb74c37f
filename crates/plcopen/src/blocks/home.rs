//! `MC_Home`, and of part 5 `MC_HomeDirect` and `MC_HomeAbsolute`: the reference of the position.
use super::execution::Execution;
use super::outputs::{FunctionBlock, MotionOutputs};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Goal, Reference};
use crate::error::BlockError;
use crate::interface::{buffer_mode, inputs, or};
use servobench_base::Stateful;

/// Starts the drive's search for its reference, by its configured method.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Home {
    execution: Execution,
}

/// Sets the position of an axis at rest, without a motion: its reference from then on.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct HomeDirect {
    execution: Execution,
}

/// Takes the position of the drive's absolute encoder for that of the axis: without a motion, and without the offset of MC_SetPosition or
/// MC_HomeDirect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct HomeAbsolute {
    execution: Execution,
}

inputs! {
    /// Inputs of [`Home`].
    #[derive(Default)]
    pub struct HomeInputs on execute {
        /// Position of the reference (m or rad).
        position: f64 = or(Input::Position, 0.0),
        /// BufferMode: aborting at Standstill, where there is nothing to abort, or buffered behind a command that ends at Standstill.
        buffer_mode: BufferMode = buffer_mode(),
    }
}

inputs! {
    /// Inputs of [`HomeDirect`].
    #[derive(Default)]
    pub struct HomeDirectInputs on execute {
        /// SetPosition: the position at which the axis stands (m or rad).
        position: f64 = or(Input::Position, 0.0),
        /// BufferMode, as of [`Home`].
        buffer_mode: BufferMode = buffer_mode(),
    }
}

inputs! {
    /// Inputs of [`HomeAbsolute`].
    #[derive(Default)]
    pub struct HomeAbsoluteInputs on execute {
        /// BufferMode, as of [`Home`].
        buffer_mode: BufferMode = buffer_mode(),
    }
}

/// Command of `block`, for which nothing is planned.
const fn command(block: BlockName, reference: Reference, buffer_mode: BufferMode) -> Command {
    Command { block, goal: Goal::Reference(reference), dynamics: Dynamics::NONE, buffer_mode }
}

impl FunctionBlock for HomeDirect {
    const NAME: BlockName = BlockName::HomeDirect;
    type Inputs<'i> = HomeDirectInputs;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HomeDirectInputs) -> MotionOutputs {
        let HomeDirectInputs { execute, position, buffer_mode } = *inputs;
        let command = command(Self::NAME, Reference::Here(position), buffer_mode);
        self.execution.step(axis, execute, |axis| axis.submit(command).map(Some)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

impl FunctionBlock for HomeAbsolute {
    const NAME: BlockName = BlockName::HomeAbsolute;
    type Inputs<'i> = HomeAbsoluteInputs;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HomeAbsoluteInputs) -> MotionOutputs {
        let command = command(Self::NAME, Reference::Encoder, inputs.buffer_mode);
        self.execution.step(axis, inputs.execute, |axis| axis.submit(command).map(Some)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

impl FunctionBlock for Home {
    const NAME: BlockName = BlockName::Home;
    type Inputs<'i> = HomeInputs;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HomeInputs) -> MotionOutputs {
        let HomeInputs { execute, position, buffer_mode } = *inputs;
        let command = command(Self::NAME, Reference::Search(position), buffer_mode);
        self.execution.step(axis, execute, |axis| axis.submit(command).map(Some)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
