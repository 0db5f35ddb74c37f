//! The names of the function blocks.
use core::fmt;

/// A function block: of the standard, but for `Profile4th`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BlockName {
    /// `MC_Power`.
    Power,
    /// `MC_Home`.
    Home,
    /// `MC_Stop`.
    Stop,
    /// `MC_Halt`.
    Halt,
    /// `MC_Reset`.
    Reset,
    /// `MC_MoveAbsolute`.
    MoveAbsolute,
    /// `MC_MoveRelative`.
    MoveRelative,
    /// `MC_MoveAdditive`.
    MoveAdditive,
    /// `MC_MoveSuperimposed`.
    MoveSuperimposed,
    /// `MC_MoveVelocity`.
    MoveVelocity,
    /// `MC_MoveContinuousAbsolute`.
    MoveContinuousAbsolute,
    /// `MC_TorqueControl`.
    TorqueControl,
    /// `MC_PositionProfile`.
    PositionProfile,
    /// `MC_VelocityProfile`.
    VelocityProfile,
    /// `MC_AccelerationProfile`.
    AccelerationProfile,
    /// `Profile4th`, beyond the standard.
    Profile4th,
    /// `MC_SetPosition`.
    SetPosition,
    /// `MC_SetOverride`.
    SetOverride,
    /// `MC_ReadStatus`.
    ReadStatus,
    /// `MC_ReadAxisError`.
    ReadAxisError,
    /// `MC_ReadActualPosition`.
    ReadActualPosition,
    /// `MC_ReadActualVelocity`.
    ReadActualVelocity,
    /// `MC_ReadActualTorque`.
    ReadActualTorque,
}

impl BlockName {
    /// The blocks that ask for a motion or for its end, those of the state diagram.
    pub const COMMANDS: [Self; 14] = [
        Self::Home,
        Self::Stop,
        Self::Halt,
        Self::MoveAbsolute,
        Self::MoveRelative,
        Self::MoveAdditive,
        Self::MoveSuperimposed,
        Self::MoveVelocity,
        Self::MoveContinuousAbsolute,
        Self::TorqueControl,
        Self::PositionProfile,
        Self::VelocityProfile,
        Self::AccelerationProfile,
        Self::Profile4th,
    ];

    /// Name in the spelling of the standard, or of the paper.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Power => "MC_Power",
            Self::Home => "MC_Home",
            Self::Stop => "MC_Stop",
            Self::Halt => "MC_Halt",
            Self::Reset => "MC_Reset",
            Self::MoveAbsolute => "MC_MoveAbsolute",
            Self::MoveRelative => "MC_MoveRelative",
            Self::MoveAdditive => "MC_MoveAdditive",
            Self::MoveSuperimposed => "MC_MoveSuperimposed",
            Self::MoveVelocity => "MC_MoveVelocity",
            Self::MoveContinuousAbsolute => "MC_MoveContinuousAbsolute",
            Self::TorqueControl => "MC_TorqueControl",
            Self::PositionProfile => "MC_PositionProfile",
            Self::VelocityProfile => "MC_VelocityProfile",
            Self::AccelerationProfile => "MC_AccelerationProfile",
            Self::Profile4th => "Profile4th",
            Self::SetPosition => "MC_SetPosition",
            Self::SetOverride => "MC_SetOverride",
            Self::ReadStatus => "MC_ReadStatus",
            Self::ReadAxisError => "MC_ReadAxisError",
            Self::ReadActualPosition => "MC_ReadActualPosition",
            Self::ReadActualVelocity => "MC_ReadActualVelocity",
            Self::ReadActualTorque => "MC_ReadActualTorque",
        }
    }
}

impl fmt::Display for BlockName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
