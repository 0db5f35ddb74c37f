//! The methods of 6098h as data: the legs from the start of the axis to its reference.
//!
//! Methods 17 to 30 are 1 to 14 without the index pulse. Methods 1 to 14 are rows of (switch, direction ahead, edge). There are four edges,
//! as the axis meets them in the direction ahead: the switch turns on at its near edge and off at its far one, each sought in one of the
//! two
//! directions.
//!
//! The last leg finds the reference, at the speed for zero; those before it use the speed for the switch. An edge that is the reference is
//! met at the speed for the switch, as in the drawing of the profile, and then passed at that for zero: if it was met in the direction in
//! which it is sought, the axis first goes back. So the result does not depend on the start of the axis.
use super::leg::{Direction, Event, Leg, Speed, Switch};
use servobench_base::Stateful;
use thiserror::Error;

/// A homing method of the profile (6098h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Method {
    number: i8,
    switch: Option<Switch>,
    ahead: Direction,
    sequence: &'static Sequence,
    turns_at_limit: bool,
}

servobench_base::saved_as!(Method: i8, Method::number, |number| Self::from_number(number).ok());

/// A value of 6098h that is not a supported method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("homing method (6098h) must be one of 1 to 14, 17 to 30, 33, 34, 35 and 37, got {number}")]
pub struct UnknownMethod {
    /// Rejected value.
    pub number: i8,
}

/// Start of a search, or of its repetition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Start {
    /// The switch of the method is off.
    Off,
    /// The switch of the method is on.
    On,
    /// The limit switch ahead came before the home switch.
    AtLimit,
}

impl Method {
    /// The method with this number.
    ///
    /// # Errors
    /// [`UnknownMethod`] for numbers that the profile reserves, and for manufacturer-specific ones below zero.
    pub fn from_number(number: i8) -> Result<Self, UnknownMethod> {
        match number {
            1..=14 => Ok(Self::by_switch(number, number, true)),
            17..=30 => Ok(Self::by_switch(number, number - 16, false)),
            33 => Ok(Self::without_switch(number, Direction::Negative, &INDEX)),
            34 => Ok(Self::without_switch(number, Direction::Positive, &INDEX)),
            35 | 37 => Ok(Self::without_switch(number, Direction::Positive, &HERE)),
            _ => Err(UnknownMethod { number }),
        }
    }

    /// Every method, in the order of the numbers.
    pub fn all() -> impl Iterator<Item = Self> {
        (i8::MIN..=i8::MAX).filter_map(|number| Self::from_number(number).ok())
    }

    fn by_switch(number: i8, row: i8, with_index: bool) -> Self {
        let (switch, ahead, edge, turns_at_limit) = BY_SWITCH[usize::from(row.unsigned_abs()) - 1];
        Self { number, switch: Some(switch), ahead, sequence: edge.sequence(with_index), turns_at_limit }
    }

    const fn without_switch(number: i8, ahead: Direction, sequence: &'static Sequence) -> Self {
        Self { number, switch: None, ahead, sequence, turns_at_limit: false }
    }

    /// Value of 6098h.
    #[must_use]
    pub const fn number(&self) -> i8 {
        self.number
    }

    /// Switch that the axis searches for.
    #[must_use]
    pub const fn switch(&self) -> Option<Switch> {
        self.switch
    }

    /// True if a limit switch met on the first leg reverses the axis; otherwise it ends the search.
    #[must_use]
    pub const fn turns_at_limit(&self) -> bool {
        self.turns_at_limit
    }

    /// Leg `number` from `start`, counted from 0; `None` behind the last. The event that ends the last leg is the reference; without legs,
    /// the present position is.
    #[must_use]
    pub fn leg(&self, start: Start, number: usize) -> Option<Leg> {
        let stages = match start {
            Start::Off => self.sequence.off,
            Start::On => self.sequence.on,
            Start::AtLimit => self.sequence.at_limit,
        };
        let (turn, until) = *stages.get(number)?;
        let direction = match turn {
            Turn::Ahead => self.ahead,
            Turn::Back => self.ahead.reversed(),
        };
        let speed = if number + 1 == stages.len() { Speed::Zero } else { Speed::Switch };
        Some(Leg { direction, until, speed })
    }
}

/// An edge of a switch, as the axis meets it in the direction ahead, and the direction in which it is passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Edge {
    /// The near edge, passed in the direction back: the switch turns off.
    NearBack,
    /// The near edge, passed in the direction ahead: the switch turns on.
    NearAhead,
    /// The far edge, passed in the direction back: the switch turns on.
    FarBack,
    /// The far edge, passed in the direction ahead: the switch turns off.
    FarAhead,
}

