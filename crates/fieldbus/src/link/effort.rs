//! Limits of the effort, and interpolation of efforts between cycles of the motion task: linear, as in the source for the torque in every
//! mode.
//!
//! It begins with the actual effort. The effort is held when the next one is late, and led to zero within a cycle when it stays away longer
//! than set-points would be predicted.
use super::buffer::{PREDICTED, Timing};
use crate::Interpolation;
use servobench_base::Stateful;

/// Largest effort sent to the drive. A limit that is removed or raised stays active until earlier set-points have passed: an axis that is
/// held by its limit would otherwise push with full effort.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(crate) struct Limit {
    /// Limit in effect (N·m or N), and the time of its last request (base ticks).
    held: Option<(f64, u64)>,
}

impl Limit {
    /// Limit sent to the drive at `now`, for set-points delayed by `delay` ticks; `asked` comes from the motion task.
    pub(crate) fn step(&mut self, asked: Option<f64>, delay: u64, now: u64) -> Option<f64> {
        let is_lower = |limit: f64| asked.is_none_or(|asked| asked > limit);
        match self.held {
            Some((limit, since)) if is_lower(limit) && now - since <= delay => {}
            _ => self.held = asked.map(|limit| (limit, now)),
        }
        self.held.map(|(limit, _)| limit)
    }
}

/// Linear ramp from one effort to another (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Ramp {
    from: f64,
    to: f64,
    /// Start time (base ticks).
    start: u64,
    state: Interpolation,
}

impl Ramp {
    /// A ramp without a demand; a new demand starts from `effort`.
    pub(crate) const fn off(effort: f64) -> Self {
        Self { from: effort, to: effort, start: 0, state: Interpolation::Off }
    }

    pub(crate) const fn state(&self) -> Interpolation {
        self.state
    }

    /// Advances towards `effort`, if there is a new one; returns the output at `now`.
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

    /// Effort at `now`.
    pub(crate) fn at(&self, timing: &Timing, now: u64) -> f64 {
        let passed = now.saturating_sub(self.start).min(timing.cycle);
        self.from + (self.to - self.from) * (passed as f64 / timing.cycle as f64)
    }
}
