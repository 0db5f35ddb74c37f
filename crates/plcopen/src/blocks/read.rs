//! `MC_ReadStatus`, `MC_ReadAxisError`, `MC_ReadActualPosition`, `MC_ReadActualVelocity`, `MC_ReadActualTorque`.
//!
//! They cannot fail: Error and ErrorID keep their values without an error.
use super::outputs::{FunctionBlock, Outputs};
use crate::axis::Axis;
use crate::blocks::{BlockName, Output};
use crate::error::{AxisError, ErrorId};
use crate::interface::{Recorded as _, inputs};
use crate::state::AxisState;
use core::marker::PhantomData;
use servobench_base::Stateful;

/// Reads the state of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadStatus;

/// Reads the error for which the axis is in ErrorStop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadAxisError;

/// Reads the actual position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadActualPosition;

/// Reads the actual velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadActualVelocity;

/// Reads the actual effort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadActualTorque;

inputs! {
    /// Inputs of a block that reads.
    #[derive(Eq, Default)]
    pub struct ReadInputs on enable {}
}

/// Outputs of [`ReadStatus`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadStatusOutputs {
    /// Valid.
    pub valid: bool,
    /// The state, one of the outputs ErrorStop, Disabled, Stopping, Homing, Standstill, DiscreteMotion, ContinuousMotion,
    /// SynchronizedMotion; `None` without Enable.
    pub state: Option<AxisState>,
}

/// Outputs of [`ReadAxisError`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadAxisErrorOutputs {
    /// Valid.
    pub valid: bool,
    /// AxisErrorID.
    pub axis_error_id: ErrorId,
    /// Code of the drive or its link, if the error is one of their faults; 0 otherwise. Beyond the standard.
    pub drive_code: u16,
}

/// Outputs of `Block`, which reads a value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadValueOutputs<Block> {
    /// Valid.
    pub valid: bool,
    /// Position, Velocity or Torque, in the axis unit; 0 while it is not valid.
    pub value: f64,
    block: PhantomData<Block>,
}

/// A block that reads a value.
pub trait ReadsValue: Copy {
    /// Output that carries the value.
    const OUTPUT: Output;
}

impl ReadsValue for ReadActualPosition {
    const OUTPUT: Output = Output::Position;
}

impl ReadsValue for ReadActualVelocity {
    const OUTPUT: Output = Output::Velocity;
}

impl ReadsValue for ReadActualTorque {
    const OUTPUT: Output = Output::Torque;
}

impl ReadStatusOutputs {
    /// The outputs of states, in the order of the standard; Synchronized Motion does not occur.
    pub const STATES: [AxisState; 7] = [
        AxisState::ErrorStop,
        AxisState::Disabled,
        AxisState::Stopping,
        AxisState::Homing,
        AxisState::Standstill,
        AxisState::DiscreteMotion,
        AxisState::ContinuousMotion,
    ];
}

impl FunctionBlock for ReadStatus {
    const NAME: BlockName = BlockName::ReadStatus;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadStatusOutputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadStatusOutputs {
        ReadStatusOutputs { valid: inputs.enable, state: inputs.enable.then_some(axis.state()) }
    }
}

impl FunctionBlock for ReadAxisError {
    const NAME: BlockName = BlockName::ReadAxisError;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadAxisErrorOutputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadAxisErrorOutputs {
        let error = axis.error().filter(|_| inputs.enable);
        ReadAxisErrorOutputs {
            valid: inputs.enable,
            axis_error_id: error.map_or(ErrorId::None, AxisError::id),
            drive_code: match error {
                Some(AxisError::DriveFault { fault }) => fault.code(),
                _ => 0,
            },
        }
    }
}

impl FunctionBlock for ReadActualPosition {
    const NAME: BlockName = BlockName::ReadActualPosition;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadValueOutputs<Self>;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadValueOutputs<Self> {
        ReadValueOutputs::of(*inputs, || axis.actual().position)
    }
}

impl FunctionBlock for ReadActualVelocity {
    const NAME: BlockName = BlockName::ReadActualVelocity;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadValueOutputs<Self>;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadValueOutputs<Self> {
        ReadValueOutputs::of(*inputs, || axis.actual().velocity)
    }
}

impl FunctionBlock for ReadActualTorque {
    const NAME: BlockName = BlockName::ReadActualTorque;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadValueOutputs<Self>;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadValueOutputs<Self> {
        ReadValueOutputs::of(*inputs, || axis.actual().effort)
    }
}

impl<Block> ReadValueOutputs<Block> {
    #[inline]
    fn of(inputs: ReadInputs, value: impl FnOnce() -> f64) -> Self {
        let value = if inputs.enable { value() } else { 0.0 };
        Self { valid: inputs.enable, value, block: PhantomData }
    }
}

impl Outputs for ReadStatusOutputs {
    const LIST: &'static [Output] = &[
        Output::Valid,
        Output::Busy,
        Output::Error,
        Output::ErrorId,
        Output::ErrorStop,
        Output::Disabled,
        Output::Stopping,
        Output::Homing,
        Output::Standstill,
        Output::DiscreteMotion,
        Output::ContinuousMotion,
        Output::SynchronizedMotion,
    ];

    fn each(&self, record: impl FnMut(f64)) {
        let states = Self::STATES.map(|state| (self.state == Some(state)).recorded());
        let valid = self.valid.recorded();
        [valid, valid, 0.0, 0.0].into_iter().chain(states).chain([0.0]).for_each(record);
    }
}

impl Outputs for ReadAxisErrorOutputs {
    const LIST: &'static [Output] =
        &[Output::Valid, Output::Busy, Output::Error, Output::ErrorId, Output::AxisErrorId, Output::DriveCode];

    fn each(&self, record: impl FnMut(f64)) {
        let valid = self.valid.recorded();
        let axis_error = [self.axis_error_id.recorded(), self.drive_code.recorded()];
        [valid, valid, 0.0, 0.0].into_iter().chain(axis_error).for_each(record);
    }
}

impl<Block: ReadsValue> Outputs for ReadValueOutputs<Block> {
    const LIST: &'static [Output] = &[Output::Valid, Output::Busy, Output::Error, Output::ErrorId, Block::OUTPUT];

    fn each(&self, record: impl FnMut(f64)) {
        let valid = self.valid.recorded();
        [valid, valid, 0.0, 0.0, self.value].into_iter().for_each(record);
    }
}
