//! Homing by the drive (mode 6), as the master sees it.
//!
//! Bit 4 of the controlword starts it by its edge, given when the drive shows the mode (6061h). The statusword tells the rest
//! (IEC 61800-7-201, homing mode):
//!
//! | bit 13 | bit 12 | bit 10 | |
//! |---|---|---|---|
//! | 0 | 0 | 0 | under way |
//! | 0 | 0 | 1 | interrupted or not started |
//! | 0 | 1 | 0 | attained, still moving |
//! | 0 | 1 | 1 | completed |
//! | 1 | 0 | x | error |
//!
//! What the drive says before it can know of the start belongs to an earlier homing and is not looked at.
//!
//! A motion task that asks for something else meanwhile takes bit 4 back. The mode stays until the drive is known to rest: it may find
//! its reference before it learns of the change, and its positions then count from another zero than those it would be sent.
use crate::Homing;
use servobench_base::Stateful;
use servobench_cia402::{StatusBit, Statusword};

/// How far it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(crate) enum Procedure {
    /// Not asked for, or waiting for the mode.
    Idle,
    /// Started at this tick.
    Started(u64),
    /// Over, for good or bad.
    Over(Homing),
    /// Taken back at this tick; the drive is not known to rest yet.
    Interrupted(u64),
}

impl Procedure {
    /// Whether bit 4 is set.
    pub(crate) const fn is_started(self) -> bool {
        matches!(self, Self::Started(_) | Self::Over(_))
    }

    pub(crate) const fn feedback(self, is_asked_for: bool) -> Homing {
        match self {
            Self::Over(homing) => homing,
            Self::Started(_) | Self::Interrupted(_) => Homing::Busy,
            Self::Idle if is_asked_for => Homing::Busy,
            Self::Idle => Homing::Idle,
        }
    }

    /// The drive is in the mode and has said `word`; the answer to what was told at `known` and before. Whether the reference
    /// was found with that.
    pub(crate) const fn step(&mut self, word: Statusword, known: u64, now: u64) -> bool {
        match *self {
            Self::Idle => *self = Self::Started(now),
            Self::Started(start) if start <= known => {
                if word.has(StatusBit::ModeSpecific13) {
                    *self = Self::Over(Homing::Failed);
                } else if word.has(StatusBit::ModeSpecific12) && word.has(StatusBit::TargetReached) {
                    *self = Self::Over(Homing::Attained);
                    return true;
                }
            }
            Self::Started(_) | Self::Over(_) | Self::Interrupted(_) => {}
        }
        false
    }

    /// Something else is asked for.
    pub(crate) const fn leave(&mut self, now: u64) {
        *self = match *self {
            Self::Started(_) => Self::Interrupted(now),
            Self::Interrupted(since) => Self::Interrupted(since),
            Self::Idle | Self::Over(_) => Self::Idle,
        };
    }

    pub(crate) const fn is_interrupted(self) -> bool {
        matches!(self, Self::Interrupted(_))
    }

    /// The drive has said `word` while it is interrupted, the answer to what was told at `known` and before. Whether the reference
    /// was found before it received of that.
    pub(crate) const fn end(&mut self, word: Statusword, known: u64) -> bool {
        match *self {
            Self::Interrupted(since) if since <= known && word.has(StatusBit::TargetReached) => {
                *self = Self::Idle;
                word.has(StatusBit::ModeSpecific12)
            }
            _ => false,
        }
    }

    /// The drive cannot go on.
    pub(crate) const fn fail(&mut self) {
        match self {
            Self::Started(_) => *self = Self::Over(Homing::Failed),
            Self::Interrupted(_) => *self = Self::Idle,
            Self::Idle | Self::Over(_) => {}
        }
    }
}
