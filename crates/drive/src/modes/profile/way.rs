//! A planned way that is gone step by step.
use servobench_base::{Setpoint, Stateful};
use servobench_motion::Piece;
use servobench_motion::online::Transition;

/// A planned way and how far it has been gone.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Way {
    pub(super) transition: Transition,
    /// The part of it that is being gone.
    piece: Piece,
    steps: u32,
}

impl Way {
    pub(super) fn along(transition: &Transition) -> Self {
        Self { transition: *transition, piece: transition.piece(0.0), steps: 0 }
    }

    /// The set-point of the next step, the first one being that of the start, and whether the end is reached.
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
