//! The touch probe of the drive: request, arming and reading.
//!
//! A request is sent by the function (60B8h) after the drive has shown (60B9h) that the previous one is withdrawn. An answer sent before
//! the drive can know of a request belongs to an earlier one and is ignored.
use super::Params;
use super::position::Position;
use crate::{ProbeFeedback, TouchProbe};
use servobench_base::Stateful;
use servobench_cia402::{Actuals, touch_probe};

/// State of a link for the touch probe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub(super) struct Probe {
    number: u32,
    phase: Phase,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
enum Phase {
    /// No request.
    #[default]
    Off,
    /// Withdrawn since this tick.
    Clearing(u64),
    /// Requested since this tick.
    Armed(u64),
    /// The axis was at this position (counts).
    Latched(i128),
}

impl Probe {
    /// Executes a step, with the drive last received at `received`; returns the function for the drive.
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
