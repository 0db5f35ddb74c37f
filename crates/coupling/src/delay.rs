//! Age of the values that a block has from another one.
use crate::polynomial::Order;

/// Delay of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Delay {
    /// Index of the connection.
    pub connection: usize,
    /// Age of the newest value that enters a step, at the end of that step and at most (base ticks). 0: its end is known.
    pub ticks: u64,
    /// The age in communication steps.
    pub steps: u64,
    /// Extrapolation from that value to the end of the step: with `Constant` the input is late by `ticks`, with a higher order
    /// its error is of higher order, but unforeseen changes are still as late. `None` without extrapolation.
    pub extrapolated: Option<Order>,
}

/// Largest age of the newest value of a source at the end of a step of its destination (communication steps). The source is
/// stepped every `source` steps and the destination every `destination`, both at the beginning of their steps.
///
/// At a start t of the destination's step the source has just stepped at the multiple of its own step at or before t. If its
/// new values count at once (`ahead`), the newest is of the first multiple beyond t, at least the greatest common divisor g away;
/// if only values of the past count, it is of the last multiple up to t, at most `source` − g ago.
pub(crate) fn oldest(source: u32, destination: u32, ahead: bool, exchanged: bool) -> u64 {
    let (source, destination) = (u64::from(source), u64::from(destination));
    let common = greatest_common_divisor(source, destination);
    if ahead {
        // Steps of both within a period, by the distance of the source's newest value.
        destination.saturating_sub(common)
    } else if exchanged {
        destination + source - common
    } else {
        // A later block of a sequence: at a common start its new values are not there yet.
        destination
    }
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
