//! Function blocks behind one door: whatever their inputs and outputs are, a program executes them and reads numbers.
mod inputs;

use crate::error::BuildError;
use core::fmt;
use servobench_plcopen::{self as plcopen, Axis, FunctionBlock, Outputs};
use servobench_scenario as scenario;
use servobench_scenario::Block as Said;

/// A block that a program calls.
pub(super) trait Block: fmt::Debug {
    /// Name in the standard.
    fn name(&self) -> &'static str;
    /// Names of the outputs, in the standard's order.
    fn outputs(&self) -> &'static [&'static str];
    /// Whether it has Enable instead of Execute.
    fn is_enabled(&self) -> bool;
    /// Whether it makes the axis move.
    fn moves(&self) -> bool;
    /// Takes other inputs; nothing if they are those of another block.
    fn load(&mut self, said: &Said);
    /// One call; fills `values` with the outputs, TRUE is 1.
    fn step(&mut self, axis: &mut Axis, execute: bool, values: &mut [f64]);
    /// What its error is, in words.
    fn error(&self) -> Option<String>;
}

/// A block with its inputs as a scenario says them.
struct Instance<B: FunctionBlock> {
    block: B,
    inputs: B::Inputs,
    read: fn(&Said) -> Option<B::Inputs>,
    trigger: fn(&mut B::Inputs) -> &mut bool,
    is_enabled: bool,
}

impl<B: FunctionBlock> fmt::Debug for Instance<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(B::NAME.name())
    }
}

impl<B: FunctionBlock> Block for Instance<B> {
    fn name(&self) -> &'static str {
        B::NAME.name()
    }

    fn outputs(&self) -> &'static [&'static str] {
        B::Outputs::NAMES
    }

    fn is_enabled(&self) -> bool {
        self.is_enabled
    }

    fn moves(&self) -> bool {
        plcopen::BlockName::COMMANDS.contains(&B::NAME) && B::NAME != plcopen::BlockName::TorqueControl
    }

    fn load(&mut self, said: &Said) {
        if let Some(mut inputs) = (self.read)(said) {
            *(self.trigger)(&mut inputs) = *(self.trigger)(&mut self.inputs);
            self.inputs = inputs;
        }
    }

    fn step(&mut self, axis: &mut Axis, execute: bool, values: &mut [f64]) {
        *(self.trigger)(&mut self.inputs) = execute;
        let outputs = self.block.step(axis, &self.inputs);
        let mut places = values.iter_mut();
        outputs.each(|value| {
            if let Some(place) = places.next() {
                *place = value;
            }
        });
    }

    fn error(&self) -> Option<String> {
        self.block.error().map(ToString::to_string)
    }
}

