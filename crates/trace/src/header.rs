//! What a recording file says of itself: the file's key-value metadata.
//!
//! | key | value |
//! |---|---|
//! | `servobench.format` | version of this layout, [`FORMAT`] |
//! | `servobench.recording` | JSON: all of a [`Recording`] but the values |
//! | `ARROW:schema` | unit, writer and rate of each column for readers of Apache Arrow, see [`arrow`](crate::arrow) |
//! | `servobench.seal` | digest of the whole file, see [`seal`](crate::seal) |
use crate::channel::{Channel, ChannelSpec};
use crate::log::LogEntry;
use crate::recording::{About, Call, CallFate, Ending, Event, LimitReversals, Move, Recording, Signal};
use serde::{Deserialize, Serialize};
use servobench_base::{Rate, Severity};

/// Version of the layout.
pub(crate) const FORMAT: &str = "3";
/// The version before, which is read too: it has neither calls, nor how moves end.
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
    /// Rate of the recorded instants (Hz).
    rate: u32,
    /// Number of recorded instants.
    pub(crate) instants: usize,
    channels: Vec<ChannelHeader>,
    moves: Vec<MoveHeader>,
    events: Vec<EventHeader>,
    signals: Vec<SignalHeader>,
    /// Left out where no function block is called.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    calls: Vec<CallHeader>,
    /// Left out where no quantity went from limit to limit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    limit_reversals: Vec<LimitReversalsHeader>,
    /// Left out where nothing was said.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    log: Vec<LogHeader>,
}

