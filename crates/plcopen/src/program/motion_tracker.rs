//! Motions of the axis commanded by blocks.
use servobench_base::{Ending, Setpoint, Stateful};

/// A motion of the axis commanded by a block.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Motion {
    /// Index of the call.
    pub call: usize,
    /// Start time (s).
    pub start: f64,
    /// End time (s).
    pub end: f64,
    /// Start position.
    pub from: f64,
    /// End position.
    pub to: f64,
    /// Largest |velocity|, |acceleration|, |jerk|, |snap| of the set-points.
    pub peaks: [f64; 4],
    /// End of the motion: aborted, at rest or in motion.
    pub ending: Ending,
}

/// A motion in progress.
#[derive(Debug, Clone, Copy, Stateful)]
pub(super) struct MotionTracker {
    start: f64,
    from: f64,
    peaks: [f64; 4],
}

impl MotionTracker {
    /// Begins at `t` (s) from the commanded position.
    pub(super) fn begin(t: f64, commanded: Setpoint) -> Self {
        let mut tracker = Self { start: t, from: commanded.x, peaks: [0.0; 4] };
        tracker.follow(commanded);
        tracker
    }

    /// Tracks the set-point of a cycle.
    pub(super) fn follow(&mut self, Setpoint { v, a, j, s, .. }: Setpoint) {
        for (peak, value) in self.peaks.iter_mut().zip([v, a, j, s]) {
            *peak = peak.max(value.abs());
        }
    }

    /// Ends at `t` (s); `None` if nothing moved.
    pub(super) fn end(self, call: usize, t: f64, commanded: Setpoint, ending: Ending) -> Option<Motion> {
        let Self { start, from, peaks } = self;
        let is_motion = peaks[0] > 0.0 && t > start;
        is_motion.then_some(Motion { call, start, end: t, from, to: commanded.x, peaks, ending })
    }
}
