//! Messages between both sides.
use serde::{Deserialize, Serialize};
use servobench_fmi::{Capabilities, LogLine, SlaveError};

/// Commands to the host, numbered as exchanged.
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

    /// Name of a command for the message of a hang.
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

/// Status of the host's answer, numbered as exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Status {
    /// Done.
    Done = 1,
    /// A step has reached the time `reached`.
    Until = 2,
    /// A step has reached the time `reached`, where the FMU wants the simulation to end.
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
    Ready(Capabilities),
    /// The FMU cannot be loaded or initialised.
    Refused(String),
    /// The FMU did not do what was requested.
    Failed(SlaveError),
}

/// `line` as one line of JSON.
pub(crate) fn log_to_line(line: &LogLine) -> Option<Vec<u8>> {
    let mut bytes = serde_json::to_vec(line).ok()?;
    bytes.push(b'\n');
    Some(bytes)
}

/// The log lines in `bytes`. Lines that the FMU has overwritten are skipped.
pub(crate) fn log_of_lines(bytes: &[u8]) -> impl Iterator<Item = LogLine> {
    bytes.split(|byte| *byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_fmi::Severity;

    #[test]
    fn every_error_arrives_as_it_was_sent() {
        let (call, time) = (|| "fmi3DoStep".into(), 0.1 + 0.2);
        for error in [
            SlaveError::Discarded { call: call(), time, shortest: Some(1e-6 / 3.0) },
            SlaveError::Discarded { call: call(), time, shortest: None },
            SlaveError::Failed { call: call(), time, status: "fmi3Error".into(), message: "\"half\"\n a µm".into() },
            SlaveError::NotFinite { variable: "x[1]".into(), value: f64::NEG_INFINITY, time },
            SlaveError::Value { variable: "n".into(), bound: "integers".into(), value: 0.5, time },
            SlaveError::Unable { what: "save its state".into(), capability: "canGetAndSetFMUState".into() },
            SlaveError::Crashed { call: call(), time, how: "signal 11".into() },
            SlaveError::Astray { call: call(), from: time, to: 1.0, at: -2.0 },
            SlaveError::Hung { call: call(), time, call_timeout: 1.5 },
        ] {
            let message = Message::Failed(error);
            let sent = serde_json::to_vec(&message).unwrap();
            assert_eq!(serde_json::from_slice::<Message>(&sent).unwrap(), message);
        }
        let nan = SlaveError::NotFinite { variable: "x".into(), value: f64::NAN, time };
        let sent = serde_json::to_vec(&nan).unwrap();
        let SlaveError::NotFinite { value, .. } = serde_json::from_slice(&sent).unwrap() else {
            panic!("another error")
        };
        assert!(value.is_nan());
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
        let mut bytes = log_to_line(&line("two\nlines")).unwrap();
        bytes.extend(b"\xff\x00nonsense\n");
        bytes.extend(log_to_line(&line("last")).unwrap());
        assert_eq!(log_of_lines(&bytes).collect::<Vec<_>>(), [line("two\nlines"), line("last")]);
    }
}
