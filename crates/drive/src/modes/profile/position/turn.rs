//! Path to an absolute target on an axis whose positions repeat.
use servobench_cia402::modulo::{PositionRange, RotaryAxisOption};

/// Settings of the path to an absolute target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Range of the positions (607Bh), in user-defined units.
    pub range: PositionRange,
    /// Direction (60F2h).
    pub option: RotaryAxisOption,
    /// Metres or radians per user-defined unit, negative for a reversed axis.
    pub unit: f64,
}

impl Turn {
    /// Target of an axis at `from`, which counts on without end, for the position `asked` in the range (m or rad).
    ///
    /// Both are whole units, or rounded to them: the target is one of the positions shown as `asked`, bit for bit.
    pub(super) fn target(&self, from: f64, asked: f64) -> f64 {
        let [from, asked] = [from, asked].map(|position| whole(position / self.unit));
        // At most the length of the range, or for a linear path that of 32 bits.
        let way = match self.option.direction() {
            Some(direction) => self.range.way(from, asked, direction),
            None => asked - i64::from(self.range.wrap(from)),
        };
        from.saturating_add(way) as f64 * self.unit
    }
}

/// Nearest whole number, saturated at the range.
#[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
fn whole(units: f64) -> i64 {
    libm::round(units) as i64
}
