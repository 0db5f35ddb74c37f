//! Function blocks behind one door: whatever their inputs and outputs are, a program executes them and reads numbers.
mod inputs;

use core::fmt;
use inputs::{Positions, Rates};
use servobench_motion::pvt::Knot;
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
    /// The same block in the same state.
    fn copy(&self) -> Box<dyn Block>;
    /// What its error is, in words.
    fn error(&self) -> Option<String>;
}

/// A block and what it keeps of its inputs, which are lent to it for each call.
struct Instance<B: FunctionBlock, K> {
    block: B,
    /// Nothing where they were said of another block.
    kept: Option<K>,
    read: fn(&Said) -> Option<K>,
    lend: Lend<B, K>,
    is_enabled: bool,
}

/// The inputs of a call, with Execute or Enable as it is then.
type Lend<B, K> = for<'i> fn(&'i K, bool) -> <B as FunctionBlock>::Inputs<'i>;

impl<B: FunctionBlock, K> fmt::Debug for Instance<B, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(B::NAME.name())
    }
}

impl Clone for Box<dyn Block> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

impl<B: FunctionBlock + Clone + 'static, K: Clone + 'static> Block for Instance<B, K> {
    fn copy(&self) -> Box<dyn Block> {
        let Self { read, lend, is_enabled, .. } = *self;
        Box::new(Self { block: self.block.clone(), kept: self.kept.clone(), read, lend, is_enabled })
    }

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
        if let Some(kept) = (self.read)(said) {
            self.kept = Some(kept);
        }
    }

    fn step(&mut self, axis: &mut Axis, execute: bool, values: &mut [f64]) {
        let Some(kept) = &self.kept else { return };
        let outputs = self.block.step(axis, &(self.lend)(kept, execute));
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
pub(super) fn block(said: &Said) -> Box<dyn Block> {
    match said {
        Said::Power { .. } => {
            enabled(said, plcopen::Power, inputs::power, |kept, enable| plcopen::PowerInputs { enable, ..*kept })
        }
        Said::SetOverride { .. } => {
            enabled(said, plcopen::SetOverride::default(), inputs::set_override, |kept, enable| {
                plcopen::SetOverrideInputs { enable, ..*kept }
            })
        }
        Said::Profile4th { .. } => {
            enabled(said, plcopen::Profile4th::default(), inputs::profile_4th, |kept, enable| {
                plcopen::Profile4thInputs { enable, ..*kept }
            })
        }
        Said::ReadStatus => reading(said, plcopen::ReadStatus),
        Said::ReadAxisError => reading(said, plcopen::ReadAxisError),
        Said::ReadActualPosition => reading(said, plcopen::ReadActualPosition),
        Said::ReadActualVelocity => reading(said, plcopen::ReadActualVelocity),
        Said::ReadActualTorque => reading(said, plcopen::ReadActualTorque),
        Said::Home { .. } => executed(said, plcopen::Home::default(), inputs::home, |kept, execute| {
            plcopen::HomeInputs { execute, ..*kept }
        }),
        Said::Stop(_) => executed(said, plcopen::Stop::default(), inputs::stop, |kept, execute| plcopen::StopInputs {
            execute,
            ..*kept
        }),
        Said::Halt { .. } => executed(said, plcopen::Halt::default(), inputs::halt, |kept, execute| {
            plcopen::HaltInputs { execute, ..*kept }
        }),
        Said::Reset => {
            executed(said, plcopen::Reset::default(), inputs::reset, |_, execute| plcopen::ResetInputs { execute })
        }
        Said::MoveAbsolute { .. } => {
            executed(said, plcopen::MoveAbsolute::default(), inputs::move_absolute, |kept, execute| {
                plcopen::MoveAbsoluteInputs { execute, ..*kept }
            })
        }
        Said::MoveRelative { .. } => {
            executed(said, plcopen::MoveRelative::default(), inputs::move_relative, |kept, execute| {
                plcopen::MoveRelativeInputs { execute, ..*kept }
            })
        }
        Said::MoveAdditive { .. } => {
            executed(said, plcopen::MoveAdditive::default(), inputs::move_additive, |kept, execute| {
                plcopen::MoveAdditiveInputs { execute, ..*kept }
            })
        }
        Said::MoveSuperimposed { .. } => {
            executed(said, plcopen::MoveSuperimposed::default(), inputs::move_superimposed, |kept, execute| {
                plcopen::MoveSuperimposedInputs { execute, ..*kept }
            })
        }
        Said::MoveVelocity { .. } => {
            executed(said, plcopen::MoveVelocity::default(), inputs::move_velocity, |kept, execute| {
                plcopen::MoveVelocityInputs { execute, ..*kept }
            })
        }
        Said::MoveContinuousAbsolute { .. } => executed(
            said,
            plcopen::MoveContinuousAbsolute::default(),
            inputs::move_continuous_absolute,
            |kept, execute| plcopen::MoveContinuousAbsoluteInputs { execute, ..*kept },
        ),
        Said::SetPosition { .. } => {
            executed(said, plcopen::SetPosition::default(), inputs::set_position, |kept, execute| {
                plcopen::SetPositionInputs { execute, ..*kept }
            })
        }
        Said::TorqueControl { .. } => {
            executed(said, plcopen::TorqueControl::default(), inputs::torque_control, |kept, execute| {
                plcopen::TorqueControlInputs { execute, ..*kept }
            })
        }
        Said::PositionProfile { pairs, .. } => {
            // Where the profile begins is a point too.
            let points = pairs.len() + 1;
            let block = plcopen::PositionProfile::new(vec![Knot::default(); points], vec![0.0; points]);
            executed(said, block, Positions::of, |kept, execute| plcopen::PositionProfileInputs {
                execute,
                ..kept.inputs()
            })
        }
        Said::VelocityProfile { pairs, .. } => {
            let block = plcopen::VelocityProfile::new(vec![plcopen::Pair::default(); pairs.len()]);
            executed(said, block, Rates::of_velocities, |kept, execute| plcopen::VelocityProfileInputs {
                execute,
                ..kept.velocities()
            })
        }
        Said::AccelerationProfile { pairs, .. } => {
            let block = plcopen::AccelerationProfile::new(vec![plcopen::Pair::default(); pairs.len()]);
            executed(said, block, Rates::of_accelerations, |kept, execute| plcopen::AccelerationProfileInputs {
                execute,
                ..kept.accelerations()
            })
        }
    }
}

/// A block that is executed by the edge of Execute.
fn executed<B, K>(said: &Said, block: B, read: fn(&Said) -> Option<K>, lend: Lend<B, K>) -> Box<dyn Block>
where
    B: FunctionBlock + Clone + 'static,
    K: Clone + 'static,
{
    Box::new(Instance { block, kept: read(said), read, lend, is_enabled: false })
}

/// A block that works as long as Enable is TRUE.
fn enabled<B, K>(said: &Said, block: B, read: fn(&Said) -> Option<K>, lend: Lend<B, K>) -> Box<dyn Block>
where
    B: FunctionBlock + Clone + 'static,
    K: Clone + 'static,
{
    Box::new(Instance { block, kept: read(said), read, lend, is_enabled: true })
}

/// A block that reads something of the axis.
fn reading<B>(said: &Said, block: B) -> Box<dyn Block>
where
    B: for<'i> FunctionBlock<Inputs<'i> = plcopen::ReadInputs> + Clone + 'static,
{
    enabled(said, block, inputs::reading, |_, enable| plcopen::ReadInputs { enable })
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
        | Said::MoveContinuousAbsolute { dynamics, .. } => of(dynamics),
        Said::TorqueControl { velocity, .. } => Some([*velocity, 0.0, 0.0, 0.0]),
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
