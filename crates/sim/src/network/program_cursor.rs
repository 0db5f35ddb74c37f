//! Progress of a program of moves: its time begins with the cycle in which the axis is powered.
use crate::program::Program;
use servobench_base::{Setpoint, Stateful};
use servobench_fieldbus::{AxisFeedback, Power};
use servobench_trace::Move;

/// A program and its progress.
#[derive(Debug, Stateful)]
pub(super) struct ProgramCursor {
    program: Program,
    /// Cycle of the motion task (s).
    #[state(constant)]
    period: f64,
    /// Cycles before the axis was powered, and since then.
    waited: u64,
    passed: u64,
}

impl ProgramCursor {
    pub(super) const fn new(program: Program, period: f64) -> Self {
        Self { program, period, waited: 0, passed: 0 }
    }

    pub(super) const fn program(&self) -> &Program {
        &self.program
    }

    /// One cycle: the time of the program in it (s); `None` before the axis is powered.
    pub(super) fn cycle(&mut self, feedback: &AxisFeedback) -> Option<f64> {
        if self.passed == 0 && feedback.power != Power::On {
            self.waited += 1;
            return None;
        }
        self.passed += 1;
        Some((self.passed - 1) as f64 * self.period)
    }

    /// The time of the program in the last cycle (s); `None` before the axis is powered.
    pub(super) fn time(&self) -> Option<f64> {
        self.passed.checked_sub(1).map(|passed| passed as f64 * self.period)
    }

    /// Set-point at time `t` of the program (s), which must not decrease.
    pub(super) fn at(&mut self, t: f64) -> Setpoint {
        self.program.at(t)
    }

    /// Moves for the recording; they reach the axis `delay` (s) later.
    pub(super) fn moves(&self, delay: f64) -> impl Iterator<Item = Move> {
        let begun = self.waited as f64 * self.period + delay;
        self.program.moves().map(move |made| made.later(begun))
    }
}
