//! One axis: its closed loop, external influences, and its recording.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::alarm_watch::AlarmWatch;
use crate::closed_loop::{ClosedLoop, Source};
use crate::external::External;
use crate::joint_watch::JointWatch;
use crate::limit_watch::LimitWatch;
use crate::request_watch::RequestWatch;
use crate::run::Reason;
use servobench_base::state::{Reader, Writer, words};
use servobench_base::{Severity, Stateful};
use servobench_plant::MechanicsError;
use servobench_signals::{Instant, PerLimit, Selection, write_row};
use servobench_trace::{Mark, Recorder, Recording};
use std::io;

/// Source of log lines of the mechanics: no engine but `fmu` writes any.
const MECHANICS: &str = "FMU of the axis";

/// A closed loop, its surroundings and its recording.
pub(crate) struct Axis {
    pub(crate) closed_loop: ClosedLoop,
    /// External influences in the current tick.
    pub(crate) external: External,
    /// Before a tick: the bodies at that tick, everything else of the previous tick. After `observe`: all of that tick.
    pub(crate) now: Instant,
    /// The channels that the scenario records.
    pub(crate) wanted: Selection,
    pub(crate) recorder: Recorder,
    /// Base ticks from row to row: one, unless the run is too long for that.
    record_every: u32,
    watches: Watches,
}

/// State of an axis at a tick, and the length of its recording.
pub(crate) struct Saved {
    words: Vec<u64>,
    mark: Mark,
}

/// Watches whose changes are recorded, and the ticks until the next row.
#[derive(Stateful)]
#[state(fixed)]
struct Watches {
    ticks_to_row: u32,
    limits: LimitWatch,
    joints: JointWatch,
    alarms: AlarmWatch,
    requests: RequestWatch,
}

impl Watches {
    fn new(recorder: &mut Recorder) -> Self {
        Self {
            ticks_to_row: 0,
            limits: LimitWatch::default(),
            joints: JointWatch::default(),
            alarms: AlarmWatch::default(),
            requests: RequestWatch::new(recorder),
        }
    }
}

impl Axis {
    /// The axis at tick 0. A row is recorded every `record_every` ticks.
    pub(crate) fn new(closed_loop: ClosedLoop, wanted: Selection, mut recorder: Recorder, record_every: u32) -> Self {
        let (external, mut now) = (External::default(), Instant::default());
        closed_loop.sample(&external, &mut now);
        let watches = Watches::new(&mut recorder);
        Self { closed_loop, external, now, wanted, recorder, record_every, watches }
    }

    /// The same axis without a recording.
    pub(crate) fn unrecorded(self) -> Self {
        let mut recorder = Recorder::silent(self.recorder.about().clone(), self.closed_loop.base_rate);
        let watches = Watches::new(&mut recorder);
        Self { recorder, watches, record_every: 1, ..self }
    }

    /// Tick `k`, at `time` (s), without the mechanics: the loop, then its row. All values of a row belong to the same instant.
    #[inline(always)]
    pub(crate) fn observe(&mut self, k: u64, time: f64) {
        self.closed_loop.tick(k, &self.external, &mut self.recorder, &mut self.now);
        self.record(time);
    }

    #[inline(always)]
    fn record(&mut self, time: f64) {
        let Watches { ticks_to_row, limits, joints, alarms, requests } = &mut self.watches;
        let now = &mut self.now;
        let (effort, speed) = (now.effort_reference, now.velocity_reference);
        let cut = PerLimit { voltage: now.voltage.q, current: effort, effort, speed, master: speed };
        limits.tick(time, &now.binds, cut, &mut self.recorder);
        alarms.tick(time, now.alarms, &mut self.recorder);
        requests.tick(time, now.request_kind, &mut self.recorder);
        joints.tick(time, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if *ticks_to_row == 0 {
            *ticks_to_row = self.record_every;
            now.saturation = limits.shares();
            self.recorder.push_with(|row| write_row(now, row));
        }
        *ticks_to_row -= 1;
    }

    /// Advances the mechanics to the next tick.
    ///
    /// # Errors
    /// [`Reason`] why the loop cannot continue.
    #[inline(always)]
    pub(crate) fn integrate(&mut self) -> Result<(), Reason> {
        self.closed_loop.integrate(&self.external, &self.now)
    }

    /// Writes the bodies at the current tick to `now`.
    pub(crate) fn sample(&mut self) {
        self.closed_loop.sample(&self.external, &mut self.now);
    }

    /// Records the log lines of the mechanics, at the current `time` (s).
    pub(crate) fn note_log(&mut self, time: f64) {
        for line in self.closed_loop.mechanics.take_log() {
            self.note_log_line(time, MECHANICS, (line.severity, line.time), &line.text);
        }
    }

    /// Records a log line of `source` with its own severity and start (s), which is clamped to the current `time` (s).
    pub(crate) fn note_log_line(&mut self, time: f64, source: &str, (severity, from): (Severity, f64), text: &str) {
        let from = if from.is_finite() { from.clamp(0.0, time) } else { time };
        self.recorder.note_said(source, severity, from, text);
    }

    /// Writes the state of the axis at the current tick.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot save its state.
    pub(crate) fn save(&mut self, to: &mut dyn Writer) -> Result<(), MechanicsError> {
        self.closed_loop.save(to)?;
        self.external.save(to);
        self.now.save(to);
        self.watches.save(to);
        Ok(())
    }

    /// Restores the state that [`save`](Self::save) wrote for an axis of the same scenario.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot restore it, or the numbers are not a state of this axis.
    pub(crate) fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), MechanicsError> {
        self.closed_loop.restore(from)?;
        self.external.restore(from)?;
        self.now.restore(from)?;
        Ok(self.watches.restore(from)?)
    }

    /// State of the axis and its recording at the current tick, which is at `time` (s).
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot save its state.
    pub(crate) fn save_recorded(&mut self, time: f64) -> Result<Saved, MechanicsError> {
        let mut all = Vec::new();
        self.save(&mut words(|word| all.push(word)))?;
        Ok(Saved { words: all, mark: self.recorder.mark(time) })
    }

    /// Restores `saved` and discards everything recorded since.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot restore it.
    pub(crate) fn restore_recorded(&mut self, saved: &Saved) -> Result<(), MechanicsError> {
        let mut from = Reader::new(&saved.words);
        self.restore(&mut from)?;
        from.end()?;
        self.recorder.rewind(&saved.mark);
        Ok(())
    }

    /// Ends the mechanics at `present` (s). Returns the recording, which ends at `end` (s), and the error if it is incomplete.
    pub(crate) fn finish(mut self, present: f64, end: f64) -> (Recording, Option<io::Error>) {
        self.closed_loop.mechanics.end();
        self.note_log(present);
        self.watches.limits.finish(end, &mut self.recorder);
        self.watches.alarms.finish(end, &mut self.recorder);
        self.watches.joints.finish(end, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.closed_loop.state.source {
            network.finish(end, *delay, &mut self.recorder);
        }
        self.recorder.finish()
    }
}
