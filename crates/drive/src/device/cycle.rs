//! Timing of the targets of the cyclic modes.
//!
//! The drive keeps its own clock with the period of the frames, started by the first one. A frame acts at the beginning of the cycle after
//! its arrival, however early it came. A cycle that begins without a new frame is a missed one. If its frame comes after all, the cycle
//! restarts with it: the clock follows the latest of the frames, and frames no later than that are in time from then on.

use servobench_base::Stateful;
/// Rates of the clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Params {
    /// Steps of the drive per frame (60C2h), at least 1.
    pub steps: u32,
    /// Steps that the first frame waits for its cycle: the tolerated lateness of the other frames.
    pub shift: u32,
    /// Cycles in a row that may begin without a new frame.
    pub bridged: u32,
}

/// Event of the clock at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleEvent {
    /// A cycle begins and the targets of a new frame act.
    Sample,
    /// A cycle begins without a new frame.
    Missed,
    /// The frame of a missed cycle has come: the cycle restarts, and its targets act.
    Late,
    /// A cycle continues, or none has begun.
    Between,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub(super) struct State {
    /// Steps until the next cycle begins; `None` before the first frame.
    left: Option<u32>,
    is_waiting: bool,
    missed: u32,
}

impl State {
    /// Consecutive cycles that began without a new frame.
    pub(super) const fn missed(&self) -> u32 {
        self.missed
    }
}

/// Counts a step; `came` is true if a frame came since the last one. After more missed cycles than are bridged, the clock waits for another
/// first frame.
pub(super) fn step(p: &Params, x: &mut State, came: bool) -> CycleEvent {
    x.is_waiting |= came;
    if x.left.is_none() && came {
        (x.left, x.missed) = (Some(p.shift), 0);
    }
    match x.left {
        None => CycleEvent::Between,
        Some(1..) if came && x.missed > 0 => {
            *x = State { left: Some(p.steps - 1), is_waiting: false, missed: 0 };
            CycleEvent::Late
        }
        Some(0) => {
            x.left = Some(p.steps - 1);
            if core::mem::take(&mut x.is_waiting) {
                x.missed = 0;
                return CycleEvent::Sample;
            }
            x.missed += 1;
            if x.missed > p.bridged {
                x.left = None;
            }
            CycleEvent::Missed
        }
        Some(left) => {
            x.left = Some(left - 1);
            CycleEvent::Between
        }
    }
}
