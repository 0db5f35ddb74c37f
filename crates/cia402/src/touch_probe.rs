//! The touch probe (60B8h to 60BBh, IEC 61800-7-201): the drive latches its position when a signal comes.
//!
//! | bits of the function (60B8h) | |
//! |---|---|
//! | 0 | probe 1 on |
//! | 1 | 0: the first event is latched; 1: every event |
//! | 2, 3 | 0: the input of the probe; 1: the index pulse of the encoder |
//! | 4, 5 | latches at the positive edge, at the negative edge |
//!
//! Bits 0, 1 and 2 of the status (60B9h) say that probe 1 is on, and that a position is stored of the positive and of the negative edge.
//! The drive has no probe 2: bits 8 to 15 are 0.

/// Bit of function and status: the probe is on.
pub const ENABLED: u16 = 1;
const CONTINUOUS: u16 = 1 << 1;
const SOURCE: u16 = 0b11 << 2;
const INDEX_PULSE: u16 = 1 << 2;

/// An edge of the signal, at its place among the positions (60BAh, 60BBh).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Edge {
    /// Of the input that becomes active, or of an index pulse.
    Positive,
    /// Of the input that becomes inactive.
    Negative,
}

impl Edge {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Positive, Self::Negative];

    /// Bit of the status: a position is stored.
    #[must_use]
    pub const fn stored(self) -> u16 {
        2 << self as u16
    }

    /// Bit of the function: latches at it.
    #[must_use]
    pub const fn enabled(self) -> u16 {
        1 << 4 << self as u16
    }
}

/// What a function (60B8h) asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Function(pub u16);

impl Function {
    /// The first event of a signal: an edge of the input of the probe, or the index pulse.
    #[must_use]
    pub const fn first(edge: Edge, is_of_index_pulse: bool) -> Self {
        Self(ENABLED | edge.enabled() | if is_of_index_pulse { INDEX_PULSE } else { 0 })
    }

    /// Whether the probe is on.
    #[must_use]
    pub const fn is_on(self) -> bool {
        self.0 & ENABLED != 0
    }

    /// Whether every event is latched, rather than the first.
    #[must_use]
    pub const fn is_continuous(self) -> bool {
        self.0 & CONTINUOUS != 0
    }

    /// Whether the signal is the input of the probe.
    #[must_use]
    pub const fn is_of_input(self) -> bool {
        self.0 & SOURCE == 0
    }

    /// Whether the signal is the index pulse.
    #[must_use]
    pub const fn is_of_index_pulse(self) -> bool {
        self.0 & SOURCE == INDEX_PULSE
    }

    /// Whether it latches at `edge`.
    #[must_use]
    pub const fn latches(self, edge: Edge) -> bool {
        self.is_on() && self.0 & edge.enabled() != 0
    }
}
