//! `MC_Power`: the power of the axis, and the directions in which it may move.
use super::outputs::{FunctionBlock, Outputs, flag, number};
use crate::axis::{Axis, PowerRequest};
use crate::error::ErrorId;
use crate::name::BlockName;

/// Powers the axis while Enable is TRUE.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Power;

/// Inputs of [`Power`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PowerInputs {
    /// Enable.
    pub enable: bool,
    /// EnablePositive: motion in the positive direction is permitted.
    pub enable_positive: bool,
    /// EnableNegative: motion in the negative direction is permitted.
    pub enable_negative: bool,
}

impl Default for PowerInputs {
    fn default() -> Self {
        Self { enable: false, enable_positive: true, enable_negative: true }
    }
}

/// Outputs of [`Power`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PowerOutputs {
    /// Status: the axis is powered.
    pub status: bool,
    /// Valid: the outputs mean something.
    pub valid: bool,
    /// Error: the axis is in ErrorStop.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

impl FunctionBlock for Power {
    const NAME: BlockName = BlockName::Power;
    type Inputs<'i> = PowerInputs;
    type Outputs = PowerOutputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &PowerInputs) -> PowerOutputs {
        let PowerInputs { enable, enable_positive: positive, enable_negative: negative } = *inputs;
        axis.ask_power(PowerRequest { enable, positive, negative });
        let error_id = axis.error().filter(|_| enable).map_or(ErrorId::None, crate::AxisError::id);
        let error = error_id != ErrorId::None;
        PowerOutputs { status: axis.power_status(), valid: enable && !error, error, error_id }
    }
}

impl Outputs for PowerOutputs {
    const NAMES: &'static [&'static str] = &["Status", "Valid", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { status, valid, error, error_id } = *self;
        [status, valid, error].map(flag).into_iter().chain([number(error_id)]).for_each(record);
    }
}
