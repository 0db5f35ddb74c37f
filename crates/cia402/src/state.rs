//! The states of the power drive system (IEC 61800-7-201, finite state automaton).
use core::fmt;
use servobench_base::Stateful;

/// A state of the power drive system, as in the statusword (6041h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub enum PowerState {
    /// Initialisation and self-test; nothing is commanded yet.
    #[default]
    NotReadyToSwitchOn,
    /// Initialised; the high-level power may not be switched on.
    SwitchOnDisabled,
    /// The high-level power may be switched on.
    ReadyToSwitchOn,
    /// The high-level power is on, the motor carries no torque.
    SwitchedOn,
    /// The drive function is enabled: set-points are followed.
    OperationEnabled,
    /// The quick stop function brakes the axis or holds it.
    QuickStopActive,
    /// A fault was detected; the fault reaction brakes the axis.
    FaultReactionActive,
    /// The fault reaction is over; only a reset leads out.
    Fault,
}

impl PowerState {
    /// Every state, in the order of the standard.
    pub const ALL: [Self; 8] = [
        Self::NotReadyToSwitchOn,
        Self::SwitchOnDisabled,
        Self::ReadyToSwitchOn,
        Self::SwitchedOn,
        Self::OperationEnabled,
        Self::QuickStopActive,
        Self::FaultReactionActive,
        Self::Fault,
    ];

    /// Name in the words of the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotReadyToSwitchOn => "Not ready to switch on",
            Self::SwitchOnDisabled => "Switch on disabled",
            Self::ReadyToSwitchOn => "Ready to switch on",
            Self::SwitchedOn => "Switched on",
            Self::OperationEnabled => "Operation enabled",
            Self::QuickStopActive => "Quick stop active",
            Self::FaultReactionActive => "Fault reaction active",
            Self::Fault => "Fault",
        }
    }

    /// True if the drive function is enabled, so that the power stage may drive current through the motor.
    #[must_use]
    pub const fn is_drive_function_enabled(self) -> bool {
        matches!(self, Self::OperationEnabled | Self::QuickStopActive | Self::FaultReactionActive)
    }
}

impl fmt::Display for PowerState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
