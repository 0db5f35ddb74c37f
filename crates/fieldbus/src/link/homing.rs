//! Homing by the drive (mode 6), on the master's side.
//!
//! The edge of bit 4 of the controlword starts it, once the drive shows the mode (6061h). The statusword reports the progress (IEC
//! 61800-7-201, homing mode):
//!
//! | bit 13 | bit 12 | bit 10 | |
//! |---|---|---|---|
//! | 0 | 0 | 0 | searching |
//! | 0 | 0 | 1 | interrupted or not started |
//! | 0 | 1 | 0 | attained, still moving |
//! | 0 | 1 | 1 | completed |
//! | 1 | 0 | x | error |
//!
//! A statusword sent before the drive can know of the start belongs to an earlier homing and is ignored.
//!
//! If the motion task changes its task meanwhile, bit 4 is cleared. The mode stays until the drive is known to rest: it may find its
//! reference before it learns of the change, and its positions would then count from another zero than the targets sent to it.
use crate::Homing;
use servobench_base::Stateful;
use servobench_cia402::{StatusBit, Statusword};

/// State of the procedure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(crate) enum Procedure {
    /// Not requested, or waiting for the mode.
    Idle,
    /// Started at this tick.
    Started(u64),
    /// Finished, with success or failure.
    Over(Homing),
    /// Withdrawn at this tick; the drive is not known to rest yet.
    Interrupted(u64),
}

impl Procedure {
    /// True if bit 4 is set.
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

    /// Evaluates the statusword `word` of a drive in the mode, which reflects the commands up to `known`. Returns true if the reference was
    /// found with it.
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

    /// Withdraws the request.
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

    /// Evaluates the statusword `word` during an interruption, which reflects the commands up to `known`. Returns true if the reference was
    /// found before the drive received the interruption.
    pub(crate) const fn end(&mut self, word: Statusword, known: u64) -> bool {
        match *self {
            Self::Interrupted(since) if since <= known && word.has(StatusBit::TargetReached) => {
                *self = Self::Idle;
                word.has(StatusBit::ModeSpecific12)
            }
            _ => false,
        }
    }

    /// Ends the procedure because the drive cannot continue.
    pub(crate) const fn fail(&mut self) {
        match self {
            Self::Started(_) => *self = Self::Over(Homing::Failed),
            Self::Interrupted(_) => *self = Self::Idle,
            Self::Idle | Self::Over(_) => {}
        }
    }
}
