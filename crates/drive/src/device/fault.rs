//! What sends the drive into its fault reaction.

/// A fault, with the code that the profile gives it (603Fh; IEC 61800-7-201, error codes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// The power was gone while the drive function was enabled.
    MainsMissing,
    /// A velocity or an effort that is no number was measured.
    Encoder,
    /// More cycles without a frame than the drive bridges.
    FramesMissing,
    /// The following error was outside its window (6065h) for longer than its time-out (6066h).
    FollowingError,
    /// Something outside the axis: a code of its own.
    External(u16),
}

impl Fault {
    /// Value of 603Fh.
    #[must_use]
    pub const fn code(self) -> u16 {
        match self {
            // DC link under-voltage.
            Self::MainsMissing => 0x3220,
            // Sensor.
            Self::Encoder => 0x7300,
            // Sync controller.
            Self::FramesMissing => 0x8700,
            Self::FollowingError => 0x8611,
            Self::External(code) => code,
        }
    }
}
