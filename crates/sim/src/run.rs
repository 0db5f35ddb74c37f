//! A run from the first tick to the last, and what it leaves behind.
use crate::bench::{Bench, Loop};
use servobench_metrics::MEASURED_FROM;
use servobench_plant::MechanicsError;
use servobench_trace::Recording;
use std::io;
use std::ops::ControlFlow;

/// What a run leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Everything up to the end, or up to the failure: every tick, whatever `record.rate` says ([`thinned`](crate::thinned)),
    /// unless that would be more than a recording may have.
    pub recording: Recording,
    /// Why the run ended early.
    pub failure: Option<Failure>,
}

/// Why a run ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("at {time} s: {reason}")]
pub struct Failure {
    /// When (s).
    pub time: f64,
    /// Why.
    pub reason: Reason,
}

/// What ended a run early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Reason {
    /// What the engine says.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// What the coupling with FMUs says.
    #[error("{0}")]
    Coupling(String),
    /// What the program waited for in vain.
    #[error("{0}")]
    Program(String),
    /// The disk, which takes no more of the recording.
    #[error("the recording cannot be kept: {0}")]
    Recording(String),
    /// Whoever follows its progress.
    #[error("the run was told to stop")]
    Stopped,
}

impl Failure {
    /// The recording cannot be kept from `time` (s) on.
    pub(crate) fn not_kept(time: f64, error: &io::Error) -> Self {
        Self { time, reason: Reason::Recording(error.to_string()) }
    }
}

impl Bench {
    /// The same, but only signals that metrics are made of are recorded: for a run of which nothing else is wanted. With FMUs attached
    /// everything is.
    #[must_use]
    pub fn only_to_measure(mut self) -> Self {
        if let Loop::Alone(machine) = &mut self.closed_loop {
            machine.axis.recorder.retain(|spec| MEASURED_FROM.iter().any(|signal| signal.name() == spec.name));
        }
        self
    }

    /// Runs to the end; `progress` is told the share that is done, from 0 to 1.
    #[must_use]
    pub fn run(self, progress: &mut dyn FnMut(f64)) -> Outcome {
        self.run_while(&mut |share| {
            progress(share);
            ControlFlow::Continue(())
        })
    }

    /// The same; a break of `progress`, which is told every thousand ticks or so and after every exchange with FMUs, is a failure:
    /// [`Reason::Stopped`].
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
