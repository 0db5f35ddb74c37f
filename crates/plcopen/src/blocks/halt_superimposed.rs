//! `MC_HaltSuperimposed`: brings a superimposed motion to rest.
use super::execution::Execution;
use super::outputs::FunctionBlock;
use super::stop::StopOutputs;
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::BlockError;
use crate::interface::{inputs, limit_if_any, required_for};
use servobench_base::Stateful;

/// Brakes the motion of `MC_MoveSuperimposed` and leaves the one below alone; the distance covered stays.
///
/// Done at once without a superimposed motion. A new `MC_MoveSuperimposed` takes over from it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct HaltSuperimposed {
    execution: Execution,
}

inputs! {
    /// Inputs of [`HaltSuperimposed`].
    pub struct HaltSuperimposedInputs on execute {
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 =
            required_for(Input::Deceleration, "together with the motion below it has to keep the limit of the axis"),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
    }
}

impl FunctionBlock for HaltSuperimposed {
    const NAME: BlockName = BlockName::HaltSuperimposed;
    type Inputs<'i> = HaltSuperimposedInputs;
    type Outputs = StopOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &HaltSuperimposedInputs) -> StopOutputs {
        let HaltSuperimposedInputs { execute, deceleration, jerk, snap } = *inputs;
        let dynamics = Dynamics::braking(deceleration, jerk, snap);
        let command = Command { block: Self::NAME, goal: Goal::Rest, dynamics, buffer_mode: BufferMode::Aborting };
        let mut is_idle = false;
        let report = self.execution.step(axis, execute, |axis| {
            let halting = axis.halt_superimposed(&command)?;
            is_idle = halting.is_none();
            Ok(halting)
        });
        if is_idle { self.execution.complete() } else { report }.into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}
