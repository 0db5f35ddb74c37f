//! Several axes at one time, each with its own program, drive and mechanics.
use crate::axis::Axis;
use crate::bench::{Bench, Loop};
use crate::machine::Machine;
use crate::run::{AxisFailure, Failure};
use servobench_base::Rate;
use servobench_trace::Recording;
use std::ops::ControlFlow;

/// Several axes at one time. All of them are sampled and controlled before the first one moves.
pub struct MultiAxisBench {
    ticks: u64,
    machine: Machine<Vec<Axis>>,
}

/// What a run of several axes leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub struct MultiAxisOutcome {
    /// Of each axis, in their order, up to the end or to the failure.
    pub recordings: Vec<Recording>,
    /// Which axis ended the run early, and why.
    pub failure: Option<AxisFailure>,
}

/// Why axes cannot run at one time. Axes count from 1 in the messages.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotAtOneTime {
    /// There is no axis.
    #[error("there is no axis; give at least one")]
    NoAxis,
    /// Base rates differ.
    #[error(
        "axis {} has a base rate of {} Hz, axis 1 one of {} Hz; give all axes the same `run.base_rate`",
        axis + 1, rate.hertz(), first.hertz()
    )]
    BaseRate {
        /// Whose rate is another one.
        axis: usize,
        /// It.
        rate: Rate,
        /// That of the first axis.
        first: Rate,
    },
    /// An axis has FMUs beside it.
    #[error("axis {} has FMUs beside it, which exchange at times of their own; run it alone", axis + 1)]
    Fmus {
        /// Which one.
        axis: usize,
    },
}

impl MultiAxisBench {
    /// All `axes` at tick 0. The run lasts as long as that of the axis that takes longest.
    ///
    /// # Errors
    /// [`NotAtOneTime`] names the axis that does not fit the first one.
    pub fn new(axes: Vec<Bench>) -> Result<Self, NotAtOneTime> {
        let ticks = axes.iter().map(|bench| bench.ticks).max().ok_or(NotAtOneTime::NoAxis)?;
        let (mut together, mut base_rate) = (Vec::with_capacity(axes.len()), None);
        for (axis, bench) in axes.into_iter().enumerate() {
            let Loop::Alone(machine) = bench.closed_loop else { return Err(NotAtOneTime::Fmus { axis }) };
            let rate = machine.base_rate();
            let first = *base_rate.get_or_insert(rate);
            if rate != first {
                return Err(NotAtOneTime::BaseRate { axis, rate, first });
            }
            together.extend(machine.axes);
        }
        let base_rate = base_rate.ok_or(NotAtOneTime::NoAxis)?;
        Ok(Self { ticks, machine: Machine::new(together, base_rate) })
    }

    /// Runs to the end; `progress` is told the share that is done, from 0 to 1.
    #[must_use]
    pub fn run(mut self, progress: &mut dyn FnMut(f64)) -> MultiAxisOutcome {
        let failure = self
            .machine
            .run(self.ticks, &mut |share| {
                progress(share);
                ControlFlow::Continue(())
            })
            .err();
        let (present, end) = self.machine.ends(failure.as_ref().map(|axis| &axis.failure));
        let (mut recordings, mut failure) = (Vec::with_capacity(self.machine.axes.len()), failure);
        for (index, axis) in self.machine.axes.into_iter().enumerate() {
            let (recording, missing) = axis.finish(present, end);
            let lost = |error: &_| Failure::not_kept(recording.time_of(recording.len()), error);
            failure = failure.or_else(|| Some(AxisFailure { axis: index, failure: lost(missing.as_ref()?) }));
            recordings.push(recording);
        }
        MultiAxisOutcome { recordings, failure }
    }
}
