//! A run from the first tick to the last, and what it leaves behind.
use crate::bench::Bench;
use crate::channels::Instant;
use crate::closed_loop::Source;
use crate::stepper::External;
use servobench_base::Tick;
use servobench_plant::MechanicsError;
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
    /// What the program waited for in vain.
    #[error("{0}")]
    Program(String),
}

/// How often a run reports its progress, in ticks.
const PROGRESS_EVERY: u64 = 1 << 14;

impl Bench {
    /// Runs to the end; `progress` hears the share that is done, from 0 to 1.
    ///
    /// ```text
    /// tick k:  sample → set-point → control → power stage → record → integrate to k+1
    /// ```
    ///
    /// What is recorded together belongs to the same instant.
    #[must_use]
    pub fn run(mut self, progress: &mut dyn FnMut(f64)) -> Outcome {
        let (mut t, mut failure) = (0.0, None);
        for k in 0..self.ticks {
            t = self.closed_loop.base_rate.time(Tick(k));
            let mut now = self.closed_loop.tick(k, &External::default(), &mut self.recorder);
            self.watch.tick(t, now.binds, &mut self.recorder);
            self.record(&mut now);
            if k % PROGRESS_EVERY == 0 {
                progress(k as f64 / self.ticks as f64);
            }
            if k + 1 == self.ticks {
                break;
            }
            if let Err(reason) = self.closed_loop.integrate(&now) {
                failure = Some(Failure { time: t, reason });
                break;
            }
        }
        self.watch.finish(t, &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.closed_loop.source {
            let unit = self.recorder.about().axis_unit.clone();
            network.finish(t, &unit, *delay, &mut self.recorder);
        }
        progress(1.0);
        Outcome { recording: self.recorder.finish(), failure }
    }

    /// record(k), when a row is due.
    fn record(&mut self, now: &mut Instant) {
        if self.ticks_to_row == 0 {
            self.ticks_to_row = self.record_every;
            now.saturation = self.watch.shares();
            self.recorder.push(self.selection.pick(now));
        }
        self.ticks_to_row -= 1;
    }
}
