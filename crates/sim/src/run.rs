//! A run from the first tick to the last, and its outcome.
use crate::bench::{Bench, Loop};
use servobench_metrics::MEASURED_FROM;
use servobench_plant::MechanicsError;
use servobench_trace::Recording;
use std::io;
use std::ops::ControlFlow;

/// Outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Recording up to the end, or up to the failure: every tick, whatever `record.rate` is ([`thinned`](crate::thinned)),
    /// unless that would exceed the largest size of a recording.
    pub recording: Recording,
    /// Reason for an early end of the run.
    pub failure: Option<Failure>,
}

/// An early end of a run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("at {time} s: {reason}")]
pub struct Failure {
    /// Time (s).
    pub time: f64,
    /// Reason.
    pub reason: Reason,
}

/// Reasons for an early end of a run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Reason {
    /// Error of the engine.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// Error of the coupling with FMUs.
    #[error("{0}")]
    Coupling(String),
    /// Condition that the program waited for in vain.
    #[error("{0}")]
    Program(String),
    /// Error of the disk, which takes no more of the recording.
    #[error("the recording cannot be kept: {0}")]
    Recording(String),
    /// Stopped by the caller through the progress callback.
    #[error("the run was told to stop")]
    Stopped,
}

impl Failure {
    /// The recording is incomplete from `time` (s) on.
    pub(crate) fn not_kept(time: f64, error: &io::Error) -> Self {
        Self { time, reason: Reason::Recording(error.to_string()) }
    }
}

impl Bench {
    /// Records only the signals needed for metrics: for a run of which nothing else is used. With FMUs attached everything is
    /// recorded.
    #[must_use]
    pub fn only_to_measure(mut self) -> Self {
        if let Loop::Alone(machine) = &mut self.closed_loop {
            machine.axis.recorder.retain(|spec| MEASURED_FROM.iter().any(|signal| signal.name() == spec.name));
        }
        self
    }

    /// Runs to the end; `progress` gets the completed share, from 0 to 1.
    #[must_use]
    pub fn run(self, progress: &mut dyn FnMut(f64)) -> Outcome {
        self.run_while(&mut |share| {
            progress(share);
            ControlFlow::Continue(())
        })
    }

    /// Runs to the end, or until `progress` breaks, which is the failure [`Reason::Stopped`]. It is called about every thousand ticks,
    /// and after every exchange with FMUs.
    #[must_use]
    pub fn run_while(self, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Outcome {
        match self.closed_loop {
            Loop::Coupled(coupled) => coupled.run(self.ticks, progress),
            Loop::Alone(mut machine) => {
                let failure = machine.run(self.ticks, progress).err();
                machine.finish(failure)
            }
        }
    }
}
