//! Cyclic synchronous velocity (csv): the velocity approaches the sum of target (60FFh) and offset (60B1h) linearly within a cycle. Its
//! slope is available to the feedforward.
use super::{Linear, Progress};
use crate::Demand;
use crate::device::CycleEvent;
use crate::modes::{Answer, Moment};
use servobench_base::{Setpoint, Stateful};

/// Interpolation of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Steps of the drive per cycle.
    pub steps: u32,
    /// Highest velocity (6080h), a magnitude.
    pub velocity: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    velocity: Linear,
    effort_offset: Linear,
    progress: Progress,
    is_limited: bool,
}

impl State {
    /// Continues the present motion until the first target.
    #[must_use]
    pub const fn begin(now: &Moment) -> Self {
        Self {
            velocity: Linear::resting(now.demanded.v),
            effort_offset: Linear::resting(now.targets.effort_offset),
            progress: Progress { steps: 0 },
            is_limited: false,
        }
    }

    /// True if the last target exceeded the highest velocity.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.is_limited
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: &Params, x: &mut State, now: &Moment, event: CycleEvent) -> Answer {
    let targets = &now.targets;
    if event != CycleEvent::Between {
        let broken_off = x.progress.broken_off(event, p.steps);
        x.progress = Progress::default();
        let (velocity, effort_offset) = if event == CycleEvent::Missed {
            (x.velocity.to, x.effort_offset.to)
        } else {
            (targets.velocity + targets.velocity_offset, targets.effort_offset)
        };
        x.is_limited = velocity.abs() > p.velocity;
        x.velocity.go_to(velocity.clamp(-p.velocity, p.velocity), broken_off);
        x.effort_offset.go_to(effort_offset, broken_off);
    }
    let cycle = f64::from(p.steps) * now.period;
    let passed = x.progress.next(p.steps);
    let slope = if passed < 1.0 { (x.velocity.to - x.velocity.from) / cycle } else { 0.0 };
    let setpoint = Setpoint { v: x.velocity.at(passed), a: slope, ..Setpoint::at_rest(now.actual.position) };
    let demand = Demand::Velocity { setpoint, effort_offset: x.effort_offset.at(passed) };
    Answer { demand, target_reached: false, bit_12: true, bit_13: false }
}
