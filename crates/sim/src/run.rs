//! A run from the first tick to the last, and what it leaves behind.
use crate::bench::{Axis, Bench};
use crate::stepper::External;
use servobench_plant::MechanicsError;
use servobench_signals::Instant;
use servobench_trace::Recording;

/// What a run leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Everything up to the end, or up to the failure: every tick, whatever `record.rate` says ([`thinned`](crate::thinned)),
    /// unless that would not fit in memory.
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
}

/// How often a run reports its progress, in ticks.
pub(crate) const PROGRESS_EVERY: u64 = 1 << 14;

impl Bench {
    /// Runs to the end; `progress` hears the share that is done, from 0 to 1.
    ///
    /// ```text
    /// tick k:  sample → set-point → control → power stage → record → integrate to k+1
    /// ```
    #[must_use]
    pub fn run(self, progress: &mut dyn FnMut(f64)) -> Outcome {
        let Self { axis, ticks } = self;
        let mut recorded = match axis {
            Axis::Coupled(coupled) => return coupled.run(ticks, progress),
            Axis::Alone(recorded) => *recorded,
        };
        let (external, mut now, mut failure) = (External::default(), Instant::default(), None);
        loop {
            recorded.observe(&external, &mut now);
            if recorded.tick.is_multiple_of(PROGRESS_EVERY) {
                progress(recorded.tick as f64 / ticks as f64);
            }
            if recorded.tick + 1 == ticks {
                break;
            }
            if let Err(why) = recorded.go_on(&now) {
                failure = Some(why);
                break;
            }
        }
        progress(1.0);
        recorded.finish(failure)
    }
}
