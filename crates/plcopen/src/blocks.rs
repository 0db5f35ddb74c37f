//! The function blocks.
//!
//! # Execute
//!
//! A rising edge of Execute takes the inputs over and starts the command; after it they are looked at no more, unless
//! ContinuousUpdate was TRUE at the edge: then each change acts on the running command (PLCopen part 1, section 2.4.1).
//!
//! - Busy, Done, CommandAborted and Error exclude each other; Active goes with Busy while the command has the axis.
//! - Done, CommandAborted and Error stay until Execute is FALSE. When it was FALSE before they came, they last one cycle.
//! - A falling edge does not end the command. A new rising edge starts a new one, and nothing more is said of the old one. Where
//!   the new one is refused, Error is TRUE for that, and the old one goes on unreported: errors of blocks do not stop the axis.
//! - InVelocity, InEndVelocity and InTorque go with Busy and Active, as long as the command has the axis.
//!
//! # Enable
//!
//! The outputs of a block with Enable follow it from cycle to cycle; Valid or Error says whether they mean anything.
mod execution;
mod home;
mod motion;
mod move_absolute;
mod move_additive;
mod move_continuous_absolute;
mod move_relative;
mod move_superimposed;
mod move_velocity;
mod outputs;
mod position_profile;
mod power;
mod profile;
mod profile_4th;
mod read;
mod reset;
mod set_override;
mod set_position;
mod stop;
mod time_profile;
mod torque_control;

pub use execution::Report;
pub use home::{Home, HomeInputs};
pub use motion::{MotionBlock, MotionInputs};
pub use move_absolute::{MoveAbsolute, MoveAbsoluteInputs};
pub use move_additive::{MoveAdditive, MoveAdditiveInputs};
pub use move_continuous_absolute::{
    MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveContinuousAbsoluteOutputs,
};
pub use move_relative::{MoveRelative, MoveRelativeInputs};
pub use move_superimposed::{MoveSuperimposed, MoveSuperimposedInputs, MoveSuperimposedOutputs};
pub use move_velocity::{MoveVelocity, MoveVelocityInputs, MoveVelocityOutputs};
pub use outputs::{DoneOutputs, FunctionBlock, MotionOutputs, Outputs};
pub use position_profile::{Follow, PositionProfile, PositionProfileInputs, TimePosition, VelocityCommands};
pub use power::{Power, PowerInputs, PowerOutputs};
pub use profile::{Memory, Pair};
pub use profile_4th::{Profile4th, Profile4thInputs, Profile4thOutputs};
pub use read::{
    ReadActualPosition, ReadActualTorque, ReadActualVelocity, ReadAxisError, ReadAxisErrorOutputs, ReadInputs,
    ReadStatus, ReadStatusOutputs, ReadValueOutputs, ReadsValue,
};
pub use reset::{Reset, ResetInputs};
pub use set_override::{SetOverride, SetOverrideInputs, SetOverrideOutputs};
pub use set_position::{SetPosition, SetPositionInputs};
pub use stop::{Halt, HaltInputs, Stop, StopInputs, StopOutputs};
pub use time_profile::{
    AccelerationProfile, AccelerationProfileInputs, ProfileOutputs, VelocityProfile, VelocityProfileInputs,
};
pub use torque_control::{TorqueControl, TorqueControlInputs, TorqueControlOutputs};
