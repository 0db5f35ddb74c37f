//! The touch probe of the drive: asked for, armed, read.
//!
//! A question is put by the function (60B8h) after the drive has shown (60B9h) that the one before is taken back. What the drive says
//! before it can know of what it was told belongs to an earlier question and is not looked at.
use super::Params;
use super::position::Position;
use crate::{ProbeFeedback, TouchProbe};
use servobench_base::Stateful;
use servobench_cia402::{Actuals, touch_probe};

/// What a link remembers of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub(super) struct Probe {
    number: u32,
    phase: Phase,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
enum Phase {
    /// Nothing is asked for.
    #[default]
    Off,
    /// Taken back since this tick.
    Clearing(u64),
    /// Asked for since this tick.
    Armed(u64),
    /// The axis was at so many counts.
    Latched(i128),
}

impl Probe {
    /// One step, in which the drive was received last at `received`: the function for the drive.
    pub(super) fn step(
        &mut self,
        p: &Params,
        asked: Option<TouchProbe>,
        (actuals, position): (&Actuals, Option<&Position>),
        (received, now): (u64, u64),
    ) -> u16 {
        let Some(TouchProbe { number, trigger }) = asked else {
            *self = Self::default();
            return 0;
        };
        if self.number != number {
            *self = Self { number, phase: Phase::Clearing(now) };
        }
        let knows = |since: u64| since + p.round_trip <= received;
        match self.phase {
            Phase::Clearing(since) if knows(since) && actuals.touch_probe_status & touch_probe::ENABLED == 0 => {
                self.phase = Phase::Armed(now);
            }
            Phase::Armed(since) if knows(since) => {
                let edge = trigger.edge();
                if let (true, Some(position)) = (actuals.touch_probe_status & edge.stored() != 0, position) {
                    let latched = actuals.touch_probe_positions[edge as usize];
                    self.phase = Phase::Latched(position.counts() + p.scale.away(actuals.position, latched));
                }
            }
            Phase::Off | Phase::Clearing(_) | Phase::Armed(_) | Phase::Latched(_) => {}
        }
        match self.phase {
            Phase::Off | Phase::Clearing(_) => 0,
            Phase::Armed(_) | Phase::Latched(_) => trigger.function(),
        }
    }

    pub(super) fn feedback(&self, p: &Params) -> ProbeFeedback {
        let position = if let Phase::Latched(counts) = self.phase { Some(p.scale.position(counts)) } else { None };
        ProbeFeedback { number: self.number, position }
    }
}
