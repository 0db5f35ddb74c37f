//! One axis: its closed loop, what acts on it from outside, and what is recorded of it.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::alarm_watch::AlarmWatch;
use crate::closed_loop::{ClosedLoop, Source, State};
use crate::external::External;
use crate::joint_watch::JointWatch;
use crate::limit_watch::LimitWatch;
use crate::request_watch::RequestWatch;
use crate::run::Reason;
use servobench_base::Severity;
use servobench_plant::MechanicsError;
use servobench_signals::{Instant, PerLimit, Selection, write_row};
use servobench_trace::{Mark, Recorder, Recording};
use std::io;

/// Source of log lines of the mechanics: no engine but `fmu` writes any.
const MECHANICS: &str = "FMU of the axis";

/// A closed loop, its surroundings and its recording.
pub(crate) struct Axis {
    pub(crate) closed_loop: ClosedLoop,
    /// What acts on it in the tick under way.
    pub(crate) external: External,
    /// Before a tick: the bodies at that tick, everything else of the tick before. After `observe`: all of that tick.
    pub(crate) now: Instant,
    /// The channels that the scenario asks for.
    pub(crate) wanted: Selection,
    pub(crate) recorder: Recorder,
    /// Base ticks from row to row: one, unless the run is too long for that.
    record_every: u32,
    ticks_to_row: u32,
    limits: LimitWatch,
    joints: JointWatch,
    alarms: AlarmWatch,
    requests: RequestWatch,
}

/// An axis at a tick.
pub(crate) struct Saved {
    state: State,
    mechanics: Vec<u64>,
    external: External,
    now: Instant,
    ticks_to_row: u32,
    limits: LimitWatch,
    joints: JointWatch,
    alarms: AlarmWatch,
    requests: RequestWatch,
    mark: Mark,
}

/// An axis of which nothing is recorded, at a tick, with its mechanics.
pub(crate) struct Snapshot {
    state: State,
    mechanics: Vec<u64>,
    external: External,
    now: Instant,
}

impl Axis {
    /// The axis at tick 0. A row is recorded every `record_every` ticks.
    pub(crate) fn new(closed_loop: ClosedLoop, wanted: Selection, mut recorder: Recorder, record_every: u32) -> Self {
        let (external, mut now) = (External::default(), Instant::default());
        closed_loop.sample(&external, &mut now);
        let (limits, joints, alarms) = (LimitWatch::default(), JointWatch::default(), AlarmWatch::default());
        let requests = RequestWatch::new(&mut recorder);
        let ticks_to_row = 0;
        Self {
            closed_loop,
            external,
            now,
            wanted,
            recorder,
            record_every,
            ticks_to_row,
            limits,
            joints,
            alarms,
            requests,
        }
    }

    /// The same axis with nothing recorded of it.
    pub(crate) fn unrecorded(self) -> Self {
        let mut recorder = Recorder::silent(self.recorder.about().clone(), self.closed_loop.base_rate);
        let requests = RequestWatch::new(&mut recorder);
        Self { recorder, requests, record_every: 1, ticks_to_row: 0, ..self }
    }

    /// Tick `k`, which is at `time` (s), but for the mechanics: the loop, then its row. What is recorded together belongs to the same
    /// instant.
    #[inline(always)]
    pub(crate) fn observe(&mut self, k: u64, time: f64) {
        self.closed_loop.tick(k, &self.external, &mut self.recorder, &mut self.now);
        self.record(time);
    }

