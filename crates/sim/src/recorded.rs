//! The closed loop with what is recorded of it.
use crate::channels::{Instant, Selection};
use crate::closed_loop::{ClosedLoop, Source};
use crate::limit_watch::LimitWatch;
use crate::run::{Failure, Outcome};
use crate::stepper::External;
use servobench_base::Tick;
use servobench_trace::{Mark, Recorder};

/// A closed loop that is recorded tick by tick.
pub(crate) struct Recorded {
    pub(crate) closed_loop: ClosedLoop,
    pub(crate) selection: Selection,
    pub(crate) recorder: Recorder,
    /// Base ticks from row to row, and to the next one. One, unless the run is too long for that.
    pub(crate) record_every: u32,
    pub(crate) ticks_to_row: u32,
    pub(crate) watch: LimitWatch,
    /// The tick that comes next.
    pub(crate) tick: u64,
}

/// Where a recorded loop was, to go back to.
pub(crate) struct Saved {
    closed_loop: ClosedLoop,
    ticks_to_row: u32,
    watch: LimitWatch,
    tick: u64,
    mark: Mark,
}

impl Recorded {
    /// Tick k, recorded, but for the mechanics' way to k+1. What is recorded together belongs to the same instant.
    pub(crate) fn observe(&mut self, external: &External) -> Instant {
        let mut now = self.closed_loop.tick(self.tick, external, &mut self.recorder);
        self.watch.tick(self.time(), now.binds, &mut self.recorder);
        if self.ticks_to_row == 0 {
            self.ticks_to_row = self.record_every;
            now.saturation = self.watch.shares();
            self.recorder.push(self.selection.pick(&now));
        }
        self.ticks_to_row -= 1;
        now
    }

    /// The way to k+1.
    ///
    /// # Errors
    /// [`Failure`] says why the loop cannot go on.
    pub(crate) fn go_on(&mut self, now: &Instant) -> Result<(), Failure> {
        let time = self.time();
        self.closed_loop.integrate(now).map_err(|reason| Failure { time, reason })?;
        self.tick += 1;
        Ok(())
    }

    /// The time of the tick that comes next (s).
    pub(crate) fn time(&self) -> f64 {
        self.closed_loop.base_rate.time(Tick(self.tick))
    }

    /// Where the loop is; `None` where the engine cannot copy its mechanics.
    pub(crate) fn save(&self) -> Option<Saved> {
        Some(Saved {
            closed_loop: self.closed_loop.copy()?,
            ticks_to_row: self.ticks_to_row,
            watch: self.watch.clone(),
            tick: self.tick,
            mark: self.recorder.mark(self.time()),
        })
    }

    /// Goes back; what was recorded since is forgotten.
    pub(crate) fn restore(&mut self, saved: &Saved) {
        if let Some(closed_loop) = saved.closed_loop.copy() {
            self.closed_loop = closed_loop;
            (self.ticks_to_row, self.watch, self.tick) = (saved.ticks_to_row, saved.watch.clone(), saved.tick);
            self.recorder.rewind(&saved.mark);
        }
    }

    /// What the run leaves behind.
    pub(crate) fn finish(mut self, failure: Option<Failure>) -> Outcome {
        let t = failure.as_ref().map_or_else(|| self.time(), |failure| failure.time);
        self.watch.finish(t, &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.closed_loop.source {
            let unit = self.recorder.about().axis_unit.clone();
            network.finish(t, &unit, *delay, &mut self.recorder);
        }
        Outcome { recording: self.recorder.finish(), failure }
    }
}
