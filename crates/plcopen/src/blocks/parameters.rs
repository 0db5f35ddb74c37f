//! `MC_ReadParameter`, `MC_ReadBoolParameter`, `MC_WriteParameter`, `MC_WriteBoolParameter`.
//!
//! ExecutionMode is left out: a write takes effect at once.
use super::execution::Execution;
use super::outputs::{DoneOutputs, FunctionBlock};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::error::{BlockError, ErrorId};
use crate::interface::{inputs, outputs, required};
use crate::parameter::{AxisBoolParameter, AxisParameter};
use servobench_base::Stateful;

/// Reads a numeric parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadParameter;

/// Reads a BOOL parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadBoolParameter;

/// Writes a numeric parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct WriteParameter {
    execution: Execution,
}

/// Writes a BOOL parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct WriteBoolParameter {
    execution: Execution,
}

inputs! {
    /// Inputs of [`ReadParameter`].
    pub struct ReadParameterInputs on enable {
        /// ParameterNumber.
        parameter: AxisParameter = required(Input::Parameter),
    }
}

inputs! {
    /// Inputs of [`ReadBoolParameter`].
    pub struct ReadBoolParameterInputs on enable {
        /// ParameterNumber.
        parameter: AxisBoolParameter = required(Input::BoolParameter),
    }
}

inputs! {
    /// Inputs of [`WriteParameter`].
    pub struct WriteParameterInputs on execute {
        /// ParameterNumber.
        parameter: AxisParameter = required(Input::Parameter),
        /// Value (SI, in the axis unit m or rad).
        value: f64 = required(Input::Value),
    }
}

inputs! {
    /// Inputs of [`WriteBoolParameter`].
    pub struct WriteBoolParameterInputs on execute {
        /// ParameterNumber.
        parameter: AxisBoolParameter = required(Input::BoolParameter),
        /// Value.
        value: bool = required(Input::BoolValue),
    }
}

outputs! {
    /// Outputs of [`ReadParameter`].
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct ReadParameterOutputs {
        /// Valid.
        valid: bool = Valid,
        /// Busy: same as Valid.
        busy: bool = Busy,
        /// Error: the block cannot fail.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// Value (SI, in the axis unit m or rad); infinite if there is no limit, 0 while it is not valid.
        value: f64 = Value,
    }
}

outputs! {
    /// Outputs of a block that reads a BOOL.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct ReadBoolOutputs {
        /// Valid.
        valid: bool = Valid,
        /// Busy: the block continues to read, also after an error.
        busy: bool = Busy,
        /// Error: the input or output does not exist.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// Value; FALSE while it is not valid.
        value: bool = BoolValue,
    }
}

impl ReadBoolOutputs {
    /// Outputs of a block that cannot read.
    pub(super) fn failed(error: &BlockError) -> Self {
        Self { busy: true, error: true, error_id: error.id(), ..Self::default() }
    }

    /// Outputs of a block that is enabled or not.
    pub(super) fn of(enable: bool, value: impl FnOnce() -> bool) -> Self {
        Self { valid: enable, busy: enable, value: enable && value(), ..Self::default() }
    }
}

impl FunctionBlock for ReadParameter {
    const NAME: BlockName = BlockName::ReadParameter;
    type Inputs<'i> = ReadParameterInputs;
    type Outputs = ReadParameterOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ReadParameterInputs) -> ReadParameterOutputs {
        let ReadParameterInputs { enable, parameter } = *inputs;
        let value = if enable { axis.parameter(parameter) } else { 0.0 };
        ReadParameterOutputs { valid: enable, busy: enable, value, ..ReadParameterOutputs::default() }
    }
}

impl FunctionBlock for ReadBoolParameter {
    const NAME: BlockName = BlockName::ReadBoolParameter;
    type Inputs<'i> = ReadBoolParameterInputs;
    type Outputs = ReadBoolOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ReadBoolParameterInputs) -> ReadBoolOutputs {
        ReadBoolOutputs::of(inputs.enable, || axis.bool_parameter(inputs.parameter))
    }
}

impl FunctionBlock for WriteParameter {
    const NAME: BlockName = BlockName::WriteParameter;
    type Inputs<'i> = WriteParameterInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &WriteParameterInputs) -> DoneOutputs {
        let WriteParameterInputs { execute, parameter, value } = *inputs;
        self.execution.at_once(axis, execute, |axis| axis.write_parameter(Self::NAME, parameter, value)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

impl FunctionBlock for WriteBoolParameter {
    const NAME: BlockName = BlockName::WriteBoolParameter;
    type Inputs<'i> = WriteBoolParameterInputs;
    type Outputs = DoneOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &WriteBoolParameterInputs) -> DoneOutputs {
        let WriteBoolParameterInputs { execute, parameter, value } = *inputs;
        let write = |axis: &mut Axis| {
            axis.write_bool_parameter(parameter, value);
            Ok(())
        };
        self.execution.at_once(axis, execute, write).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
