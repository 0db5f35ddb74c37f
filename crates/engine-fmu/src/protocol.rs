//! What both sides say to each other.
use serde::{Deserialize, Serialize};
use servobench_fmi::{Capabilities, LogLine, Severity, SlaveError};
use std::collections::BTreeSet;
use std::sync::Mutex;

/// What the host is asked for. Its numbers are what is exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Command {
    /// Load the FMU and initialise it.
    Load = 1,
    /// Take a step.
    Step = 2,
    /// Read the outputs.
    Read = 3,
    /// Read the outputs that follow these inputs without a step.
    ReadFor = 4,
    /// Save the state.
    Save = 5,
    /// Go back to the saved state.
    Restore = 6,
    /// Terminate and free the FMU, then end.
    End = 7,
    /// End the initialisation.
    Start = 8,
    /// End the initialisation with these inputs.
    StartWith = 9,
}

impl Command {
    pub(crate) fn of(number: u32) -> Option<Self> {
        [
            Self::Load,
            Self::Step,
            Self::Read,
            Self::ReadFor,
            Self::Save,
            Self::Restore,
            Self::End,
            Self::Start,
            Self::StartWith,
        ]
        .into_iter()
        .find(|command| *command as u32 == number)
    }

    /// What an FMU does not come back from, in a message.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Load => "loading and initialisation",
            Self::Step => "its step",
            Self::Read | Self::ReadFor => "reading its outputs",
            Self::Save => "saving its state",
            Self::Restore => "restoring its state",
            Self::End => "its end",
            Self::Start | Self::StartWith => "its initialisation",
        }
    }
}

/// How the host answers. Its numbers are what is exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Status {
    /// As asked.
    Done = 1,
    /// A step has come to `reached`.
    Until = 2,
    /// A step has come to `reached`, where the FMU wants the simulation to end.
    Terminated = 3,
    /// See the message.
    Message = 4,
}

impl Status {
    pub(crate) fn of(number: u32) -> Option<Self> {
        [Self::Done, Self::Until, Self::Terminated, Self::Message].into_iter().find(|status| *status as u32 == number)
    }
}

/// An answer that is more than numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Message {
    /// The FMU is loaded and initialised.
    Ready { saves_state: bool, interpolates_inputs: bool, variable_step: bool },
    /// It cannot be loaded or initialised.
    Refused(String),
    /// It did not do what it was asked for.
    Failed(Failure),
}

impl Message {
    pub(crate) fn ready(can: Capabilities) -> Self {
        let Capabilities { saves_state, interpolates_inputs, variable_step } = can;
        Self::Ready { saves_state, interpolates_inputs, variable_step }
    }
}

/// A [`SlaveError`] on its way; numbers go as their bits, since JSON has no NaN.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Failure {
    Discarded { call: String, time: u64, shortest: Option<u64> },
    Failed { call: String, time: u64, status: String, message: String },
    NotFinite { variable: String, value: u64, time: u64 },
    Value { variable: String, bound: String, value: u64, time: u64 },
    Unable { what: String, capability: String },
    Astray { call: String, from: u64, to: u64, at: u64 },
    Crashed { call: String, time: u64, how: String },
    Hung { call: String, time: u64, patience: u64 },
}

impl From<SlaveError> for Failure {
    fn from(error: SlaveError) -> Self {
        match error {
            SlaveError::Discarded { call, time, shortest } => {
                Self::Discarded { call: call.into(), time: time.to_bits(), shortest: shortest.map(f64::to_bits) }
            }
            SlaveError::Failed { call, time, status, message } => {
                Self::Failed { call: call.into(), time: time.to_bits(), status: status.into(), message }
            }
            SlaveError::NotFinite { variable, value, time } => {
                Self::NotFinite { variable, value: value.to_bits(), time: time.to_bits() }
            }
            SlaveError::Value { variable, bound, value, time } => {
                Self::Value { variable, bound: bound.into(), value: value.to_bits(), time: time.to_bits() }
            }
            SlaveError::Unable { what, capability } => {
                Self::Unable { what: what.into(), capability: capability.into() }
            }
            SlaveError::Astray { call, from, to, at } => {
                Self::Astray { call: call.into(), from: from.to_bits(), to: to.to_bits(), at: at.to_bits() }
            }
            SlaveError::Crashed { call, time, how } => Self::Crashed { call: call.into(), time: time.to_bits(), how },
            SlaveError::Hung { call, time, patience } => {
                Self::Hung { call: call.into(), time: time.to_bits(), patience: patience.to_bits() }
            }
        }
    }
}

impl From<Failure> for SlaveError {
    fn from(failure: Failure) -> Self {
        let number = f64::from_bits;
        match failure {
            Failure::Discarded { call, time, shortest } => {
                Self::Discarded { call: kept(call), time: number(time), shortest: shortest.map(number) }
            }
            Failure::Failed { call, time, status, message } => {
                Self::Failed { call: kept(call), time: number(time), status: kept(status), message }
            }
            Failure::NotFinite { variable, value, time } => {
                Self::NotFinite { variable, value: number(value), time: number(time) }
            }
            Failure::Value { variable, bound, value, time } => {
                Self::Value { variable, bound: kept(bound), value: number(value), time: number(time) }
            }
            Failure::Unable { what, capability } => Self::Unable { what: kept(what), capability: kept(capability) },
            Failure::Astray { call, from, to, at } => {
                Self::Astray { call: kept(call), from: number(from), to: number(to), at: number(at) }
            }
            Failure::Crashed { call, time, how } => Self::Crashed { call: kept(call), time: number(time), how },
            Failure::Hung { call, time, patience } => {
                Self::Hung { call: kept(call), time: number(time), patience: number(patience) }
            }
        }
    }
}

