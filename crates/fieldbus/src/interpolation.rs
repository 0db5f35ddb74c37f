//! State of the interpolation, with the numbers of the block `RM_AxisSpline` of REXYGEN (REX Controls, function block reference, output
//! `State`).

use servobench_base::Stateful;
/// State of the interpolation between two cycles of the motion task.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
#[repr(i8)]
pub enum Interpolation {
    /// Disabled: the output is the axis' own motion: the position that the drive follows, or the actual one without a position loop, its
    /// velocity, and the actual effort.
    #[default]
    Off = 0,
    /// Too few samples yet; the axis waits in place.
    Wait = 1,
    /// In the first interval of the buffer: every sample came in time.
    Run1 = 2,
    /// In the second interval: the newest sample is late, one step is predicted.
    Run2 = 3,
    /// In the third interval: two steps are predicted.
    Run3 = 4,
    /// Samples came faster than they were used; restarts with the newest.
    Overflow = -1,
    /// Samples were missing for longer than can be predicted; the axis is brought to rest and restarts by itself.
    Underflow = -2,
    /// The sample could not be read consistently.
    Busy = -3,
    /// Samples were missed because the link runs more slowly than the motion task.
    Slow = -4,
}

impl Interpolation {
    /// Every state, by number.
    pub const ALL: [Self; 9] = [
        Self::Slow,
        Self::Busy,
        Self::Underflow,
        Self::Overflow,
        Self::Off,
        Self::Wait,
        Self::Run1,
        Self::Run2,
        Self::Run3,
    ];

    /// Number in the source, from −4 to 4.
    #[must_use]
    pub const fn number(self) -> i8 {
        self as i8
    }

    /// Name in the source.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "Off",
            Self::Wait => "Wait",
            Self::Run1 => "Run1",
            Self::Run2 => "Run2",
            Self::Run3 => "Run3",
            Self::Overflow => "Overflow",
            Self::Underflow => "Underflow",
            Self::Busy => "Busy",
            Self::Slow => "Slow",
        }
    }

    /// Meaning for the axis.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Off => {
                "no set-points are requested, or the drive does not follow them: the output is the axis' own position, velocity \
                 and effort"
            }
            Self::Wait => "too few samples yet: the axis holds its position",
            Self::Run1 => "every sample came in time",
            Self::Run2 => "a sample is late: a predicted one takes its place until it arrives",
            Self::Run3 => "two steps are predicted",
            Self::Overflow => "samples arrive faster than they are read: the oldest are discarded",
            Self::Underflow => "no more samples arrive: the axis brakes to rest and starts again with the next ones",
            Self::Busy => "the sample was being written: the previous ones are used",
            Self::Slow => "samples were overwritten before they were read: up to two are predicted instead",
        }
    }

    /// True if the axis follows the motion task, by samples or by their prediction.
    #[must_use]
    pub const fn is_running(self) -> bool {
        matches!(self, Self::Run1 | Self::Run2 | Self::Run3)
    }
}

#[cfg(test)]
mod tests {
    use super::Interpolation;

    #[test]
    fn numbers_are_those_of_the_source() {
        let numbers = Interpolation::ALL.map(|state| (state.number(), state.name()));
        let source = [
            (-4, "Slow"),
            (-3, "Busy"),
            (-2, "Underflow"),
            (-1, "Overflow"),
            (0, "Off"),
            (1, "Wait"),
            (2, "Run1"),
            (3, "Run2"),
            (4, "Run3"),
        ];
        assert_eq!(numbers, source);
    }
}
