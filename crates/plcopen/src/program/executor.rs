//! Execution of a program.
use super::Call;
use super::condition::Situation;
use super::motion_tracker::Motion;
use super::running::{Fate, Overdue, RunningCall};
use crate::axis::Axis;
use crate::params::AxisParams;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use servobench_base::{Coordinate, ParamError, Setpoint, Stateful};
use servobench_fieldbus::{AxisCommand, AxisFeedback};

/// Receives the events of a program; calls and outputs are given by index.
pub trait Listener {
    /// From `t` (s) on Execute or Enable of `call` is `trigger`.
    fn on_trigger(&mut self, t: f64, call: usize, trigger: bool);

    /// From `t` (s) on `output` of `call` is `value`; TRUE is 1.
    fn on_output(&mut self, t: f64, call: usize, output: usize, value: f64);

    /// At `t` (s) `call` has an error.
    fn on_error(&mut self, t: f64, call: usize, message: &str);
}

/// The calls of a program, and the axis that they command.
#[derive(Debug, Stateful)]
pub struct Executor {
    axis: Axis,
    #[state(fixed)]
    calls: Vec<RunningCall>,
    #[state(constant)]
    names: Vec<String>,
    situation: Situation,
    motions: Vec<Motion>,
}

impl Executor {
    /// The program `calls` on a disabled axis; `motion` provides the unit of its positions, for messages.
    ///
    /// # Errors
    /// [`ParamError`] names the first parameter of the axis outside its bound.
    pub fn new(params: AxisParams, motion: Coordinate, calls: &[Call]) -> Result<Self, ParamError> {
        let rises = |call: &Call| call.block.outputs().iter().map(|output| (*output, None)).collect();
        Ok(Self {
            axis: Axis::new(params)?,
            calls: calls.iter().enumerate().map(|(index, call)| RunningCall::new(index, call, motion.unit())).collect(),
            names: calls.iter().map(|call| call.name.clone()).collect(),
            situation: Situation { t: 0.0, position: 0.0, rises: calls.iter().map(rises).collect() },
            motions: Vec::new(),
        })
    }

    /// The axis.
    #[must_use]
    pub const fn axis(&self) -> &Axis {
        &self.axis
    }

    /// Executes one cycle at `t` (s).
    ///
    /// # Errors
    /// [`Overdue`] if a call has waited longer than its timeout.
    pub fn cycle(
        &mut self,
        t: f64,
        feedback: &AxisFeedback,
        listener: &mut impl Listener,
    ) -> Result<AxisCommand, Overdue> {
        self.axis.begin(feedback);
        (self.situation.t, self.situation.position) = (t, self.axis.actual().position);
        for call in &mut self.calls {
            call.cycle(&mut self.situation, &self.names, &mut self.axis, listener)?;
        }
        Ok(self.axis.end())
    }

    /// Tracks the motions in a cycle with the set-point `commanded`.
    pub fn follow_motions(&mut self, t: f64, commanded: Setpoint) {
        for call in &mut self.calls {
            call.follow_motion(t, commanded, &mut self.motions);
        }
    }

    /// Ends the motions at `t` (s), and returns all of them by start time.
    pub fn end_motions(&mut self, t: f64, commanded: Setpoint) -> Vec<Motion> {
        for call in &mut self.calls {
            call.end_motion(t, commanded, &mut self.motions);
        }
        self.motions.sort_by(|one, other| one.start.total_cmp(&other.start));
        core::mem::take(&mut self.motions)
    }

    /// Result of each call so far, and true if the run may succeed without it.
    #[must_use]
    pub fn fates(&self) -> Vec<(Fate, bool)> {
        let mut idle: Vec<bool> = vec![false; self.calls.len()];
        // A call that waits for an idle one is idle too, and may stand before it: there are at most as many links as calls.
        for _ in 0..self.calls.len() {
            idle = self.calls.iter().map(|call| call.is_idle() && call.may_be_left_out(&idle)).collect();
        }
        let of = |call: &RunningCall| (call.fate(&self.situation, &self.names), call.is_optional(&idle));
        self.calls.iter().map(of).collect()
    }
}
