//! Cyclic synchronous torque (cst): the effort approaches the sum of target (6071h) and offset (60B2h) linearly within a cycle.
use super::{Linear, Progress};
use crate::Demand;
use crate::device::CycleEvent;
use crate::modes::{Answer, Moment};
use servobench_base::Stateful;

/// Interpolation of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Params {
    /// Steps of the drive per cycle.
    pub steps: u32,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    effort: Linear,
    progress: Progress,
}

impl State {
    /// Continues with the present effort of the motor until the first target.
    #[must_use]
    pub const fn begin(now: &Moment) -> Self {
        Self { effort: Linear::resting(now.actual.effort), progress: Progress { steps: 0 } }
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: Params, x: &mut State, now: &Moment, event: CycleEvent) -> Answer {
    if event != CycleEvent::Between {
        let broken_off = x.progress.broken_off(event, p.steps);
        x.progress = Progress::default();
        let asked = now.targets.effort + now.targets.effort_offset;
        x.effort.go_to(if event == CycleEvent::Missed { x.effort.to } else { asked }, broken_off);
    }
    let demand = Demand::Effort(x.effort.at(x.progress.next(p.steps)));
    Answer { demand, target_reached: false, bit_12: true, bit_13: false }
}
