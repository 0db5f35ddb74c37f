//! Key-value metadata of a recording file.
//!
//! | key | value |
//! |---|---|
//! | `servobench.format` | version of this layout, [`FORMAT`] |
//! | `servobench.recording` | JSON: all of a [`Recording`] except the values; a channel of an axis with a name has the axis beside its name |
//! | `ARROW:schema` | unit, writer and rate of each column for readers of Apache Arrow, see [`arrow`](crate::arrow) |
//! | `servobench.seal` | digest of the whole file, see [`seal`](crate::seal) |
use crate::channel::{Channel, ChannelSpec};
use crate::log::LogEntry;
use crate::recording::{About, Call, CouplingEstimate, Event, LimitReversals, Move, Recording, Signal};
use crate::values::Values;
use serde::{Deserialize, Serialize};
use servobench_base::Rate;
use std::borrow::Cow;

/// Version of the layout.
pub(crate) const FORMAT: &str = "3";
/// The version before, which is read too: it has neither calls, nor endings of moves.
pub(crate) const FORMER_FORMAT: &str = "2";
/// Key of the version.
pub(crate) const FORMAT_KEY: &str = "servobench.format";
/// Key of the JSON.
pub(crate) const RECORDING_KEY: &str = "servobench.recording";

/// The JSON.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Header {
    scenario: String,
    engine: String,
    axis_unit: String,
    bodies: Vec<String>,
    /// Left out if every key of the scenario has the value of its file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    overrides: Vec<String>,
    /// Rate of the recorded instants (Hz).
    rate: Rate,
    /// Number of recorded instants.
    pub(crate) instants: usize,
    channels: Vec<ChannelSpec>,
    moves: Vec<Move>,
    events: Vec<Event>,
    signals: Vec<Signal>,
    /// Left out if no function block is called.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    calls: Vec<Call>,
    /// Left out if no quantity alternated between limits.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    limit_reversals: Vec<LimitReversals>,
    /// Left out if the log is empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    log: Vec<LogEntry>,
    /// Left out if nothing is coupled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    coupling: Option<CouplingEstimate>,
}

impl Header {
    /// Header of `recording`.
    pub(crate) fn of(recording: &Recording) -> Self {
        let instants = recording.len();
        let Recording { about, rate, channels, moves, events, signals, calls, limit_reversals, log, coupling } =
            recording;
        let About { scenario, engine, axis_unit, bodies, overrides } = about.clone();
        Self {
            scenario,
            engine,
            axis_unit,
            bodies,
            overrides,
            rate: *rate,
            instants,
            channels: channels.iter().map(|channel| channel.spec.clone()).collect(),
            moves: moves.clone(),
            events: events.clone(),
            signals: signals.clone(),
            calls: calls.clone(),
            limit_reversals: limit_reversals.clone(),
            log: log.clone(),
            coupling: coupling.clone(),
        }
    }

    /// Names of the columns of the channels, in order.
    pub(crate) fn columns(&self) -> impl Iterator<Item = Cow<'_, str>> {
        self.channels.iter().map(ChannelSpec::full_name)
    }

    /// The recording without its values.
    pub(crate) fn into_recording(self) -> Recording {
        let Self { scenario, engine, axis_unit, bodies, overrides, .. } = self;
        let Self { rate, channels, moves, events, signals, calls, limit_reversals, log, coupling, .. } = self;
        let channels = channels.into_iter().map(|spec| Channel { spec, values: Values::default() }).collect();
        let about = About { scenario, engine, axis_unit, bodies, overrides };
        Recording { about, rate, channels, moves, events, signals, calls, limit_reversals, log, coupling }
    }
}