/// `text` for good.
pub(crate) fn kept(text: String) -> &'static str {
    static WORDS: Mutex<Words> = Mutex::new(Words(BTreeSet::new()));
    WORDS.lock().unwrap_or_else(std::sync::PoisonError::into_inner).keep(text)
}

/// Words that are the standard's or our own on the other side, and so few that they are kept for good. An FMU that writes
/// others over them fills no memory.
struct Words(BTreeSet<&'static str>);

impl Words {
    const MOST: usize = 256;
    const LONGEST: usize = 200;

    fn keep(&mut self, text: String) -> &'static str {
        if let Some(known) = self.0.get(text.as_str()) {
            return known;
        }
        if self.0.len() == Self::MOST || text.len() > Self::LONGEST {
            return "(unreadable)";
        }
        let new = String::leak(text);
        self.0.insert(new);
        new
    }
}

/// A [`LogLine`] on its way: one line of JSON.
#[derive(Debug, Serialize, Deserialize)]
struct Said {
    /// Bits of the time (s).
    time: u64,
    severity: u8,
    category: String,
    message: String,
}

/// `line` as one line.
pub(crate) fn log_to_line(line: LogLine) -> Option<Vec<u8>> {
    let LogLine { time, severity, category, message } = line;
    let time = time.to_bits();
    let severity = match severity {
        Severity::Info => 0,
        Severity::Warning => 1,
        Severity::Error => 2,
    };
    let mut bytes = serde_json::to_vec(&Said { time, severity, category, message }).ok()?;
    bytes.push(b'\n');
    Some(bytes)
}

/// The lines in `bytes`. What is not one, because the FMU wrote over it, is left out.
pub(crate) fn log_of_lines(bytes: &[u8]) -> impl Iterator<Item = LogLine> {
    bytes.split(|byte| *byte == b'\n').filter_map(|line| {
        let Said { time, severity, category, message } = serde_json::from_slice(line).ok()?;
        let severity = match severity {
            0 => Severity::Info,
            1 => Severity::Warning,
            _ => Severity::Error,
        };
        Some(LogLine { time: f64::from_bits(time), severity, category, message })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_arrives_as_it_was_sent() {
        let (call, time) = ("fmi3DoStep", 0.1 + 0.2);
        for error in [
            SlaveError::Discarded { call, time, shortest: Some(1e-6 / 3.0) },
            SlaveError::Discarded { call, time, shortest: None },
            SlaveError::Failed { call, time, status: "fmi3Error", message: "\"half\"\n a µm".into() },
            SlaveError::NotFinite { variable: "x[1]".into(), value: f64::NEG_INFINITY, time },
            SlaveError::Value { variable: "n".into(), bound: "integers", value: 0.5, time },
            SlaveError::Unable { what: "save its state", capability: "canGetAndSetFMUState" },
            SlaveError::Crashed { call, time, how: "signal 11".into() },
            SlaveError::Astray { call, from: time, to: 1.0, at: -2.0 },
            SlaveError::Hung { call, time, patience: 1.5 },
        ] {
            let sent = serde_json::to_vec(&Message::Failed(error.clone().into())).unwrap();
            let Message::Failed(failure) = serde_json::from_slice(&sent).unwrap() else { panic!("another message") };
            assert_eq!(SlaveError::from(failure), error);
        }
        let nan = SlaveError::NotFinite { variable: "x".into(), value: f64::NAN, time };
        let SlaveError::NotFinite { value, .. } = Failure::from(nan).into() else { panic!("another error") };
        assert!(value.is_nan());
    }

    #[test]
    fn words_are_kept_once_and_not_without_end() {
        let mut words = Words(BTreeSet::new());
        assert!(std::ptr::eq(words.keep("fmi2GetReal".into()), words.keep("fmi2GetReal".into())));
        assert_eq!(words.keep("x".repeat(1000)), "(unreadable)");
        let kept = (0..1000).filter(|k| words.keep(format!("word {k}")) != "(unreadable)").count();
        assert_eq!((kept, words.keep("fmi2GetReal".into())), (255, "fmi2GetReal"));
    }

    #[test]
    fn commands_and_statuses_are_those_of_their_numbers() {
        for number in 0..16 {
            assert!(Command::of(number).is_none_or(|command| command as u32 == number));
            assert!(Status::of(number).is_none_or(|status| status as u32 == number));
        }
        assert_eq!((Command::of(9), Command::of(10)), (Some(Command::StartWith), None));
        assert_eq!((Status::of(4), Status::of(5)), (Some(Status::Message), None));
    }

    #[test]
    fn log_arrives_without_what_was_written_over() {
        let line = |message: &str| LogLine {
            time: 0.1 + 0.2,
            severity: Severity::Warning,
            category: "logEvents".into(),
            message: message.into(),
        };
        let mut bytes = log_to_line(line("two\nlines")).unwrap();
        bytes.extend(b"\xff\x00nonsense\n");
        bytes.extend(log_to_line(line("last")).unwrap());
        assert_eq!(log_of_lines(&bytes).collect::<Vec<_>>(), [line("two\nlines"), line("last")]);
    }
}
