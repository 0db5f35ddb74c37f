//! `MC_SetOverride`: scales the dynamics of commands.
use super::outputs::FunctionBlock;
use crate::axis::{Axis, Override};
use crate::blocks::{BlockName, Input};
use crate::error::{BlockError, ErrorId};
use crate::interface::{inputs, or, outputs};
use servobench_base::Stateful;

/// Scales velocity, acceleration and jerk of all commands but MC_Stop and MC_Halt while Enable is TRUE; the factors stay when it falls. An
/// active command is replanned from the present set-point, so that nothing jumps.
///
/// A lower acceleration or jerk needs a longer braking distance: set near a target, the axis passes it and comes back.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct SetOverride {
    error: Option<BlockError>,
}

inputs! {
    /// Inputs of [`SetOverride`].
    pub struct SetOverrideInputs on enable {
        /// VelFactor: 0, which holds the axis without ending its command, or from 1e-6 to 1.
        vel_factor: f64 = or(Input::VelocityFactor, 1.0),
        /// AccFactor, from 1e-6 to 1, of acceleration and deceleration.
        acc_factor: f64 = or(Input::AccelerationFactor, 1.0),
        /// JerkFactor, from 1e-6 to 1, of jerk and snap.
        jerk_factor: f64 = or(Input::JerkFactor, 1.0),
    }
}

impl Default for SetOverrideInputs {
    fn default() -> Self {
        Self { enable: false, vel_factor: 1.0, acc_factor: 1.0, jerk_factor: 1.0 }
    }
}

outputs! {
    /// Outputs of [`SetOverride`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct SetOverrideOutputs {
        /// Enabled: the factors act.
        enabled: bool = Enabled,
        /// Busy: the block continues, also after an error.
        busy: bool = Busy,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
}

/// Smallest plausible factor other than 0.
const SMALLEST: f64 = 1e-6;

impl SetOverride {
    fn set(axis: &mut Axis, inputs: &SetOverrideInputs) -> Result<(), BlockError> {
        let SetOverrideInputs { vel_factor: velocity, acc_factor: acceleration, jerk_factor: jerk, .. } = *inputs;
        let block = Self::NAME;
        if velocity != 0.0 && !(SMALLEST..=1.0).contains(&velocity) {
            let bound = "0, or from 1e-6 to 1";
            return Err(BlockError::Input { block, input: "VelFactor", value: velocity, bound });
        }
        for (input, value) in [("AccFactor", acceleration), ("JerkFactor", jerk)] {
            if !(SMALLEST..=1.0).contains(&value) {
                return Err(BlockError::Input { block, input, value, bound: "from 1e-6 to 1" });
            }
        }
        axis.set_factors(Override { velocity, acceleration, jerk })
    }
}

impl FunctionBlock for SetOverride {
    const NAME: BlockName = BlockName::SetOverride;
    type Inputs<'i> = SetOverrideInputs;
    type Outputs = SetOverrideOutputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &SetOverrideInputs) -> SetOverrideOutputs {
        if !inputs.enable {
            self.error = None;
            return SetOverrideOutputs::default();
        }
        self.error = Self::set(axis, inputs).err();
        let error_id = self.error.as_ref().map_or(ErrorId::None, BlockError::id);
        let error = error_id != ErrorId::None;
        SetOverrideOutputs { enabled: !error, busy: true, error, error_id }
    }

    fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}
