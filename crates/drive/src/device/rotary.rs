//! Rotary axes: positions of the bus within a range (607Bh), and the direction to a target of profile position (60F2h).
//!
//! The axis itself counts on without end. The position for the master (6064h) is within the range, or within the counter of the bus if
//! there is no range; of all positions that show the same value, a target of a cyclic mode is the nearest to the axis. In profile position
//! the distance is that of [`modulo`](servobench_cia402::modulo), in whole units, so that nothing drifts over any number of turns. Software
//! limits (607Dh) are positions of the unwrapped axis.
use super::Params;
use crate::modes::profile::position::Turn;
use servobench_base::ParamError;
use servobench_cia402::modulo::{Direction, PositionRange, RotaryAxisOption};

/// Wrapping of the positions on the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rotary {
    /// Position range limit (607Bh); `None` for the full range of the bus counter.
    pub range: Option<PositionRange>,
    /// Rotary axis direction option (60F2h, bits 7 and 6).
    pub direction: RotaryAxisOption,
}

impl Params {
    pub(super) fn check_rotary(&self) -> Result<(), ParamError> {
        let (lowest, highest) = (self.counter.lowest(), self.counter.highest());
        let bits = self.counter.range().trailing_zeros();
        if bits > i32::BITS && self.rotary.range.is_none() && self.rotary.direction != RotaryAxisOption::Linear {
            let bound = "at most 32 bits with a rotary axis direction (60F2h), as a range (607Bh) has";
            return Err(ParamError { name: "counter", value: bits.into(), bound });
        }
        match self.rotary.range {
            Some(range) if i128::from(range.min()) < lowest || i128::from(range.max()) > highest => {
                let bound = "within what the counter of the bus shows";
                let outer = if i128::from(range.max()) > highest { range.max() } else { range.min() };
                Err(ParamError { name: "position_range_limit", value: outer.into(), bound })
            }
            _ => Ok(()),
        }
    }

    /// Value of a position on the bus (user-defined units).
    pub(super) fn shown(&self, position: i64) -> i128 {
        match self.rotary.range {
            Some(range) => range.wrap(position).into(),
            None => self.counter.wrap(position.into()),
        }
    }

    /// Position nearest to `here` with the same value on the bus as `asked`.
    pub(super) fn nearest(&self, asked: i128, here: i64) -> i128 {
        match self.rotary.range {
            Some(range) => {
                #[expect(clippy::cast_possible_truncation, reason = "what is beyond 64 bits is not in a range of 32")]
                let way = range.way(here, asked as i64, Direction::Shortest);
                i128::from(here) + i128::from(way)
            }
            None => self.counter.nearest(asked, here.into()),
        }
    }

    /// Wrapping of absolute targets of profile position; `None` to stay within the present turn of the counter.
    pub(super) fn turn(&self) -> Option<Turn> {
        let Rotary { range, direction } = self.rotary;
        (range.is_some() || direction != RotaryAxisOption::Linear).then(|| Turn {
            range: range.unwrap_or_else(|| self.counter_range()),
            option: direction,
            unit: self.units.from_position(1),
        })
    }

    /// Range of the counter. An unsigned one of 32 bits is represented by the signed range of the same size.
    fn counter_range(&self) -> PositionRange {
        let bounds = [self.counter.lowest(), self.counter.highest()].map(i32::try_from);
        match bounds {
            [Ok(lowest), Ok(highest)] => PositionRange::new(lowest, highest).unwrap_or_default(),
            _ => PositionRange::default(),
        }
    }
}
