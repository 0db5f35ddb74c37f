//! A finished recording.
use crate::channel::Channel;
use crate::log::LogEntry;
use crate::number;
#[cfg(doc)]
use crate::values::Values;
use serde::{Deserialize, Serialize};
use servobench_base::{AxisName, Ending, Rate, Tick};

/// Description of a recorded run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct About {
    /// Name of the scenario.
    pub scenario: String,
    /// Engine that computed the mechanics.
    pub engine: String,
    /// Unit of positions on the axis: `m` or `rad`.
    pub axis_unit: String,
    /// Names of the bodies, the motor first, the load last; one name when motor and load are one.
    pub bodies: Vec<String>,
    /// Keys of the scenario with other values than in its file, and these values: `setpoint.jerk=200 m/s3`.
    pub overrides: Vec<String>,
}

impl About {
    /// ` with setpoint.jerk=200 m/s3`; empty if every key has the value of the file.
    #[must_use]
    pub fn overridden(&self) -> String {
        if self.overrides.is_empty() { String::new() } else { format!(" with {}", self.overrides.join(", ")) }
    }
}

/// ` (axis x)`, as titles and tables write it behind the name of a scenario; empty if the axis has no name.
#[must_use]
pub fn of_axis(axis: Option<AxisName>) -> String {
    axis.map_or_else(String::new, |axis| format!(" (axis {axis})"))
}

/// One move of the program, as planned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Move {
    /// Description, in words: `move to 1 m, order 4`.
    pub label: String,
    /// Start of the profile (s).
    #[serde(with = "number")]
    pub start: f64,
    /// End of the profile (s).
    #[serde(with = "number")]
    pub end: f64,
    /// Position at the start (axis unit).
    #[serde(with = "number")]
    pub from: f64,
    /// Target (axis unit).
    #[serde(with = "number")]
    pub to: f64,
    /// Largest |velocity|, |acceleration|, |jerk|, |snap| of the profile, analytic (axis unit and s). Snap is infinite
    /// in a jerk-limited profile, jerk too in an acceleration-limited one.
    #[serde(with = "number")]
    pub peaks: [f64; 4],
    /// The limits of its plan; `None` for those that its order lacks.
    #[serde(with = "number")]
    pub limits: [Option<f64>; 4],
    /// Start and length (s) of the part at constant velocity; length 0 without one.
    #[serde(with = "number")]
    pub cruise: (f64, f64),
    /// Its ending.
    #[serde(default, skip_serializing_if = "is_at_rest")]
    pub ending: Ending,
}

impl Move {
    /// The same move, later by `time` (s).
    #[must_use]
    pub fn later(self, time: f64) -> Self {
        let (begin, length) = self.cruise;
        Self { start: self.start + time, end: self.end + time, cruise: (begin + time, length), ..self }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks by reference")]
fn is_at_rest(ending: &Ending) -> bool {
    *ending == Ending::AtRest
}

/// A call of a function block, and its fate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Call {
    /// Name of the instance.
    pub name: String,
    /// Name of the block in the standard: `MC_MoveAbsolute`.
    pub block: String,
    /// True if the run may do without it: it is marked so, or waits in vain for an error or abortion of another call.
    #[serde(default, rename = "optional", skip_serializing_if = "std::ops::Not::not")]
    pub is_optional: bool,
    /// Its fate by the end of the run.
    pub fate: CallFate,
}

/// Fate of a call by the end of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum CallFate {
    /// Never executed; the awaited event, in words.
    NeverExecuted(String),
    /// Executed: it reached its purpose, or another command took over from it.
    Executed,
    /// Executed, but not finished by the end of the run: the reason, in words.
    Unfinished(String),
    /// Ended in `Error`.
    Failed {
        /// Time (s).
        #[serde(with = "number")]
        time: f64,
        /// `ErrorID`.
        id: u32,
        /// The error, in words.
        message: String,
    },
}

/// Error of the coupling with FMUs, estimated by the master from the exchanged values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingEstimate {
    /// Error of an input within a step, relative to the change of its signal.
    #[serde(with = "number")]
    pub error: f64,
    /// The connection with the largest error, as `from -> to`.
    pub connection: String,
}

/// Alternation of a limited quantity between its limits: the mark of a loop that oscillates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitReversals {
    /// The limit: `effort limit`.
    pub limit: String,
    /// The times (s) at which the quantity was cut at the limit opposite to the one that cut it last; the first
    /// [`MOST`](Self::MOST) of them.
    #[serde(with = "number")]
    pub times: Vec<f64>,
}

impl LimitReversals {
    /// Maximum number of times that are kept.
    pub const MOST: usize = 10_000;
}

/// An event of interest to the user.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// Start (s).
    #[serde(with = "number")]
    pub start: f64,
    /// End (s); equal to `start` for an instant.
    #[serde(with = "number")]
    pub end: f64,
    /// Stage of the loop that detected it.
    pub source: String,
    /// The event, in words.
    pub message: String,
    /// The limit that bound from `start` to `end`, if the event is that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<BoundLimit>,
    /// The incident, if it is one that a scenario can expect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub incident: Option<IncidentMark>,
}

/// An incident of a fixed list.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IncidentMark {
    /// Name in the list: `end_stop`.
    pub name: String,
    /// Reason why it does no harm, if it does none: `in homing`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excuse: Option<String>,
    /// Number of things that it concerns, if they are counted: frames, cycles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
}

/// A limit of the machine that bound.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundLimit {
    /// The limit: `effort limit`.
    pub name: String,
    /// True if it may have bound again without being noted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_last_noted: bool,
}

