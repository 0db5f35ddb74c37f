//! The function blocks that a call can name, each with its inputs and outputs: the one description of their interfaces.
//!
//! PLCopen, *Function blocks for motion control* (part 1), version 2.0, section 3; `snap` beside every `Jerk`, and
//! `Profile4th`, are ours. Outputs are those that are TRUE or FALSE.
use crate::diagnostic::Report;
use crate::field::{Field, key, written};

use crate::nearest::suggestion;
use crate::scenario::Output;
use crate::tree::Node;
use serde_json::{Value as Json, json};

/// A function block, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockName {
    Power,
    Home,
    Stop,
    Halt,
    Reset,
    MoveAbsolute,
    MoveRelative,
    MoveAdditive,
    MoveSuperimposed,
    MoveVelocity,
    MoveContinuousAbsolute,
    PositionProfile,
    VelocityProfile,
    AccelerationProfile,
    SetPosition,
    SetOverride,
    TorqueControl,
    ReadStatus,
    ReadAxisError,
    ReadActualPosition,
    ReadActualVelocity,
    ReadActualTorque,
    Profile4th,
}

/// What starts and ends a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trigger {
    /// The rising edge of `Execute`.
    Execute,
    /// `Enable`, as long as it is TRUE.
    Enable,
}

/// Inputs and outputs of a block.
#[derive(Debug)]
pub(crate) struct Interface {
    pub(crate) block: BlockName,
    pub(crate) name: &'static str,
    pub(crate) meaning: &'static str,
    pub(crate) trigger: Trigger,
    /// Keys of `[[call]]`.
    pub(crate) inputs: &'static [&'static str],
    pub(crate) outputs: &'static [Output],
}

const MOTION: &[Output] = &[Output::Done, Output::Busy, Output::Active, Output::CommandAborted, Output::Error];
const WITHOUT_ACTIVE: &[Output] = &[Output::Done, Output::Busy, Output::CommandAborted, Output::Error];
const READING: &[Output] = &[Output::Valid, Output::Busy, Output::Error];

/// Every block: its name, its meaning, what triggers it, its inputs and its outputs.
pub(crate) const BLOCKS: &[Interface] = {
    use BlockName as B;
    use Output::{
        Active, Busy, CommandAborted, ContinuousMotion, Disabled, DiscreteMotion, Done, Enabled, Error, ErrorStop,
        Homing, InEndVelocity, InTorque, InVelocity, ProfileCompleted, Ready, Standstill, Status, Stopping, Valid,
    };
    use Trigger::{Enable, Execute};
    const fn block(
        block: BlockName,
        name: &'static str,
        meaning: &'static str,
        trigger: Trigger,
        inputs: &'static [&'static str],
        outputs: &'static [Output],
    ) -> Interface {
        Interface { block, name, meaning, trigger, inputs, outputs }
    }
    &[
        block(
            B::Power,
            "MC_Power",
            "powers the axis as long as it is enabled",
            Enable,
            &["enable_positive", "enable_negative"],
            &[Status, Valid, Error],
        ),
        block(
            B::Home,
            "MC_Home",
            "homes by the method of the drive (6098h)",
            Execute,
            &["position", "buffer_mode"],
            MOTION,
        ),
        block(
            B::Stop,
            "MC_Stop",
            "brakes to rest and lets no other motion begin while `Execute` is TRUE",
            Execute,
            &["deceleration", "jerk", "snap"],
            WITHOUT_ACTIVE,
        ),
        block(
            B::Halt,
            "MC_Halt",
            "brakes to rest; another motion may take over",
            Execute,
            &["deceleration", "jerk", "snap", "buffer_mode"],
            MOTION,
        ),
        block(B::Reset, "MC_Reset", "leaves ErrorStop", Execute, &[], &[Done, Busy, Error]),
        block(
            B::MoveAbsolute,
            "MC_MoveAbsolute",
            "moves to a position",
            Execute,
            &[
                "position",
                "velocity",
                "acceleration",
                "deceleration",
                "jerk",
                "snap",
                "direction",
                "buffer_mode",
                "continuous_update",
            ],
            MOTION,
        ),
        block(
            B::MoveRelative,
            "MC_MoveRelative",
            "moves by a distance from where it begins",
            Execute,
            &[
                "distance",
                "velocity",
                "acceleration",
                "deceleration",
                "jerk",
                "snap",
                "buffer_mode",
                "continuous_update",
            ],
            MOTION,
        ),
        block(
            B::MoveAdditive,
            "MC_MoveAdditive",
            "moves by a distance from the target of the move before",
            Execute,
            &[
                "distance",
                "velocity",
                "acceleration",
                "deceleration",
                "jerk",
                "snap",
                "buffer_mode",
                "continuous_update",
            ],
            MOTION,
        ),
        block(
            B::MoveSuperimposed,
            "MC_MoveSuperimposed",
            "moves by a distance on top of the motion under way",
            Execute,
            &["distance", "velocity_difference", "acceleration", "deceleration", "jerk", "snap", "continuous_update"],
            WITHOUT_ACTIVE,
        ),
        block(
            B::MoveVelocity,
            "MC_MoveVelocity",
            "goes over to a velocity and keeps it",
            Execute,
            &[
                "velocity",
                "acceleration",
                "deceleration",
                "jerk",
                "snap",
                "direction",
                "buffer_mode",
                "continuous_update",
            ],
            &[InVelocity, Busy, Active, CommandAborted, Error],
        ),
        block(
            B::MoveContinuousAbsolute,
            "MC_MoveContinuousAbsolute",
            "passes a position at a velocity and keeps that",
            Execute,
            &[
                "position",
                "end_velocity",
                "velocity",
                "acceleration",
                "deceleration",
                "jerk",
                "snap",
                "direction",
                "buffer_mode",
                "continuous_update",
            ],
            &[InEndVelocity, Busy, Active, CommandAborted, Error],
        ),
        block(
            B::PositionProfile,
            "MC_PositionProfile",
            "moves through a table of positions",
            Execute,
            &["table", "time_scale", "value_scale", "position_offset", "end_velocity", "buffer_mode"],
            MOTION,
        ),
        block(
            B::VelocityProfile,
            "MC_VelocityProfile",
            "moves by a table of velocities",
            Execute,
            &["table", "time_scale", "value_scale", "velocity_offset", "buffer_mode"],
            &[ProfileCompleted, Busy, Active, CommandAborted, Error],
        ),
        block(
            B::AccelerationProfile,
            "MC_AccelerationProfile",
            "moves by a table of accelerations",
            Execute,
            &["table", "time_scale", "value_scale", "acceleration_offset", "buffer_mode"],
            &[ProfileCompleted, Busy, Active, CommandAborted, Error],
        ),
        block(
            B::SetPosition,
            "MC_SetPosition",
            "gives the axis a position without moving it",
            Execute,
            &["position", "relative"],
            &[Done, Busy, Error],
        ),
        block(
            B::SetOverride,
            "MC_SetOverride",
            "scales velocities, accelerations and jerks as long as it is enabled",
            Enable,
            &["velocity_factor", "acceleration_factor", "jerk_factor"],
            &[Enabled, Busy, Error],
        ),
        block(
            B::TorqueControl,
            "MC_TorqueControl",
            "goes over to a torque or force and keeps it",
            Execute,
            &["torque", "torque_ramp", "velocity", "direction", "buffer_mode", "continuous_update"],
            &[InTorque, Busy, Active, CommandAborted, Error],
        ),
        block(
            B::ReadStatus,
            "MC_ReadStatus",
            "tells the state of the axis",
            Enable,
            &[],
            &[Valid, Busy, Error, ErrorStop, Disabled, Stopping, Homing, Standstill, DiscreteMotion, ContinuousMotion],
        ),
        block(B::ReadAxisError, "MC_ReadAxisError", "tells the error of the axis", Enable, &[], READING),
        block(B::ReadActualPosition, "MC_ReadActualPosition", "tells the actual position", Enable, &[], READING),
        block(B::ReadActualVelocity, "MC_ReadActualVelocity", "tells the actual velocity", Enable, &[], READING),
        block(B::ReadActualTorque, "MC_ReadActualTorque", "tells the actual torque or force", Enable, &[], READING),
        block(
            B::Profile4th,
            "Profile4th",
            "the generator of fourth order as a block: moves to a position",
            Enable,
            &["position", "velocity", "acceleration", "jerk", "snap", "settling_time", "reversed"],
            &[Ready, Done, Busy, Active, CommandAborted, Error],
        ),
    ]
};

