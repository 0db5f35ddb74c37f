//! Points by the binary serial interface: parameters 115h and C8h, and the start move command.
//!
//! | | |
//! |---|---|
//! | write C8h | trajectory mode; 3, PVT, is the one that there is |
//! | write 115h | a word and up to two values: a point, or a command to the buffer ([`Record`]) |
//! | read 115h | free places of the buffer, and two reserved words |
//! | op-code 17 | starts the move |
//!
//! The interface has no other way to clear latched errors than to clear the buffer. Source: Copley Controls, *PVT Trajectory
//! Calculations*, rev. 00 (2020), "PVT moves via binary serial".
use super::buffer::{Buffer, Point, Refusal};
use servobench_motion::PlanError;
use servobench_motion::pvt::Record;
use thiserror::Error;

/// The trajectory buffer's parameter.
pub const TRAJECTORY_BUFFER: u16 = 0x115;
/// The trajectory mode's parameter.
pub const TRAJECTORY_MODE: u16 = 0xC8;
/// Trajectory mode PVT.
pub const PVT: u16 = 3;
/// Start move command.
pub const START_MOVE: u8 = 17;

/// Why a message was refused.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SerialError {
    /// No such parameter here.
    #[error("parameter {parameter:#05x} is not known here: {TRAJECTORY_MODE:#05x} and {TRAJECTORY_BUFFER:#05x} are")]
    Parameter {
        /// Rejected parameter.
        parameter: u16,
    },
    /// No such command here.
    #[error("op-code {op_code} is not known here: {START_MOVE}, start move, is")]
    OpCode {
        /// Rejected op-code.
        op_code: u8,
    },
    /// C8h does not take this value.
    #[error("trajectory mode (C8h) must be {PVT}, PVT, as a word without values, got {word} and {values} values")]
    Mode {
        /// Rejected word.
        word: u16,
        /// Number of values behind it.
        values: usize,
    },
    /// A move is started before its mode is selected.
    #[error("start move (op-code {START_MOVE}): write {PVT}, PVT, to the trajectory mode (C8h) first")]
    NoMode,
    /// What was written to 115h is malformed.
    #[error(transparent)]
    Record(#[from] PlanError),
    /// The buffer did not take the point.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// What the interface remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Port {
    is_pvt: bool,
    /// Records that came before, by whose number a malformed one is named.
    records: usize,
}

impl Port {
    /// Writes a parameter: its first word, and the values behind it.
    ///
    /// # Errors
    /// [`SerialError`] says which word or value, and what is allowed.
    pub fn write(&mut self, buffer: &mut Buffer, parameter: u16, word: u16, values: &[i32]) -> Result<(), SerialError> {
        match parameter {
            TRAJECTORY_MODE if word == PVT && values.is_empty() => self.is_pvt = true,
            TRAJECTORY_MODE => return Err(SerialError::Mode { word, values: values.len() }),
            TRAJECTORY_BUFFER => {
                let record = Record::decode(self.records, word, values)?;
                self.records = self.records.wrapping_add(1);
                match record {
                    Record::Point(point) => buffer.add(point.into())?,
                    Record::Clear => {
                        buffer.clear();
                        buffer.clear_errors(u8::MAX);
                    }
                    Record::Remove(number) => buffer.remove(number),
                }
            }
            _ => return Err(SerialError::Parameter { parameter }),
        }
        Ok(())
    }

    /// Reads a parameter.
    ///
    /// # Errors
    /// [`SerialError::Parameter`] for one that is not known.
    pub fn read(&self, buffer: &Buffer, parameter: u16) -> Result<[u16; 3], SerialError> {
        match parameter {
            TRAJECTORY_BUFFER => Ok([u16::try_from(buffer.free()).unwrap_or(u16::MAX), 0, 0]),
            TRAJECTORY_MODE => Ok([if self.is_pvt { PVT } else { 0 }, 0, 0]),
            _ => Err(SerialError::Parameter { parameter }),
        }
    }

    /// Does what an op-code says.
    ///
    /// # Errors
    /// [`SerialError`] for one that is not known, and for a start without the mode.
    pub fn command(&self, buffer: &mut Buffer, op_code: u8) -> Result<(), SerialError> {
        match op_code {
            START_MOVE if self.is_pvt => {
                buffer.start();
                Ok(())
            }
            START_MOVE => Err(SerialError::NoMode),
            _ => Err(SerialError::OpCode { op_code }),
        }
    }
}

impl From<servobench_motion::pvt::Point> for Point {
    fn from(point: servobench_motion::pvt::Point) -> Self {
        let servobench_motion::pvt::Point { position, velocity, time_ms, relative } = point;
        Self { position, is_relative: relative, velocity, time: u32::from(time_ms) * 1000 }
    }
}
