//! A motion that a block has the axis make, as a recording keeps moves.
use servobench_base::Setpoint;
use servobench_trace::{Ending, Move};

/// A motion under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Made {
    start: f64,
    from: f64,
    /// Largest |velocity|, |acceleration|, |jerk|, |snap| of its set-points.
    peaks: [f64; 4],
}

impl Made {
    /// Begins at `t` (s) from where the axis is commanded to be.
    pub(super) fn begin(t: f64, commanded: Setpoint) -> Self {
        let mut made = Self { start: t, from: commanded.x, peaks: [0.0; 4] };
        made.follow(commanded);
        made
    }

    /// Goes on by a cycle.
    pub(super) fn follow(&mut self, Setpoint { v, a, j, s, .. }: Setpoint) {
        for (peak, value) in self.peaks.iter_mut().zip([v, a, j, s]) {
            *peak = peak.max(value.abs());
        }
    }

    /// Ends at `t` (s); `None` where nothing moved.
    pub(super) fn end(self, t: f64, commanded: Setpoint, label: String, ending: Ending) -> Option<Move> {
        let Self { start, from, peaks } = self;
        let is_move = peaks[0] > 0.0 && t > start;
        is_move.then_some(Move {
            label,
            start,
            end: t,
            from,
            to: commanded.x,
            peaks,
            limits: [None; 4],
            cruise: (t, 0.0),
            ending,
        })
    }
}
