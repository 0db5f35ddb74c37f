//! The serial interface as the drive has it: parameters 115h and C8h, and the start move command.
//!
//! Trajectory mode 3 (C8h), PVT, is the one that there is. The interface has no other way to clear latched errors than to clear
//! the buffer.
use super::buffer::{Buffer, Refusal};
use servobench_base::Stateful;
use servobench_cia402::interpolated::serial::{
    Message, PVT, Record, RecordError, START_MOVE, TRAJECTORY_BUFFER, TRAJECTORY_MODE,
};
use thiserror::Error;

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
    #[error("point {record}: {error}")]
    Record {
        /// Number of the record, from 0.
        record: usize,
        /// What is wrong with it.
        error: RecordError,
    },
    /// The buffer did not take the point.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// What the interface remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Port {
    is_pvt: bool,
    /// Records that came before, by whose number a malformed one is named.
    records: usize,
}

impl Port {
    /// Does what a message says.
    ///
    /// # Errors
    /// [`SerialError`], as [`write`](Self::write) and [`command`](Self::command).
    pub fn receive(&mut self, buffer: &mut Buffer, message: &Message) -> Result<(), SerialError> {
        match message {
            Message::Write { parameter, words } => self.write(buffer, *parameter, words.word(), words.values()),
            Message::Command { op_code } => self.command(buffer, *op_code),
        }
    }

    /// Writes a parameter: its first word, and the values behind it.
    ///
    /// # Errors
    /// [`SerialError`] says which word or value, and what is allowed.
    pub fn write(&mut self, buffer: &mut Buffer, parameter: u16, word: u16, values: &[i32]) -> Result<(), SerialError> {
        match parameter {
            TRAJECTORY_MODE if word == PVT && values.is_empty() => self.is_pvt = true,
            TRAJECTORY_MODE => return Err(SerialError::Mode { word, values: values.len() }),
            TRAJECTORY_BUFFER => {
                let record = Record::decode(word, values)
                    .map_err(|error| SerialError::Record { record: self.records, error })?;
                self.records = self.records.wrapping_add(1);
                match record {
                    Record::Point(point) => buffer.add(point)?,
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
