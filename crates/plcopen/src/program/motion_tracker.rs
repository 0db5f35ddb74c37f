//! The motions that blocks have the axis make.
use servobench_base::{Ending, Setpoint, Stateful};

/// A motion that a block had the axis make.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Motion {
    /// Index of its call.
    pub call: usize,
    /// When it began (s).
    pub start: f64,
    /// When it ended (s).
    pub end: f64,
    /// Where it began.
    pub from: f64,
    /// Where it ended.
    pub to: f64,
    /// Largest |velocity|, |acceleration|, |jerk|, |snap| of its set-points.
    pub peaks: [f64; 4],
    /// How it ended.
    pub ending: Ending,
}

/// A motion that is being made.
#[derive(Debug, Clone, Copy, Stateful)]
pub(super) struct MotionTracker {
    start: f64,
    from: f64,
    peaks: [f64; 4],
}

impl MotionTracker {
    /// Begins at `t` (s) from where the axis is commanded to be.
    pub(super) fn begin(t: f64, commanded: Setpoint) -> Self {
        let mut tracker = Self { start: t, from: commanded.x, peaks: [0.0; 4] };
        tracker.follow(commanded);
        tracker
    }

    /// Goes on by a cycle.
    pub(super) fn follow(&mut self, Setpoint { v, a, j, s, .. }: Setpoint) {
        for (peak, value) in self.peaks.iter_mut().zip([v, a, j, s]) {
            *peak = peak.max(value.abs());
        }
    }

    /// Ends at `t` (s); `None` where nothing moved.
    pub(super) fn end(self, call: usize, t: f64, commanded: Setpoint, ending: Ending) -> Option<Motion> {
        let Self { start, from, peaks } = self;
        let is_motion = peaks[0] > 0.0 && t > start;
        is_motion.then_some(Motion { call, start, end: t, from, to: commanded.x, peaks, ending })
    }
}
