//! `MC_Power`: the power of the axis, and the directions in which it may move.
use super::outputs::FunctionBlock;
use crate::axis::{Axis, PowerRequest};
use crate::blocks::{BlockName, Input};
use crate::error::ErrorId;
use crate::interface::{flag, inputs, outputs};
use servobench_base::Stateful;

/// Powers the axis while Enable is TRUE.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Power;

inputs! {
    /// Inputs of [`Power`].
    #[derive(Eq)]
    pub struct PowerInputs on enable {
        /// EnablePositive: motion in the positive direction is permitted.
        enable_positive: bool = flag(Input::EnablePositive, true),
        /// EnableNegative: motion in the negative direction is permitted.
        enable_negative: bool = flag(Input::EnableNegative, true),
    }
}

impl Default for PowerInputs {
    fn default() -> Self {
        Self { enable: false, enable_positive: true, enable_negative: true }
    }
}

outputs! {
    /// Outputs of [`Power`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct PowerOutputs {
        /// Status: the axis is powered.
        status: bool = Status,
        /// Valid: the other outputs are valid.
        valid: bool = Valid,
        /// Error: the axis is in ErrorStop.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
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