impl Event {
    /// An event from `start` to `end` (s).
    #[must_use]
    pub fn new(start: f64, end: f64, source: impl Into<String>, message: impl Into<String>) -> Self {
        Self { start, end, source: source.into(), message: message.into(), limit: None, incident: None }
    }

    /// The same event as the incident `name`.
    #[must_use]
    pub fn incident(mut self, name: &str) -> Self {
        self.incident = Some(IncidentMark { name: name.into(), excuse: None, count: None });
        self
    }

    /// The limit `name` bound from `start` to `end` (s).
    #[must_use]
    pub fn bound(start: f64, end: f64, source: impl Into<String>, name: &str, is_last_noted: bool) -> Self {
        let limit = Some(BoundLimit { name: name.into(), is_last_noted });
        Self { limit, ..Self::new(start, end, source, format!("{name} binds{}", Self::noted(is_last_noted))) }
    }

    /// End of the message of the last noted event of its kind.
    #[must_use]
    pub const fn noted(is_last: bool) -> &'static str {
        if is_last { "; later ones are not listed" } else { "" }
    }
}

/// A signal that has one value out of a few and changes now and then: a state, an output of a function block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// Its source: `drive`, `axis`, the name of a function block.
    pub source: String,
    /// Its name: `state`, `Done`.
    pub name: String,
    /// Start (s) of each value, in order of time; no two neighbours are equal.
    #[serde(with = "number")]
    pub changes: Vec<(f64, String)>,
}

impl Signal {
    /// The value at `time` (s); `None` before the first.
    #[must_use]
    pub fn at(&self, time: f64) -> Option<&str> {
        let later = self.changes.partition_point(|(since, _)| *since <= time);
        later.checked_sub(1).map(|index| self.changes[index].1.as_str())
    }
}

/// Channels of equal length, sampled together; moves; events; signals; calls; log.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Description of the run.
    pub about: About,
    /// Rate of the recorded instants; instant k is at k/rate.
    pub rate: Rate,
    /// The channels.
    pub channels: Vec<Channel>,
    /// The moves in order of their start.
    pub moves: Vec<Move>,
    /// The events in order of their start.
    pub events: Vec<Event>,
    /// The signals, those of one source together.
    pub signals: Vec<Signal>,
    /// The calls of function blocks, in the order of the program.
    pub calls: Vec<Call>,
    /// Limits between which a quantity alternated.
    pub limit_reversals: Vec<LimitReversals>,
    /// Log messages of the parts of the run, in order of time.
    pub log: Vec<LogEntry>,
    /// Error of the coupling with FMUs; `None` if no continuous signal is exchanged with one.
    pub coupling: Option<CouplingEstimate>,
}

impl Recording {
    /// An empty recording.
    #[must_use]
    pub const fn new(about: About, rate: Rate) -> Self {
        Self {
            about,
            rate,
            channels: Vec::new(),
            moves: Vec::new(),
            events: Vec::new(),
            signals: Vec::new(),
            calls: Vec::new(),
            limit_reversals: Vec::new(),
            log: Vec::new(),
            coupling: None,
        }
    }

    /// Values of the channel `name`, by either of its names, as in [`find`](Self::find). [`release`](Self::release) frees memory that was
    /// taken to read others.
    #[must_use]
    pub fn channel(&self, name: impl AsRef<str>) -> Option<&[f64]> {
        self.release();
        self.find(name).map(|channel| &*channel.values)
    }

    /// Channel called `name`, by its name within the axis, `load.position`, or among the channels of all axes, `x.load.position`. `None` if
    /// several axes have a channel of that name.
    #[must_use]
    pub fn find(&self, name: impl AsRef<str>) -> Option<&Channel> {
        let name = name.as_ref();
        let mut within = self.channels.iter().filter(|channel| channel.spec.name == name);
        let Some(first) = within.next() else {
            let below = |axis: AxisName| axis.strip(name);
            return self.channels.iter().find(|Channel { spec, .. }| spec.axis.and_then(below) == Some(&spec.name));
        };
        within.all(|other| other.spec.axis == first.spec.axis).then_some(first)
    }

    /// Name of the recorded axis; `None` if it has none, or if there are several axes.
    #[must_use]
    pub fn axis(&self) -> Option<AxisName> {
        let mut axes = self.channels.iter().map(|channel| channel.spec.axis);
        let first = axes.next()??;
        axes.all(|axis| axis == Some(first)).then_some(first)
    }

    /// Title of the run, in words: `slide on exact with setpoint.jerk=200 m/s3`; of an axis with a name `slide (axis x) on exact`.
    #[must_use]
    pub fn title(&self) -> String {
        let About { scenario, engine, .. } = &self.about;
        format!("{}{} on {engine}{}", scenario, of_axis(self.axis()), self.about.overridden())
    }

    /// Frees memory that was taken to read channels which are in files, [`Values::release`].
    pub fn release(&self) {
        for channel in &self.channels {
            channel.values.release();
        }
    }

    /// The signal `name` of `source`.
    #[must_use]
    pub fn signal(&self, source: &str, name: &str) -> Option<&Signal> {
        self.signals.iter().find(|signal| signal.source == source && signal.name == name)
    }

    /// Number of recorded instants.
    #[must_use]
    pub fn len(&self) -> usize {
        self.channels.first().map_or(0, |channel| channel.values.len())
    }

    /// True if nothing was recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Time of the recorded instant `index` (s).
    #[must_use]
    pub fn time_of(&self, index: usize) -> f64 {
        self.rate.time(Tick(index as u64))
    }

    /// Index of the first instant at or after `time` (s), at most [`Recording::len`].
    #[must_use]
    pub fn index_at(&self, time: f64) -> usize {
        usize::try_from(self.rate.tick_at(time).0).unwrap_or(usize::MAX).min(self.len())
    }
}
