//! Serial interface of the drive: parameters 115h and C8h, and the start move command.
//!
//! Only trajectory mode 3 (C8h), PVT, is supported. The interface can clear latched errors only by clearing the buffer.
use super::buffer::{Buffer, Refusal};
use servobench_base::Stateful;
use servobench_cia402::interpolated::serial::{
    Message, PVT, Record, RecordError, START_MOVE, TRAJECTORY_BUFFER, TRAJECTORY_MODE,
};
use thiserror::Error;

/// Cause of a refused message.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SerialError {
    /// An unsupported parameter.
    #[error("parameter {parameter:#05x} is not supported: {TRAJECTORY_MODE:#05x} and {TRAJECTORY_BUFFER:#05x} are")]
    Parameter {
        /// Rejected parameter.
        parameter: u16,
    },
    /// An unsupported command.
    #[error("op-code {op_code} is not supported: {START_MOVE}, start move, is")]
    OpCode {
        /// Rejected op-code.
        op_code: u8,
    },
    /// C8h does not take this value.
    #[error("trajectory mode (C8h) must be {PVT}, PVT, as a word without values, got {word} and {values} values")]
    Mode {
        /// Rejected word.
        word: u16,
        /// Number of values behind the word.
        values: usize,
    },
    /// A move is started before its mode is selected.
    #[error("start move (op-code {START_MOVE}): write {PVT}, PVT, to the trajectory mode (C8h) first")]
    NoMode,
    /// A malformed record was written to 115h.
    #[error("point {record}: {error}")]
    Record {
        /// Number of the record, from 0.
        record: usize,
        /// Error in the record.
        error: RecordError,
    },
    /// The buffer refused the point.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// State of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Port {
    is_pvt: bool,
    /// Number of records so far, which identifies a malformed one.
    records: usize,
}

impl Port {
    /// Executes a message.
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
    /// [`SerialError`] names the word or value, and the allowed ones.
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

    /// Executes an op-code.
    ///
    /// # Errors
    /// [`SerialError`] for an unknown op-code, and for a start before the mode is selected.
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
