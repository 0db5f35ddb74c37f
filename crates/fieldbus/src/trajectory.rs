//! Transfer of a master's tables to the trajectory buffer of a drive, in interpolated position.
//!
//! [`points`] converts a move to the units of the drive, by a [`PointEncoding`]; [`Stream`] sends the points, one in a cycle of the motion
//! task. [`PointEncoding::sent`] encodes a point, and [`followed`] decodes all of them like a drive. They need a heap (feature
//! `trajectory`). The formats of points are defined in the drive profile ([`interpolated`](servobench_cia402::interpolated)).
mod points;
mod stream;
mod words;

pub use points::{Help, PointEncoding, PointTransfer, Unsendable, points};
pub use stream::{Stream, Timing};
pub use words::{SentPoint, followed};
