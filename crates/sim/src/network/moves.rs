//! The moves of a program as a motion task gives them: one set-point per cycle, from the moment on at which the axis is powered.
use crate::program::Program;
use servobench_base::Setpoint;
use servobench_fieldbus::{AxisCommand, AxisFeedback, Power, Task};
use servobench_motion::interpolate::Sample;
use servobench_trace::Move;

/// A program of moves under way.
#[derive(Debug, Clone)]
pub(super) struct Moves {
    program: Program,
    /// Cycle of the motion task (s).
    period: f64,
    /// Cycles before the axis was powered, and since then.
    waited: u64,
    passed: u64,
}

impl Moves {
    pub(super) const fn new(program: Program, period: f64) -> Self {
        Self { program, period, waited: 0, passed: 0 }
    }

    /// One cycle: the command and the set-point in it, which `sample` makes fit for the axis.
    pub(super) fn cycle(
        &mut self,
        feedback: &AxisFeedback,
        sample: impl Fn(Setpoint) -> Sample,
    ) -> (AxisCommand, Setpoint) {
        let is_moving = self.passed > 0 || feedback.power == Power::On;
        let setpoint = self.program.at(self.passed as f64 * self.period);
        if is_moving {
            self.passed += 1;
        } else {
            self.waited += 1;
        }
        (AxisCommand { power: true, reset: false, task: Task::Follow(sample(setpoint)) }, setpoint)
    }

    /// What a recording says of the moves; they reach the axis `delay` (s) later.
    pub(super) fn moves(&self, unit: &str, delay: f64) -> impl Iterator<Item = Move> {
        let begun = self.waited as f64 * self.period + delay;
        self.program.moves(unit).map(move |made| Move {
            start: made.start + begun,
            end: made.end + begun,
            cruise: (made.cruise.0 + begun, made.cruise.1),
            ..made
        })
    }
}