    #[inline(always)]
    fn record(&mut self, time: f64) {
        let now = &mut self.now;
        let (effort, speed) = (now.effort_reference, now.velocity_reference);
        let cut = PerLimit { voltage: now.voltage.q, current: effort, effort, speed, master: speed };
        self.limits.tick(time, &now.binds, cut, &mut self.recorder);
        self.alarms.tick(time, now.alarms, &mut self.recorder);
        self.requests.tick(time, now.request_kind, &mut self.recorder);
        self.joints.tick(time, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if self.ticks_to_row == 0 {
            self.ticks_to_row = self.record_every;
            now.saturation = self.limits.shares();
            self.recorder.push_with(|row| write_row(now, row));
        }
        self.ticks_to_row -= 1;
    }

    /// Moves the mechanics to the next tick.
    ///
    /// # Errors
    /// [`Reason`] why the loop cannot go on.
    #[inline(always)]
    pub(crate) fn integrate(&mut self) -> Result<(), Reason> {
        self.closed_loop.integrate(&self.external, &self.now)
    }

    /// Brings the bodies at the present tick to `now`.
    pub(crate) fn sample(&mut self) {
        self.closed_loop.sample(&self.external, &mut self.now);
    }

    /// Notes the log lines of the mechanics, `time` (s) being the present.
    pub(crate) fn note_log(&mut self, time: f64) {
        for line in self.closed_loop.mechanics.take_log() {
            self.note_log_line(time, MECHANICS, (line.severity, line.time), &line.text);
        }
    }

    /// Notes a log line of `source`, which says itself how severe it is and from when (s): never from after the present, `time` (s).
    pub(crate) fn note_log_line(&mut self, time: f64, source: &str, (severity, from): (Severity, f64), text: &str) {
        let from = if from.is_finite() { from.clamp(0.0, time) } else { time };
        self.recorder.note_said(source, severity, from, text);
    }

    /// Saves the state at the present tick, which is at `time` (s).
    ///
    /// # Errors
    /// [`MechanicsError`] where the engine cannot.
    pub(crate) fn save(&mut self, time: f64) -> Result<Saved, MechanicsError> {
        let mut mechanics = Vec::new();
        Ok(Saved {
            state: self.closed_loop.save(&mut mechanics)?,
            mechanics,
            external: self.external,
            now: self.now,
            ticks_to_row: self.ticks_to_row,
            limits: self.limits.clone(),
            joints: self.joints.clone(),
            alarms: self.alarms.clone(),
            requests: self.requests.clone(),
            mark: self.recorder.mark(time),
        })
    }

    /// Goes back to the last saved state; what was recorded since is forgotten.
    ///
    /// # Errors
    /// [`MechanicsError`] where the engine cannot.
    pub(crate) fn restore(&mut self, saved: &Saved) -> Result<(), MechanicsError> {
        self.closed_loop.restore(&saved.state, &saved.mechanics)?;
        (self.external, self.now, self.ticks_to_row) = (saved.external, saved.now, saved.ticks_to_row);
        self.limits.clone_from(&saved.limits);
        self.joints.clone_from(&saved.joints);
        self.alarms.clone_from(&saved.alarms);
        self.requests.clone_from(&saved.requests);
        self.recorder.rewind(&saved.mark);
        Ok(())
    }

    /// The state of an [unrecorded](Self::unrecorded) axis; `None` where the engine cannot save its mechanics.
    pub(crate) fn snapshot(&mut self) -> Option<Snapshot> {
        let mut mechanics = Vec::new();
        let state = self.closed_loop.save(&mut mechanics).ok()?;
        Some(Snapshot { state, mechanics, external: self.external, now: self.now })
    }

    /// Goes back to a snapshot. Whether the engine could.
    pub(crate) fn go_back(&mut self, snapshot: &Snapshot) -> bool {
        if self.closed_loop.restore(&snapshot.state, &snapshot.mechanics).is_err() {
            return false;
        }
        (self.external, self.now) = (snapshot.external, snapshot.now);
        true
    }

    /// Ends the mechanics at `present` (s) and gives the recording, which ends at `end` (s); and why it is not all, if it is not.
    pub(crate) fn finish(mut self, present: f64, end: f64) -> (Recording, Option<io::Error>) {
        self.closed_loop.mechanics.end();
        self.note_log(present);
        self.limits.finish(end, &mut self.recorder);
        self.alarms.finish(end, &mut self.recorder);
        self.joints.finish(end, self.closed_loop.mechanics.joint_limits(), &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.closed_loop.state.source {
            network.finish(end, *delay, &mut self.recorder);
        }
        self.recorder.finish()
    }
}