/// The block of a call.
///
/// # Errors
/// [`BuildError::NoSuchBlock`] for one that the bench does not have.
pub(super) fn block(said: &Said) -> Result<Box<dyn Block>, BuildError> {
    let made = match said {
        Said::Power => enabled(plcopen::Power, said, inputs::power, |inputs| &mut inputs.enable),
        Said::SetOverride { .. } => {
            enabled(plcopen::SetOverride::default(), said, inputs::set_override, |inputs| &mut inputs.enable)
        }
        Said::ReadStatus => reading(plcopen::ReadStatus, said),
        Said::ReadAxisError => reading(plcopen::ReadAxisError, said),
        Said::ReadActualPosition => reading(plcopen::ReadActualPosition, said),
        Said::ReadActualVelocity => reading(plcopen::ReadActualVelocity, said),
        Said::ReadActualTorque => reading(plcopen::ReadActualTorque, said),
        Said::Home { .. } => executed(plcopen::Home::default(), said, inputs::home, |inputs| &mut inputs.execute),
        Said::Stop(_) => executed(plcopen::Stop::default(), said, inputs::stop, |inputs| &mut inputs.execute),
        Said::Halt { .. } => executed(plcopen::Halt::default(), said, inputs::halt, |inputs| &mut inputs.execute),
        Said::Reset => executed(plcopen::Reset::default(), said, inputs::reset, |inputs| &mut inputs.execute),
        Said::MoveAbsolute { .. } => {
            executed(plcopen::MoveAbsolute::default(), said, inputs::move_absolute, |inputs| &mut inputs.execute)
        }
        Said::MoveRelative { .. } => {
            executed(plcopen::MoveRelative::default(), said, inputs::move_relative, |inputs| &mut inputs.execute)
        }
        Said::MoveAdditive { .. } => {
            executed(plcopen::MoveAdditive::default(), said, inputs::move_additive, |inputs| &mut inputs.execute)
        }
        Said::MoveSuperimposed { .. } => {
            executed(plcopen::MoveSuperimposed::default(), said, inputs::move_superimposed, |inputs| {
                &mut inputs.execute
            })
        }
        Said::MoveVelocity { .. } => {
            executed(plcopen::MoveVelocity::default(), said, inputs::move_velocity, |inputs| &mut inputs.execute)
        }
        Said::MoveContinuousAbsolute { .. } => {
            let block = plcopen::MoveContinuousAbsolute::default();
            executed(block, said, inputs::move_continuous_absolute, |inputs| &mut inputs.execute)
        }
        Said::SetPosition { .. } => {
            executed(plcopen::SetPosition::default(), said, inputs::set_position, |inputs| &mut inputs.execute)
        }
        Said::TorqueControl { .. } => {
            executed(plcopen::TorqueControl::default(), said, inputs::torque_control, |inputs| &mut inputs.execute)
        }
        Said::PositionProfile { .. }
        | Said::VelocityProfile { .. }
        | Said::AccelerationProfile { .. }
        | Said::Profile4th { .. } => None,
    };
    made.ok_or(BuildError::NoSuchBlock)
}

/// A block that is executed by the edge of Execute.
fn executed<B>(
    block: B,
    said: &Said,
    read: fn(&Said) -> Option<B::Inputs>,
    trigger: fn(&mut B::Inputs) -> &mut bool,
) -> Option<Box<dyn Block>>
where
    B: FunctionBlock + 'static,
{
    read(said).map(|inputs| Box::new(Instance { block, inputs, read, trigger, is_enabled: false }) as Box<dyn Block>)
}

/// A block that works as long as Enable is TRUE.
fn enabled<B>(
    block: B,
    said: &Said,
    read: fn(&Said) -> Option<B::Inputs>,
    trigger: fn(&mut B::Inputs) -> &mut bool,
) -> Option<Box<dyn Block>>
where
    B: FunctionBlock + 'static,
{
    read(said).map(|inputs| Box::new(Instance { block, inputs, read, trigger, is_enabled: true }) as Box<dyn Block>)
}

/// A block that reads something of the axis.
fn reading<B>(block: B, said: &Said) -> Option<Box<dyn Block>>
where
    B: FunctionBlock<Inputs = plcopen::ReadInputs> + 'static,
{
    enabled(block, said, inputs::reading, |inputs| &mut inputs.enable)
}

/// Velocity, acceleration, jerk and snap that a block asks of its axis; zero for what it does not ask for.
pub(super) fn dynamics(said: &Said) -> Option<[f64; 4]> {
    let of = |dynamics: &scenario::Dynamics| {
        let scenario::Dynamics { velocity, acceleration, deceleration, jerk, snap } = *dynamics;
        Some([velocity, acceleration.max(deceleration), jerk, snap])
    };
    match said {
        Said::MoveAbsolute { dynamics, .. }
        | Said::MoveRelative { dynamics, .. }
        | Said::MoveAdditive { dynamics, .. }
        | Said::MoveSuperimposed { dynamics, .. }
        | Said::MoveContinuousAbsolute { dynamics, .. }
        | Said::TorqueControl { dynamics, .. } => of(dynamics),
        Said::MoveVelocity { velocity, dynamics, .. } => {
            of(&scenario::Dynamics { velocity: velocity.abs().max(dynamics.velocity), ..*dynamics })
        }
        Said::Stop(braking) | Said::Halt { braking, .. } => {
            Some([0.0, braking.deceleration, braking.jerk, braking.snap])
        }
        Said::Profile4th { limits, .. } => Some(*limits),
        _ => None,
    }
}
