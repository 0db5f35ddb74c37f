//! What functions of an FMU return, in both versions by the same numbers.
use crate::abi::{v2, v3};
use crate::log::Log;
use crate::slave::SlaveError;

/// What a call returned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It was done, perhaps with a warning.
    Done,
    /// It was not done, nothing has changed.
    Discarded,
    /// The instance cannot go on.
    Failed(&'static str),
    /// Nothing may be called any more, of any instance.
    Fatal(&'static str),
}

impl From<v2::Status> for Outcome {
    fn from(status: v2::Status) -> Self {
        let name = status.name().unwrap_or("no status of FMI 2.0");
        match status {
            v2::Status::OK | v2::Status::WARNING => Self::Done,
            v2::Status::DISCARD => Self::Discarded,
            v2::Status::FATAL => Self::Fatal(name),
            // A step that goes on by itself was not asked for.
            _ => Self::Failed(name),
        }
    }
}

impl From<v3::Status> for Outcome {
    fn from(status: v3::Status) -> Self {
        let name = status.name().unwrap_or("no status of FMI 3.0");
        match status {
            v3::Status::OK | v3::Status::WARNING => Self::Done,
            v3::Status::DISCARD => Self::Discarded,
            v3::Status::FATAL => Self::Fatal(name),
            _ => Self::Failed(name),
        }
    }
}

/// How far an instance can still be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Health {
    /// For everything.
    Well,
    /// Only freed.
    Broken,
    /// Not even that.
    Dead,
}

impl Outcome {
    /// What it means for an instance that is no longer needed: a warning.
    pub(crate) fn warn(self, call: &str, health: &mut Health, log: &Log) {
        let status = match self {
            Self::Done => return,
            Self::Discarded => "discard",
            Self::Failed(status) => status,
            Self::Fatal(status) => {
                *health = Health::Dead;
                status
            }
        };
        // Its own words are in the log before that.
        log.push(1, "", &format!("{call} returned {status}"));
    }

    /// What it means for the instance and for who called.
    pub(crate) fn check(
        self,
        call: &'static str,
        time: f64,
        health: &mut Health,
        message: impl FnOnce() -> String,
    ) -> Result<(), SlaveError> {
        let status = match self {
            Self::Done => return Ok(()),
            Self::Discarded => return Err(SlaveError::Discarded { call: call.into(), time, shortest: None }),
            Self::Failed(status) => {
                *health = Health::Broken;
                status
            }
            Self::Fatal(status) => {
                *health = Health::Dead;
                status
            }
        };
        Err(SlaveError::Failed { call: call.into(), time, status: status.into(), message: message() })
    }
}
