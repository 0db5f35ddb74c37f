//! Encoding of points for sending, and their decoding like a drive.
use super::points::{PointEncoding, PointTransfer};
use alloc::vec::Vec;
use servobench_cia402::InterpolationData;
use servobench_cia402::interpolated::serial::{Message, Record};
use servobench_cia402::interpolated::{Point, SegmentCommand};
use servobench_motion::pvt::Knot;

/// An encoded point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SentPoint {
    /// The eight bytes of the move segment command (2010h).
    MoveSegment([u8; 8]),
    /// The interpolation data record (60C1h).
    DataRecord(InterpolationData),
    /// A write of the serial interface (115h).
    Serial(Message),
}

impl PointEncoding {
    /// Encodes `point`, which gets the drive's `number`; `None` for one that cannot be sent so, which [`points`](super::points) would have
    /// refused.
    #[must_use]
    pub fn sent(self, point: Point, number: u16) -> Option<SentPoint> {
        match self.transfer() {
            PointTransfer::MoveSegment => {
                let counter = number.to_le_bytes()[0] & 7;
                SegmentCommand::Point { counter, point }.encode().map(SentPoint::MoveSegment)
            }
            PointTransfer::DataRecord => {
                let time = point.milliseconds().filter(|_| self.constant_time().is_none());
                let data = InterpolationData { position: point.position, time, velocity: point.velocity };
                Some(SentPoint::DataRecord(data))
            }
            PointTransfer::Serial => Message::of(Record::Point(point)).map(SentPoint::Serial),
        }
    }
}

/// Points as followed by a drive that received `points` while at `from` (m or rad) and has `counts` counts in a metre or radian; times
/// count from the first point.
#[must_use]
pub fn followed(points: &[Point], from: f64, counts: f64) -> Vec<Knot> {
    let (mut position, mut microseconds) = (libm::round(from * counts), 0.0);
    points
        .iter()
        .map(|point| {
            let place = f64::from(point.position);
            position = if point.is_relative { position + place } else { place };
            let (x, v) = (position / counts, point.velocity.map(|velocity| f64::from(velocity) / (10.0 * counts)));
            let knot = Knot { t: microseconds / 1e6, x, v };
            microseconds += f64::from(point.time);
            knot
        })
        .collect()
}
