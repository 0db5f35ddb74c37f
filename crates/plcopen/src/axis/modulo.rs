//! Positions that come round again.
use crate::command::Direction;

/// Part of the period within which a position counts as reached: the difference is rounding.
const NEAR: f64 = 1e-9;

/// Target equivalent to `position` on an axis of this `period`, approached from `from`, without wrapping.
///
/// `from` is the position at which the axis can stop, so that no motion has to turn back for a target before it.
pub(crate) fn place(position: f64, period: f64, from: f64, direction: Direction, last: f64) -> f64 {
    let turns = (from - position) / period;
    let above = position + libm::ceil(turns - NEAR) * period;
    let below = position + libm::floor(turns + NEAR) * period;
    let upwards = match direction {
        Direction::Positive => true,
        Direction::Negative => false,
        Direction::Shortest => above - from <= from - below,
        Direction::Current => last >= 0.0,
    };
    if upwards { above } else { below }
}

/// `position` within one period.
pub(crate) fn within(position: f64, period: f64) -> f64 {
    let rest = position - libm::floor(position / period) * period;
    if rest >= period { 0.0 } else { rest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_that_only_rounding_keeps_from_being_reached_is_reached() {
        for from in [0.1 + 0.2, 0.3, 0.3_f64.next_down(), 5.3, -0.7] {
            for direction in [Direction::Positive, Direction::Negative, Direction::Shortest, Direction::Current] {
                let x = place(0.3, 1.0, from, direction, 1.0);
                // A few roundings of the turns.
                assert!((x - from).abs() < 1e-14, "{from} {direction:?}: {x}");
            }
        }
    }

    #[test]
    fn a_position_is_seen_within_one_period() {
        for (position, seen) in [(0.25, 0.25), (1.0, 0.0), (-0.25, 0.75), (7.5, 0.5), (-1e-20, 0.0)] {
            assert!((within(position, 1.0) - seen).abs() == 0.0, "{position}");
        }
    }
}
