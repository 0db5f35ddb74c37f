//! `MC_ReadDigitalInput`, `MC_ReadDigitalOutput`, `MC_WriteDigitalOutput`: digital inputs (60FDh) and outputs (60FEh) of the drive.
//!
//! ExecutionMode is left out: a write takes effect at once.
use super::execution::Execution;
use super::outputs::{DoneOutputs, FunctionBlock};
use super::parameters::ReadBoolOutputs;
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::error::BlockError;
use crate::interface::{inputs, required};
use servobench_base::Stateful;

/// Reads a digital input, as it is wired.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ReadDigitalInput {
    error: Option<BlockError>,
}

/// Reads a digital output: the level to which it was last set.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ReadDigitalOutput {
    error: Option<BlockError>,
}

/// Sets a digital output.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct WriteDigitalOutput {
    execution: Execution,
}

inputs! {
    /// Inputs of [`ReadDigitalInput`].
    pub struct ReadDigitalInputInputs on enable {
        /// InputNumber: a bit of 60FDh.
        input_number: u32 = required(Input::InputNumber),
    }
}

inputs! {
    /// Inputs of [`ReadDigitalOutput`].
    pub struct ReadDigitalOutputInputs on enable {
        /// OutputNumber: a bit of 60FEh.
        output_number: u32 = required(Input::OutputNumber),
    }
}

inputs! {
    /// Inputs of [`WriteDigitalOutput`].
    pub struct WriteDigitalOutputInputs on execute {
        /// OutputNumber: a bit of 60FEh.
        output_number: u32 = required(Input::OutputNumber),
        /// Value.
        value: bool = required(Input::BoolValue),
    }
}

/// Mask of a bit.
fn mask(block: BlockName, input: &'static str, number: u32) -> Result<u32, BlockError> {
    let bound = "a bit from 0 to 31";
    1_u32.checked_shl(number).ok_or(BlockError::Input { block, input, value: number.into(), bound })
}

/// Reads a bit while the block is enabled; keeps the error of an invalid bit number.
fn read(enable: bool, bits: u32, mask: Result<u32, BlockError>, kept: &mut Option<BlockError>) -> ReadBoolOutputs {
    *kept = mask.err().filter(|_| enable);
    match (mask, &*kept) {
        (_, Some(error)) => ReadBoolOutputs::failed(error),
        (mask, None) => ReadBoolOutputs::of(enable, || mask.is_ok_and(|mask| bits & mask != 0)),
    }
}

impl FunctionBlock for ReadDigitalInput {
    const NAME: BlockName = BlockName::ReadDigitalInput;
    type Inputs<'i> = ReadDigitalInputInputs;
    type Outputs = ReadBoolOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ReadDigitalInputInputs) -> ReadBoolOutputs {
        let bits = axis.actual().digital_inputs;
        read(inputs.enable, bits, mask(Self::NAME, "InputNumber", inputs.input_number), &mut self.error)
    }

    fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}

impl FunctionBlock for ReadDigitalOutput {
    const NAME: BlockName = BlockName::ReadDigitalOutput;
    type Inputs<'i> = ReadDigitalOutputInputs;
    type Outputs = ReadBoolOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ReadDigitalOutputInputs) -> ReadBoolOutputs {
        let bits = axis.digital_outputs();
        read(inputs.enable, bits, mask(Self::NAME, "OutputNumber", inputs.output_number), &mut self.error)
    }

    fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}

impl FunctionBlock for WriteDigitalOutput {
    const NAME: BlockName = BlockName::WriteDigitalOutput;
    type Inputs<'i> = WriteDigitalOutputInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &WriteDigitalOutputInputs) -> DoneOutputs {
        let WriteDigitalOutputInputs { execute, output_number, value } = *inputs;
        let write = |axis: &mut Axis| {
            axis.set_digital_output(mask(Self::NAME, "OutputNumber", output_number)?, value);
            Ok(())
        };
        self.execution.at_once(axis, execute, write).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
