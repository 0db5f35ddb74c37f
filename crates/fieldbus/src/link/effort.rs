//! Limits of the effort, and efforts from one cycle of the motion task to the next: linear, as the source has it for the torque in every mode.
//!
//! It begins with the actual effort. Held when the next one is late, and led to zero within a cycle when it stays away for as long as set-points would be
//! predicted.
use super::buffer::{PREDICTED, Timing};
use crate::Interpolation;
use servobench_base::Stateful;

/// The largest effort that the drive is told. One that is lifted or raised acts until the set-points from before are behind: an axis
/// that is held by its limit would push with all it has.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(crate) struct Limit {
    /// The limit that acts (N·m or N), and when it was asked for last (base ticks).
    held: Option<(f64, u64)>,
}

impl Limit {
    /// What the drive is told `now`, with set-points that are `delay` ticks on their way; `asked` by the motion task.
    pub(crate) fn step(&mut self, asked: Option<f64>, delay: u64, now: u64) -> Option<f64> {
        let is_lower = |limit: f64| asked.is_none_or(|asked| asked > limit);
        match self.held {
            Some((limit, since)) if is_lower(limit) && now - since <= delay => {}
            _ => self.held = asked.map(|limit| (limit, now)),
        }
        self.held.map(|(limit, _)| limit)
    }
}

/// From one effort to another (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Ramp {
    from: f64,
    to: f64,
    /// When it started (base ticks).
    start: u64,
    state: Interpolation,
}

impl Ramp {
    /// Nothing is followed; who begins to follow begins with `effort`.
    pub(crate) const fn off(effort: f64) -> Self {
        Self { from: effort, to: effort, start: 0, state: Interpolation::Off }
    }

    pub(crate) const fn state(&self) -> Interpolation {
        self.state
    }

    /// Towards `effort`, where there is a new one; what is put out `now`.
    pub(crate) fn step(&mut self, timing: &Timing, effort: Option<f64>, now: u64) -> f64 {
        if let Some(effort) = effort {
            *self = Self { from: self.at(timing, now), to: effort, start: now, state: Interpolation::Run1 };
        }
        if self.state.is_running() {
            let late = now.saturating_sub(self.start + timing.margin) / timing.cycle;
            self.state = match late {
                0 => Interpolation::Run1,
                1 => Interpolation::Run2,
                late if late <= PREDICTED as u64 => Interpolation::Run3,
                _ => {
                    *self = Self { from: self.at(timing, now), to: 0.0, start: now, ..*self };
                    Interpolation::Underflow
                }
            };
        }
        self.at(timing, now)
    }

    /// The effort at `now`.
    pub(crate) fn at(&self, timing: &Timing, now: u64) -> f64 {
        let passed = now.saturating_sub(self.start).min(timing.cycle);
        self.from + (self.to - self.from) * (passed as f64 / timing.cycle as f64)
    }
}
