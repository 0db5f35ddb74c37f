//! Causes of the fault reaction.
use crate::supervision::Finding;
use servobench_base::Stateful;
use servobench_cia402::ErrorCode;

/// A fault, with its code in the profile (603Fh; IEC 61800-7-201, error codes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Fault {
    /// The power was gone while the drive function was enabled.
    MainsMissing,
    /// The I²t load of motor or drive was reached.
    Overload,
    /// The encoder of the motor failed, or a NaN velocity or effort was measured.
    Encoder,
    /// The encoder of the load failed.
    LoadEncoder,
    /// The supervision of motor and power stage found a fault.
    Supervision(Finding),
    /// More cycles without a frame than the drive bridges.
    FramesMissing,
    /// The following error was outside its window (6065h) for longer than its time-out (6066h).
    FollowingError,
    /// An external fault, with its code.
    External(u16),
}

impl Fault {
    /// Every fault that the drive itself detects.
    pub const OWN: [Self; 14] = [
        Self::MainsMissing,
        Self::Overload,
        Self::Encoder,
        Self::LoadEncoder,
        Self::Supervision(Finding::OverVoltage),
        Self::Supervision(Finding::UnderVoltage),
        Self::Supervision(Finding::LostPhase),
        Self::Supervision(Finding::OverCurrent),
        Self::Supervision(Finding::OverTemperature),
        Self::Supervision(Finding::Stall),
        Self::Supervision(Finding::Commutation),
        Self::Supervision(Finding::OverSpeed),
        Self::FramesMissing,
        Self::FollowingError,
    ];

    /// Value of 603Fh.
    #[must_use]
    pub const fn code(self) -> u16 {
        let code = match self {
            Self::MainsMissing | Self::Supervision(Finding::UnderVoltage) => ErrorCode::DcLinkUnderVoltage,
            Self::Overload => ErrorCode::LoadLevel,
            Self::Encoder => ErrorCode::IncrementalSensor,
            Self::LoadEncoder => ErrorCode::IncrementalSensor2,
            Self::Supervision(Finding::OverVoltage) => ErrorCode::DcLinkOverVoltage,
            Self::Supervision(Finding::LostPhase) => ErrorCode::ArmatureInterrupted,
            Self::Supervision(Finding::OverCurrent) => ErrorCode::OverCurrent,
            Self::Supervision(Finding::OverTemperature) => ErrorCode::Temperature,
            Self::Supervision(Finding::Stall) => ErrorCode::MotorBlocked,
            Self::Supervision(Finding::Commutation) => ErrorCode::Commutation,
            Self::Supervision(Finding::OverSpeed) => ErrorCode::Speed,
            Self::FramesMissing => ErrorCode::SyncController,
            Self::FollowingError => ErrorCode::FollowingError,
            Self::External(code) => return code,
        };
        code as u16
    }
}
