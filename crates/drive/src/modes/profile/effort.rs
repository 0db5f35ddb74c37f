//! Profile torque (tq): the effort ramps to its target (6071h) at the torque slope (6087h). The target is reached (bit 10) when the demand
//! equals it.
use super::slopes::Slopes;
use crate::Demand;
use crate::modes::{Answer, Moment};
use servobench_base::Stateful;

/// Parameters of the mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Torque slope (6087h), a magnitude (N·m/s or N/s); infinite for a step.
    pub slope: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    /// Effort of the next step.
    effort: f64,
}

impl State {
    /// Continues from the present effort of the motor.
    #[must_use]
    pub const fn begin(now: &Moment) -> Self {
        Self { effort: now.actual.effort }
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: Params, x: &mut State, now: &Moment) -> Answer {
    let effort = x.effort;
    x.effort = Slopes { away: p.slope, back: p.slope }.next(effort, now.targets.effort, now.period);
    let target_reached = effort.to_bits() == now.targets.effort.to_bits();
    Answer { demand: Demand::Effort(effort), target_reached, bit_12: false, bit_13: false }
}
