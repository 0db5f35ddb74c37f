//! A leg of a search: its direction, its speed and its end.
use crate::modes::Actual;
use core::fmt;
use servobench_base::Stateful;

/// A switch at the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Switch {
    /// At the negative end of the axis, on from there outwards.
    NegativeLimit,
    /// At the positive end of the axis, on from there outwards.
    PositiveLimit,
    /// Between them: on over a part of the travel, or from one point to an end.
    Home,
}

impl Switch {
    /// True if the switch is on.
    #[must_use]
    pub const fn is_on(self, actual: &Actual) -> bool {
        match self {
            Self::NegativeLimit => actual.negative_limit,
            Self::PositiveLimit => actual.positive_limit,
            Self::Home => actual.home,
        }
    }

    /// Name in the words of the profile.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NegativeLimit => "negative limit switch",
            Self::PositiveLimit => "positive limit switch",
            Self::Home => "home switch",
        }
    }
}

/// A direction along the axis; positions grow to the right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Direction {
    /// To the left.
    Negative,
    /// To the right.
    Positive,
}

impl Direction {
    /// −1 or 1.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Negative => -1.0,
            Self::Positive => 1.0,
        }
    }

    /// The other direction.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Positive => Self::Negative,
        }
    }

    /// Limit switch at the end in this direction.
    #[must_use]
    pub const fn limit_switch(self) -> Switch {
        match self {
            Self::Negative => Switch::NegativeLimit,
            Self::Positive => Switch::PositiveLimit,
        }
    }
}

/// Event that ends a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// The switch of the method turns on.
    On,
    /// The switch of the method turns off.
    Off,
    /// An index pulse comes.
    Index,
}

/// Homing speed (6099h) of a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Speed {
    /// During search for switch (6099h.1).
    Switch,
    /// During search for zero (6099h.2).
    Zero,
}

/// A leg of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Leg {
    /// Direction.
    pub direction: Direction,
    /// End of the leg. An event counts only while the axis moves in the direction of the leg.
    pub until: Event,
    /// Speed.
    pub speed: Speed,
}

impl fmt::Display for Leg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let arrow = match self.direction {
            Direction::Negative => '←',
            Direction::Positive => '→',
        };
        let until = match self.until {
            Event::On => "on",
            Event::Off => "off",
            Event::Index => "index",
        };
        write!(f, "{arrow} {until}")
    }
}
