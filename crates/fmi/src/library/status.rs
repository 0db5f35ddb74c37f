//! Status values of an FMU's functions, with the same numbers in both versions.
use crate::abi::{v2, v3};
use crate::log::Log;
use crate::slave::SlaveError;

/// Outcome of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Done, perhaps with a warning.
    Done,
    /// Not done; nothing has changed.
    Discarded,
    /// The instance cannot continue.
    Failed(&'static str),
    /// No function of any instance may be called any more.
    Fatal(&'static str),
}

impl From<v2::Status> for Outcome {
    fn from(status: v2::Status) -> Self {
        let name = status.name().unwrap_or("no status of FMI 2.0");
        match status {
            v2::Status::OK | v2::Status::WARNING => Self::Done,
            v2::Status::DISCARD => Self::Discarded,
            v2::Status::FATAL => Self::Fatal(name),
            // A step that continues by itself was not requested.
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

/// Remaining use of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Health {
    /// All functions.
    Well,
    /// Freeing only.
    Broken,
    /// None.
    Dead,
}

impl Outcome {
    /// Treats the outcome as a warning, for an instance that is no longer needed.
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
        // The FMU's message on it is in the log before that.
        log.push(1, "", &format!("{call} returned {status}"));
    }

    /// Updates the instance's health and turns the outcome into a result for the caller.
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
