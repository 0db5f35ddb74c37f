//! The closed loop with what is recorded of it.
use crate::closed_loop::{ClosedLoop, Source, State};
use crate::joint_watch::JointWatch;
use crate::limit_watch::LimitWatch;
use crate::run::{Failure, Outcome};
use crate::stepper::External;
use servobench_base::{Severity, Tick};
use servobench_plant::MechanicsError;
use servobench_signals::{Instant, PerLimit, Selection, write_row};
use servobench_trace::{Mark, Recorder};

/// Who speaks where mechanics do: no engine but `fmu` has anything to say.
const MECHANICS: &str = "FMU of the axis";

/// Ticks, or exchanges, from one time that an FMU is listened to to the next. What it logs has its time with it; to listen costs calls of
/// the operating system.
pub(crate) const LISTEN_EVERY: u64 = 64;

/// A closed loop that is recorded tick by tick.
pub(crate) struct Recorded {
    pub(crate) closed_loop: ClosedLoop,
    /// The channels that the scenario asks for.
    pub(crate) wanted: Selection,
    pub(crate) recorder: Recorder,
    /// Base ticks from row to row, and to the next one. One, unless the run is too long for that.
    pub(crate) record_every: u32,
    pub(crate) ticks_to_row: u32,
    pub(crate) watch: LimitWatch,
    pub(crate) joints: JointWatch,
    /// The tick that comes next.
    pub(crate) tick: u64,
}

/// Where a recorded loop was at the last mark, the mechanics apart.
pub(crate) struct Saved {
    state: State,
    ticks_to_row: u32,
    watch: LimitWatch,
    joints: JointWatch,
    tick: u64,
    mark: Mark,
}

impl Recorded {
    /// Tick k, recorded, but for the mechanics' way to k+1; it is left in `now`. What is recorded together belongs to the
    /// same instant.
    pub(crate) fn observe(&mut self, external: &External, now: &mut Instant) {
        self.closed_loop.tick(self.tick, external, &mut self.recorder, now);
        let cut = PerLimit { voltage: now.voltage.q, current: now.effort_reference, effort: now.effort_reference };
        let t = self.time();
        self.watch.tick(t, now.binds, cut, &mut self.recorder);
        self.joints.tick(t, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if self.ticks_to_row == 0 {
            self.ticks_to_row = self.record_every;
            now.saturation = self.watch.shares();
            self.recorder.push_with(|row| write_row(now, row));
        }
        self.ticks_to_row -= 1;
    }

    /// The way to k+1.
    ///
    /// # Errors
    /// [`Failure`] says why the loop cannot go on.
    pub(crate) fn go_on(&mut self, now: &Instant) -> Result<(), Failure> {
        let time = self.time();
        self.closed_loop.integrate(now).map_err(|reason| Failure { time, reason })?;
        self.tick += 1;
        if self.tick.is_multiple_of(LISTEN_EVERY) {
            self.hear_mechanics();
        }
        Ok(())
    }

    /// Notes what the mechanics have said.
    fn hear_mechanics(&mut self) {
        for said in self.closed_loop.mechanics.take_log() {
            self.note_said(MECHANICS, said.severity, said.time, &said.text);
        }
    }

    /// Notes what `source` said at `time` (s), which is its own word: nothing is said after the present.
    pub(crate) fn note_said(&mut self, source: &str, severity: Severity, time: f64, text: &str) {
        let now = self.time();
        let time = if time.is_finite() { time.clamp(0.0, now) } else { now };
        self.recorder.note_said(source, severity, time, text);
    }

    /// The time of the tick that comes next (s).
    pub(crate) fn time(&self) -> f64 {
        self.closed_loop.base_rate.time(Tick(self.tick))
    }

    /// Marks where the loop is.
    ///
    /// # Errors
    /// [`MechanicsError`] where the engine cannot.
    pub(crate) fn save(&mut self) -> Result<Saved, MechanicsError> {
        Ok(Saved {
            state: self.closed_loop.mark()?,
            ticks_to_row: self.ticks_to_row,
            watch: self.watch.clone(),
            joints: self.joints.clone(),
            tick: self.tick,
            mark: self.recorder.mark(self.time()),
        })
    }

    /// Goes back to the last mark; what was recorded since is forgotten.
    ///
    /// # Errors
    /// [`MechanicsError`] where the engine cannot.
    pub(crate) fn restore(&mut self, saved: &Saved) -> Result<(), MechanicsError> {
        self.closed_loop.rewind(&saved.state)?;
        self.watch.clone_from(&saved.watch);
        self.joints.clone_from(&saved.joints);
        (self.ticks_to_row, self.tick) = (saved.ticks_to_row, saved.tick);
        self.recorder.rewind(&saved.mark);
        Ok(())
    }

    /// What the run leaves behind.
    pub(crate) fn finish(mut self, failure: Option<Failure>) -> Outcome {
        self.closed_loop.mechanics.end();
        self.hear_mechanics();
        let t = failure.as_ref().map_or_else(|| self.time(), |failure| failure.time);
        self.watch.finish(t, &mut self.recorder);
        self.joints.finish(t, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.closed_loop.state.source {
            let unit = self.recorder.about().axis_unit.clone();
            network.finish(t, &unit, *delay, &mut self.recorder);
        }
        Outcome { recording: self.recorder.finish(), failure }
    }
}
