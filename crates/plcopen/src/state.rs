//! The states of an axis (PLCopen part 1, version 2.0, figure 2.1).
use core::fmt;
use servobench_base::Stateful;

/// A state of the axis. Synchronized Motion belongs to blocks for several axes, which are not implemented.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub enum AxisState {
    /// Not powered, without an error.
    #[default]
    Disabled,
    /// Powered, at rest, without a command.
    Standstill,
    /// The drive or homing steps search for the reference.
    Homing,
    /// In motion to a position, through a table of positions, or to rest by MC_Halt.
    DiscreteMotion,
    /// In motion without an end: at a velocity, an effort or along a table of velocities or accelerations.
    ContinuousMotion,
    /// Braked by MC_Stop, which holds the axis until its Execute falls.
    Stopping,
    /// An error of the axis is pending; only MC_Reset leads out.
    ErrorStop,
}

impl AxisState {
    /// Every state.
    pub const ALL: [Self; 7] = [
        Self::Disabled,
        Self::Standstill,
        Self::Homing,
        Self::DiscreteMotion,
        Self::ContinuousMotion,
        Self::Stopping,
        Self::ErrorStop,
    ];

    /// Name in the words of the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Disabled => "Disabled",
            Self::Standstill => "Standstill",
            Self::Homing => "Homing",
            Self::DiscreteMotion => "DiscreteMotion",
            Self::ContinuousMotion => "ContinuousMotion",
            Self::Stopping => "Stopping",
            Self::ErrorStop => "ErrorStop",
        }
    }

    /// Help on reaching a state in which the axis takes motion commands.
    #[must_use]
    pub const fn help(self) -> &'static str {
        match self {
            Self::Disabled => "power the axis with MC_Power and wait for its Status",
            Self::Standstill | Self::DiscreteMotion | Self::ContinuousMotion => "call it in a state that allows it",
            Self::Homing => {
                "wait for Done of MC_Home, end steps of homing with MC_FinishHoming, or leave it with MC_Stop"
            }
            Self::Stopping => "wait for Done of MC_Stop and reset its Execute",
            Self::ErrorStop => "remove the cause that MC_ReadAxisError names and call MC_Reset",
        }
    }
}

impl fmt::Display for AxisState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
