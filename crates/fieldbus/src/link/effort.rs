//! Efforts from one cycle of the motion task to the next: linear, as the source has it for the torque in every mode.
//!
//! It begins with the actual effort. Held when the next one is late, and led to zero within a cycle when it stays away for as long as set-points would be
//! predicted.
use super::buffer::{PREDICTED, Timing};
use crate::Interpolation;

/// From one effort to another (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq)]
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
