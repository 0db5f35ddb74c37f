//! The way to an absolute target on an axis whose positions repeat.
use servobench_cia402::modulo::{PositionRange, RotaryAxisOption};

/// How an absolute target is reached on such an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Positions that there are (607Bh), in user-defined units.
    pub range: PositionRange,
    /// In which direction (60F2h).
    pub option: RotaryAxisOption,
    /// Metres or radians per user-defined unit, negative where the axis is turned round.
    pub unit: f64,
}

impl Turn {
    /// Where the axis has to go from `from`, which counts on without end, to be at the position `asked` of the range (m or rad).
    ///
    /// Both are whole units, or taken as the nearest one: the target is one of those that show `asked`, bit for bit.
    pub(super) fn target(&self, from: f64, asked: f64) -> f64 {
        let [from, asked] = [from, asked].map(|position| whole(position / self.unit));
        // As long as the range is, or for a linear way as far as 32 bits go.
        let way = match self.option.direction() {
            Some(direction) => self.range.way(from, asked, direction),
            None => asked - i64::from(self.range.wrap(from)),
        };
        from.saturating_add(way) as f64 * self.unit
    }
}

/// The nearest whole number, at the ends of the range beyond it.
#[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
fn whole(units: f64) -> i64 {
    libm::round(units) as i64
}