impl BlockName {
    pub(crate) fn interface(self) -> &'static Interface {
        // The order of the table is that of the names; a test holds them together.
        &BLOCKS[self as usize]
    }

    pub(crate) fn name(self) -> &'static str {
        self.interface().name
    }
}

impl Output {
    /// Name in the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Done => "Done",
            Self::Busy => "Busy",
            Self::Active => "Active",
            Self::CommandAborted => "CommandAborted",
            Self::Error => "Error",
            Self::Status => "Status",
            Self::Valid => "Valid",
            Self::InVelocity => "InVelocity",
            Self::InEndVelocity => "InEndVelocity",
            Self::InTorque => "InTorque",
            Self::ProfileCompleted => "ProfileCompleted",
            Self::Enabled => "Enabled",
            Self::Ready => "Ready",
            Self::Disabled => "Disabled",
            Self::Standstill => "Standstill",
            Self::Homing => "Homing",
            Self::DiscreteMotion => "DiscreteMotion",
            Self::ContinuousMotion => "ContinuousMotion",
            Self::Stopping => "Stopping",
            Self::ErrorStop => "ErrorStop",
        }
    }
}

impl Field for BlockName {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Some(text) = node.value.as_text() else {
            let message = format!("`{}` must be the name of a function block, got {}", key(path), written(node));
            report.error(node.span, message, "write \"MC_MoveAbsolute\"");
            return None;
        };
        let found = BLOCKS.iter().find(|interface| interface.name == text);
        if found.is_none() {
            let names = BLOCKS.iter().map(|interface| interface.name);
            report.error(node.span, format!("there is no function block \"{text}\""), suggestion(text, names));
        }
        found.map(|interface| interface.block)
    }

    fn schema((): &()) -> Json {
        let each = BLOCKS.iter().map(|interface| {
            let outputs: Vec<_> = interface.outputs.iter().map(|output| output.name()).collect();
            json!({
                "const": interface.name,
                "description": interface.meaning,
                "x-trigger": if interface.trigger == Trigger::Enable { "Enable" } else { "Execute" },
                "x-inputs": interface.inputs,
                "x-outputs": outputs,
            })
        });
        json!({ "oneOf": each.collect::<Vec<_>>() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::Call;

    #[test]
    fn each_block_finds_its_interface() {
        for interface in BLOCKS {
            assert_eq!(interface.block.name(), interface.name);
        }
    }

    #[test]
    fn every_input_is_a_key_of_a_call() {
        let keys = Call::schema(&());
        for interface in BLOCKS {
            for input in interface.inputs {
                assert!(keys["properties"][input].is_object(), "{}.{input}", interface.name);
            }
        }
    }
}
