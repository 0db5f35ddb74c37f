//! Rotary axes: positions of the bus within a range (607Bh), and the way to a target of profile position (60F2h).
//!
//! The axis itself counts on without end. What the master reads (6064h) is within the range, or within the counter of the bus
//! where there is none; a target of a cyclic mode is the one of all that show the same value which is nearest to the axis. In
//! profile position the way is that of [`modulo`](servobench_cia402::modulo), in whole units, so that nothing drifts however many
//! turns are made. Software limits (607Dh) are positions of the axis that counts on.
use super::Params;
use crate::modes::profile::position::Turn;
use servobench_base::ParamError;
use servobench_cia402::modulo::{Direction, PositionRange, RotaryAxisOption};

/// How positions of the bus repeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rotary {
    /// Position range limit (607Bh); `None` for all that the counter of the bus shows.
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

    /// What the bus shows of a position (user-defined units).
    pub(super) fn shown(&self, position: i64) -> i128 {
        match self.rotary.range {
            Some(range) => range.wrap(position).into(),
            None => self.counter.wrap(position.into()),
        }
    }

    /// The position nearest to `here` at which the bus shows the same as at `asked`.
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

    /// How profile position finds its way to an absolute target; `None` within the turn of the counter in which the axis is.
    pub(super) fn turn(&self) -> Option<Turn> {
        let Rotary { range, direction } = self.rotary;
        (range.is_some() || direction != RotaryAxisOption::Linear).then(|| Turn {
            range: range.unwrap_or_else(|| self.counter_range()),
            option: direction,
            unit: self.units.from_position(1),
        })
    }

    /// The positions of the counter. Those of an unsigned one of 32 bits are as many in the range of signed ones.
    fn counter_range(&self) -> PositionRange {
        let bounds = [self.counter.lowest(), self.counter.highest()].map(i32::try_from);
        match bounds {
            [Ok(lowest), Ok(highest)] => PositionRange::new(lowest, highest).unwrap_or_default(),
            _ => PositionRange::default(),
        }
    }
}