/// Methods 1 to 14: the switch, the first direction of an axis that is not on it, the edge, and true if a limit switch met before it
/// reverses the axis.
const BY_SWITCH: [(Switch, Direction, Edge, bool); 14] = [
    (Switch::NegativeLimit, Direction::Negative, Edge::NearBack, false),
    (Switch::PositiveLimit, Direction::Positive, Edge::NearBack, false),
    (Switch::Home, Direction::Positive, Edge::NearBack, false),
    (Switch::Home, Direction::Positive, Edge::NearAhead, false),
    (Switch::Home, Direction::Negative, Edge::NearBack, false),
    (Switch::Home, Direction::Negative, Edge::NearAhead, false),
    (Switch::Home, Direction::Positive, Edge::NearBack, true),
    (Switch::Home, Direction::Positive, Edge::NearAhead, true),
    (Switch::Home, Direction::Positive, Edge::FarBack, true),
    (Switch::Home, Direction::Positive, Edge::FarAhead, true),
    (Switch::Home, Direction::Negative, Edge::NearBack, true),
    (Switch::Home, Direction::Negative, Edge::NearAhead, true),
    (Switch::Home, Direction::Negative, Edge::FarBack, true),
    (Switch::Home, Direction::Negative, Edge::FarAhead, true),
];

/// Direction of a leg relative to the first direction of the method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turn {
    Ahead,
    Back,
}

type Stage = (Turn, Event);

/// Legs from each start.
#[derive(Debug, PartialEq, Eq)]
struct Sequence {
    off: &'static [Stage],
    on: &'static [Stage],
    at_limit: &'static [Stage],
}

const AHEAD_ON: Stage = (Turn::Ahead, Event::On);
const AHEAD_OFF: Stage = (Turn::Ahead, Event::Off);
const AHEAD_INDEX: Stage = (Turn::Ahead, Event::Index);
const BACK_ON: Stage = (Turn::Back, Event::On);
const BACK_OFF: Stage = (Turn::Back, Event::Off);
const BACK_INDEX: Stage = (Turn::Back, Event::Index);

const HERE: Sequence = Sequence { off: &[], on: &[], at_limit: &[] };
const INDEX: Sequence = Sequence { off: &[AHEAD_INDEX], on: &[AHEAD_INDEX], at_limit: &[] };

impl Edge {
    /// Legs to the edge, or past it to the first index pulse behind it.
    const fn sequence(self, with_index: bool) -> &'static Sequence {
        match (self, with_index) {
            (Self::NearBack, true) => &Sequence {
                off: &[AHEAD_ON, BACK_OFF, BACK_INDEX],
                on: &[BACK_OFF, BACK_INDEX],
                at_limit: &[BACK_ON, BACK_OFF, BACK_INDEX],
            },
            (Self::NearAhead, true) => &Sequence {
                off: &[AHEAD_ON, AHEAD_INDEX],
                on: &[BACK_OFF, AHEAD_ON, AHEAD_INDEX],
                at_limit: &[BACK_ON, BACK_OFF, AHEAD_ON, AHEAD_INDEX],
            },
            (Self::FarBack, true) => &Sequence {
                off: &[AHEAD_ON, AHEAD_OFF, BACK_ON, BACK_INDEX],
                on: &[AHEAD_OFF, BACK_ON, BACK_INDEX],
                at_limit: &[BACK_ON, BACK_INDEX],
            },
            (Self::FarAhead, true) => &Sequence {
                off: &[AHEAD_ON, AHEAD_OFF, AHEAD_INDEX],
                on: &[AHEAD_OFF, AHEAD_INDEX],
                at_limit: &[BACK_ON, AHEAD_OFF, AHEAD_INDEX],
            },
            (Self::NearBack, false) => &Sequence {
                off: &[AHEAD_ON, BACK_OFF],
                on: &[BACK_OFF, AHEAD_ON, BACK_OFF],
                at_limit: &[BACK_ON, BACK_OFF, AHEAD_ON, BACK_OFF],
            },
            (Self::NearAhead, false) => &Sequence {
                off: &[AHEAD_ON, BACK_OFF, AHEAD_ON],
                on: &[BACK_OFF, AHEAD_ON],
                at_limit: &[BACK_ON, BACK_OFF, AHEAD_ON],
            },
            (Self::FarBack, false) => &Sequence {
                off: &[AHEAD_ON, AHEAD_OFF, BACK_ON],
                on: &[AHEAD_OFF, BACK_ON],
                at_limit: &[BACK_ON, AHEAD_OFF, BACK_ON],
            },
            (Self::FarAhead, false) => &Sequence {
                off: &[AHEAD_ON, AHEAD_OFF, BACK_ON, AHEAD_OFF],
                on: &[AHEAD_OFF, BACK_ON, AHEAD_OFF],
                at_limit: &[BACK_ON, AHEAD_OFF],
            },
        }
    }
}
