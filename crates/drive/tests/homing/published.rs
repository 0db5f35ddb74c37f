//! References of the methods, as published: Bonfiglioli, *Active Cube, application manual Positioning*, 04/08, table 5.2,
//! "Overview Table of Homing Types". Its "falling" and "rising edge" are those of the signal as the axis passes.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Main {
    NegativeLimit,
    PositiveLimit,
    /// A home switch that is on up to the positive end.
    PositiveHome,
    /// A home switch that is on from the negative end.
    NegativeHome,
    LeftEdge,
    RightEdge,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fine {
    PulseLeft,
    PulseRight,
    Falling,
    Rising,
}

/// The limit switch that reverses the axis; the others must not be met.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LimitSwitch {
    Unused,
    Left,
    Right,
}

pub(crate) use Fine::{Falling, PulseLeft, PulseRight, Rising};
pub(crate) use LimitSwitch::{Left, Right, Unused};
pub(crate) use Main::{LeftEdge, NegativeHome, NegativeLimit, PositiveHome, PositiveLimit, RightEdge};

pub(crate) const TABLE: [(i8, Main, Fine, LimitSwitch); 28] = [
    (1, NegativeLimit, PulseRight, Unused),
    (2, PositiveLimit, PulseLeft, Unused),
    (3, PositiveHome, PulseLeft, Unused),
    (4, PositiveHome, PulseRight, Unused),
    (5, NegativeHome, PulseRight, Unused),
    (6, NegativeHome, PulseLeft, Unused),
    (7, LeftEdge, PulseLeft, Right),
    (8, LeftEdge, PulseRight, Right),
    (9, RightEdge, PulseLeft, Right),
    (10, RightEdge, PulseRight, Right),
    (11, RightEdge, PulseRight, Left),
    (12, RightEdge, PulseLeft, Left),
    (13, LeftEdge, PulseRight, Left),
    (14, LeftEdge, PulseLeft, Left),
    (17, NegativeLimit, Falling, Unused),
    (18, PositiveLimit, Falling, Unused),
    (19, PositiveHome, Falling, Unused),
    (20, PositiveHome, Rising, Unused),
    (21, NegativeHome, Falling, Unused),
    (22, NegativeHome, Rising, Unused),
    (23, LeftEdge, Falling, Right),
    (24, LeftEdge, Rising, Right),
    (25, RightEdge, Rising, Right),
    (26, RightEdge, Falling, Right),
    (27, RightEdge, Falling, Left),
    (28, RightEdge, Rising, Left),
    (29, LeftEdge, Rising, Left),
    (30, LeftEdge, Falling, Left),
];
