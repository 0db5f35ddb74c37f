//! Tables of a master on their way into the trajectory buffer of a drive, in interpolated position.
//!
//! [`points`] puts a move into the units of the drive, as [`PointEncoding`] says; [`Stream`] sends the points, one in a cycle of
//! the motion task. [`PointEncoding::sent`] has the words of a point, and [`followed`] what a drive makes of all of them. They
//! need a heap (feature `trajectory`). How a point is written is the drive profile's
//! ([`interpolated`](servobench_cia402::interpolated)).
mod points;
mod stream;
mod words;

pub use points::{Help, PointEncoding, PointTransfer, Unsendable, points};
pub use stream::{Stream, Timing};
pub use words::{SentPoint, followed};