/// A channel without its values.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ChannelHeader {
    name: String,
    unit: String,
    writer: String,
    /// How often the writer renews it (Hz).
    rate: u32,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MoveHeader {
    label: String,
    start: Number,
    end: Number,
    from: Number,
    to: Number,
    peaks: [Number; 4],
    limits: [Option<Number>; 4],
    cruise: (Number, Number),
    /// Left out where the axis is to arrive.
    #[serde(default, skip_serializing_if = "EndingWord::is_at_rest")]
    ending: EndingWord,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum EndingWord {
    #[default]
    AtRest,
    Aborted,
    InMotion,
}

impl EndingWord {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks by reference")]
    fn is_at_rest(&self) -> bool {
        *self == Self::AtRest
    }
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CallHeader {
    name: String,
    block: String,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    optional: bool,
    fate: CallFateHeader,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum CallFateHeader {
    NeverExecuted(String),
    Executed,
    Unfinished(String),
    Failed { time: Number, id: u32, message: String },
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitReversalsHeader {
    limit: String,
    times: Vec<Number>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EventHeader {
    start: Number,
    end: Number,
    source: String,
    message: String,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SignalHeader {
    source: String,
    name: String,
    changes: Vec<(Number, String)>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LogHeader {
    source: String,
    severity: SeverityWord,
    start: Number,
    end: Number,
    times: u64,
    text: String,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum SeverityWord {
    Info,
    Warning,
    Error,
}

/// A number in JSON, which has no word for infinity: `"inf"`, `"-inf"` and `"NaN"` are written as text.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged)]
enum Number {
    Finite(f64),
    Other(NotFinite),
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
enum NotFinite {
    #[serde(rename = "inf")]
    Infinity,
    #[serde(rename = "-inf")]
    NegativeInfinity,
    NaN,
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        match value {
            f64::INFINITY => Self::Other(NotFinite::Infinity),
            f64::NEG_INFINITY => Self::Other(NotFinite::NegativeInfinity),
            _ if value.is_nan() => Self::Other(NotFinite::NaN),
            _ => Self::Finite(value),
        }
    }
}

impl From<Number> for f64 {
    fn from(number: Number) -> Self {
        match number {
            Number::Finite(value) => value,
            Number::Other(NotFinite::Infinity) => f64::INFINITY,
            Number::Other(NotFinite::NegativeInfinity) => f64::NEG_INFINITY,
            Number::Other(NotFinite::NaN) => f64::NAN,
        }
    }
}

impl From<&Move> for MoveHeader {
    fn from(made: &Move) -> Self {
        Self {
            label: made.label.clone(),
            start: made.start.into(),
            end: made.end.into(),
            from: made.from.into(),
            to: made.to.into(),
            peaks: made.peaks.map(Number::from),
            limits: made.limits.map(|limit| limit.map(Number::from)),
            cruise: (made.cruise.0.into(), made.cruise.1.into()),
            ending: made.ending.into(),
        }
    }
}

impl From<MoveHeader> for Move {
    fn from(made: MoveHeader) -> Self {
        Self {
            label: made.label,
            start: made.start.into(),
            end: made.end.into(),
            from: made.from.into(),
            to: made.to.into(),
            peaks: made.peaks.map(f64::from),
            limits: made.limits.map(|limit| limit.map(f64::from)),
            cruise: (made.cruise.0.into(), made.cruise.1.into()),
            ending: made.ending.into(),
        }
    }
}

impl From<Ending> for EndingWord {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::AtRest => Self::AtRest,
            Ending::Aborted => Self::Aborted,
            Ending::InMotion => Self::InMotion,
        }
    }
}

impl From<EndingWord> for Ending {
    fn from(word: EndingWord) -> Self {
        match word {
            EndingWord::AtRest => Self::AtRest,
            EndingWord::Aborted => Self::Aborted,
            EndingWord::InMotion => Self::InMotion,
        }
    }
}

impl From<&Call> for CallHeader {
    fn from(call: &Call) -> Self {
        let fate = match call.fate.clone() {
            CallFate::NeverExecuted(why) => CallFateHeader::NeverExecuted(why),
            CallFate::Executed => CallFateHeader::Executed,
            CallFate::Unfinished(output) => CallFateHeader::Unfinished(output),
            CallFate::Failed { time, id, message } => CallFateHeader::Failed { time: time.into(), id, message },
        };
        Self { name: call.name.clone(), block: call.block.clone(), optional: call.is_optional, fate }
    }
}

impl From<CallHeader> for Call {
    fn from(CallHeader { name, block, optional, fate }: CallHeader) -> Self {
        let fate = match fate {
            CallFateHeader::NeverExecuted(why) => CallFate::NeverExecuted(why),
            CallFateHeader::Executed => CallFate::Executed,
            CallFateHeader::Unfinished(output) => CallFate::Unfinished(output),
            CallFateHeader::Failed { time, id, message } => CallFate::Failed { time: time.into(), id, message },
        };
        Self { name, block, is_optional: optional, fate }
    }
}

impl From<&LimitReversals> for LimitReversalsHeader {
    fn from(reversals: &LimitReversals) -> Self {
        Self { limit: reversals.limit.clone(), times: reversals.times.iter().copied().map(Number::from).collect() }
    }
}

impl From<LimitReversalsHeader> for LimitReversals {
    fn from(header: LimitReversalsHeader) -> Self {
        Self { limit: header.limit, times: header.times.into_iter().map(f64::from).collect() }
    }
}

impl From<&Event> for EventHeader {
    fn from(event: &Event) -> Self {
        Self {
            start: event.start.into(),
            end: event.end.into(),
            source: event.source.clone(),
            message: event.message.clone(),
        }
    }
}

impl From<EventHeader> for Event {
    fn from(event: EventHeader) -> Self {
        Self { start: event.start.into(), end: event.end.into(), source: event.source, message: event.message }
    }
}

impl From<&Signal> for SignalHeader {
    fn from(signal: &Signal) -> Self {
        let changes = signal.changes.iter().map(|(time, value)| ((*time).into(), value.clone())).collect();
        Self { source: signal.source.clone(), name: signal.name.clone(), changes }
    }
}

impl From<SignalHeader> for Signal {
    fn from(signal: SignalHeader) -> Self {
        let changes = signal.changes.into_iter().map(|(time, value)| (time.into(), value)).collect();
        Self { source: signal.source, name: signal.name, changes }
    }
}

impl From<Severity> for SeverityWord {
    fn from(severity: Severity) -> Self {
        match severity {
            Severity::Info => Self::Info,
            Severity::Warning => Self::Warning,
            Severity::Error => Self::Error,
        }
    }
}

impl From<SeverityWord> for Severity {
    fn from(word: SeverityWord) -> Self {
        match word {
            SeverityWord::Info => Self::Info,
            SeverityWord::Warning => Self::Warning,
            SeverityWord::Error => Self::Error,
        }
    }
}

impl From<&LogEntry> for LogHeader {
    fn from(entry: &LogEntry) -> Self {
        let LogEntry { source, severity, start, end, times, text } = entry.clone();
        Self { source, severity: severity.into(), start: start.into(), end: end.into(), times, text }
    }
}

impl From<LogHeader> for LogEntry {
    fn from(header: LogHeader) -> Self {
        let LogHeader { source, severity, start, end, times, text } = header;
        Self { source, severity: severity.into(), start: start.into(), end: end.into(), times, text }
    }
}

impl Header {
    /// Header of `recording`.
    pub(crate) fn of(recording: &Recording) -> Self {
        let About { scenario, engine, axis_unit, bodies } = recording.about.clone();
        let channels = recording.channels.iter().map(|channel| ChannelHeader {
            name: channel.spec.name.clone(),
            unit: channel.spec.unit.clone(),
            writer: channel.spec.writer.clone(),
            rate: channel.spec.rate.hertz(),
        });
        Self {
            scenario,
            engine,
            axis_unit,
            bodies,
            rate: recording.rate.hertz(),
            instants: recording.len(),
            channels: channels.collect(),
            moves: recording.moves.iter().map(MoveHeader::from).collect(),
            events: recording.events.iter().map(EventHeader::from).collect(),
            signals: recording.signals.iter().map(SignalHeader::from).collect(),
            calls: recording.calls.iter().map(CallHeader::from).collect(),
            limit_reversals: recording.limit_reversals.iter().map(LimitReversalsHeader::from).collect(),
            log: recording.log.iter().map(LogHeader::from).collect(),
        }
    }

    /// Names of the channels, in order.
    pub(crate) fn columns(&self) -> impl Iterator<Item = &str> {
        self.channels.iter().map(|channel| channel.name.as_str())
    }

    /// The recording without its values; `None` when a rate is zero.
    pub(crate) fn into_recording(self) -> Option<Recording> {
        let channels = self.channels.into_iter().map(|ChannelHeader { name, unit, writer, rate }| {
            let spec = ChannelSpec { name, unit, writer, rate: Rate::new(rate)? };
            Some(Channel { spec, values: Vec::new() })
        });
        Some(Recording {
            rate: Rate::new(self.rate)?,
            channels: channels.collect::<Option<_>>()?,
            moves: self.moves.into_iter().map(Move::from).collect(),
            events: self.events.into_iter().map(Event::from).collect(),
            signals: self.signals.into_iter().map(Signal::from).collect(),
            calls: self.calls.into_iter().map(Call::from).collect(),
            limit_reversals: self.limit_reversals.into_iter().map(LimitReversals::from).collect(),
            log: self.log.into_iter().map(LogEntry::from).collect(),
            about: About {
                scenario: self.scenario,
                engine: self.engine,
                axis_unit: self.axis_unit,
                bodies: self.bodies,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn through_json(value: f64) -> f64 {
        let text = serde_json::to_string(&Number::from(value)).unwrap();
        f64::from(serde_json::from_str::<Number>(&text).unwrap())
    }

    #[test]
    fn special_numbers_survive_json() {
        for value in [f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX] {
            assert_eq!(through_json(value).to_bits(), value.to_bits(), "{value}");
        }
        assert!(through_json(f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn every_finite_number_survives_json_to_the_bit(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(!value.is_nan());
            prop_assert_eq!(through_json(value).to_bits(), bits);
        }
    }
}
