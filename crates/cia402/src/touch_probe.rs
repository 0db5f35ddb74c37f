//! The touch probe (60B8h to 60BBh, IEC 61800-7-201): the drive latches its position at a signal.
//!
//! | bits of the function (60B8h) | |
//! |---|---|
//! | 0 | probe 1 on |
//! | 1 | 0: the first event is latched; 1: every event |
//! | 2, 3 | 0: the input of the probe; 1: the index pulse of the encoder |
//! | 4, 5 | latches at the positive edge, at the negative edge |
//!
//! Bits 0, 1 and 2 of the status (60B9h) show that probe 1 is on, and that a position of the positive and of the negative edge is stored.
//! The drive does not have probe 2: bits 8 to 15 are 0.

/// Bit of function and status: the probe is on.
pub const ENABLED: u16 = 1;
const CONTINUOUS: u16 = 1 << 1;
const SOURCE: u16 = 0b11 << 2;
const INDEX_PULSE: u16 = 1 << 2;

/// An edge of the signal; its value is the index of its position (60BAh, 60BBh).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Edge {
    /// The input becomes active, or an index pulse comes.
    Positive,
    /// The input becomes inactive.
    Negative,
}

impl Edge {
    /// Both edges.
    pub const ALL: [Self; 2] = [Self::Positive, Self::Negative];

    /// Bit of the status: a position of the edge is stored.
    #[must_use]
    pub const fn stored(self) -> u16 {
        2 << self as u16
    }

    /// Bit of the function: the probe latches at the edge.
    #[must_use]
    pub const fn enabled(self) -> u16 {
        1 << 4 << self as u16
    }
}

/// A touch probe function (60B8h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Function(pub u16);

impl Function {
    /// Function that latches the first event of a signal: an edge of the input of the probe, or the index pulse.
    #[must_use]
    pub const fn first(edge: Edge, is_of_index_pulse: bool) -> Self {
        Self(ENABLED | edge.enabled() | if is_of_index_pulse { INDEX_PULSE } else { 0 })
    }

    /// True if the probe is on.
    #[must_use]
    pub const fn is_on(self) -> bool {
        self.0 & ENABLED != 0
    }

    /// True if every event is latched, rather than the first one only.
    #[must_use]
    pub const fn is_continuous(self) -> bool {
        self.0 & CONTINUOUS != 0
    }

    /// True if the signal is the input of the probe.
    #[must_use]
    pub const fn is_of_input(self) -> bool {
        self.0 & SOURCE == 0
    }

    /// True if the signal is the index pulse.
    #[must_use]
    pub const fn is_of_index_pulse(self) -> bool {
        self.0 & SOURCE == INDEX_PULSE
    }

    /// True if the probe latches at `edge`.
    #[must_use]
    pub const fn latches(self, edge: Edge) -> bool {
        self.is_on() && self.0 & edge.enabled() != 0
    }
}
