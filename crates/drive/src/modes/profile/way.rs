//! Step-by-step execution of a planned profile.
use servobench_base::{Setpoint, Stateful};
use servobench_motion::Piece;
use servobench_motion::online::Transition;

/// A planned profile and its progress.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Way {
    pub(super) transition: Transition,
    /// Present piece of the profile.
    piece: Piece,
    steps: u32,
}

impl Way {
    pub(super) fn along(transition: &Transition) -> Self {
        Self { transition: *transition, piece: transition.piece(0.0), steps: 0 }
    }

    /// Set-point of the next step, beginning with that of the start, and true if the end is reached.
    #[inline]
    pub(super) fn next(&mut self, period: f64) -> (Setpoint, bool) {
        let passed = f64::from(self.steps) * period;
        self.steps = self.steps.saturating_add(1);
        if !self.piece.holds(passed) {
            self.piece = self.transition.piece(passed);
        }
        (self.piece.at(passed), passed >= self.transition.duration())
    }
}
