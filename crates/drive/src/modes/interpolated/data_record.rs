//! The interpolation data record (60C1h), written sub-index by sub-index.
//!
//! The write of the highest sub-index that the sub-mode uses adds the point: its position (1), in sub-mode −2 its time (2), in
//! −3 its velocity (3).
use super::buffer::{Buffer, Refusal};
use servobench_base::Stateful;
use servobench_cia402::interpolated::{Point, SubMode, TimePeriod};
use thiserror::Error;

/// Cause of a refused write to the data record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RecordError {
    /// 60C1h has no such sub-index, or the sub-mode does not use it.
    #[error(
        "interpolation data record: sub-index {sub_index} must not be written in sub-mode {}, 1 to {} may be",
        sub_mode.code(), sub_mode.last_sub_index()
    )]
    SubIndex {
        /// Rejected sub-index.
        sub_index: u8,
        /// The sub-mode.
        sub_mode: SubMode,
    },
    /// 60C1h.2 has eight bits.
    #[error("interpolation data record: time (60C1h.2) must be 0 to 255 ms, got {value}")]
    Time {
        /// Rejected value.
        value: i32,
    },
    /// The buffer refused the point.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// The data record (60C1h), as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct DataRecord {
    position: i32,
    time_ms: u8,
}

impl DataRecord {
    /// Writes `value` to `sub_index`: 1 position (counts), 2 time (ms), 3 velocity (0.1 counts/s). The write to the last sub-index of the
    /// sub-mode adds the point to the buffer.
    ///
    /// # Errors
    /// [`RecordError`] for a sub-index that the sub-mode does not use, a time beyond its range, and a point that the buffer
    /// refuses.
    pub fn write(
        &mut self,
        sub_mode: SubMode,
        period: TimePeriod,
        buffer: &mut Buffer,
        sub_index: u8,
        value: i32,
    ) -> Result<(), RecordError> {
        if !(1..=sub_mode.last_sub_index()).contains(&sub_index) {
            return Err(RecordError::SubIndex { sub_index, sub_mode });
        }
        match sub_index {
            1 => self.position = value,
            2 => self.time_ms = u8::try_from(value).map_err(|_| RecordError::Time { value })?,
            _ => {}
        }
        if sub_index == sub_mode.last_sub_index() {
            let time =
                if sub_mode.has_constant_time() { period.microseconds() } else { u32::from(self.time_ms) * 1000 };
            let velocity = (sub_mode == SubMode::Cubic).then_some(value);
            buffer.add(Point { position: self.position, is_relative: false, velocity, time })?;
        }
        Ok(())
    }
}
