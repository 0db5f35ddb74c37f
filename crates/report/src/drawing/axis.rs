//! Mapping from values to pixels, and the unit at an axis.
use servobench_metrics::Quantity;

/// A linear scale from values to pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Pixel of `low`.
    pub(crate) from: f64,
    /// Pixel of `high`.
    pub(crate) to: f64,
}

impl Axis {
    /// A vertical scale of `height` from `top` down, with a margin of 8 % beyond `low` and `high`, of 2 % beyond a bound of zero.
    pub(crate) fn upright((low, high): (f64, f64), top: f64, height: f64) -> Self {
        let span = match high - low {
            span if span > 0.0 => span,
            _ if high != 0.0 => high.abs(),
            _ => 1.0,
        };
        let room = |side: f64| if side == 0.0 { 0.02 } else { 0.08 } * span;
        Self { low: low - room(low), high: high + room(high), from: top + height, to: top }
    }

    /// Pixel of `value`.
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }
}

/// The range from `low` to `high`, extended to zero unless that is far away.
pub(crate) fn with_zero((low, high): (f64, f64)) -> (f64, f64) {
    let is_near = low.max(-high) <= high - low;
    if is_near { (low.min(0.0), high.max(0.0)) } else { (low, high) }
}

/// Numbers at an axis from here on are written with a power of ten in its unit.
const LONG: f64 = 1e4;

/// The unit of an axis up to `largest`, with a power of ten where no prefix makes its numbers short, and its size in plain
/// units: `×10⁶ m/s⁴` and 1e6. Only an SI unit takes a prefix.
pub(crate) fn unit_at(largest: f64, unit: &str, takes_prefix: bool) -> (String, f64) {
    let (symbol, scale) = if takes_prefix { Quantity::axis_unit(largest, unit) } else { (unit.to_owned(), 1.0) };
    let shown = largest / scale;
    if shown < LONG || !shown.is_finite() {
        return (symbol, scale);
    }
    let exponent: usize = format!("{shown:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let exponent = exponent / 3 * 3;
    let digits = exponent.to_string();
    let raised: String = digits
        .bytes()
        .map(|digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(digit - b'0')])
        .collect();
    let power: f64 = format!("1e{exponent}").parse().unwrap_or(1.0);
    (format!("×10{raised} {symbol}"), scale * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_at_an_axis_are_short() {
        assert_eq!(unit_at(7200.0, "deg/s", false), ("deg/s".to_owned(), 1.0));
        assert_eq!(unit_at(36_000.0, "deg/s", false), ("×10³ deg/s".to_owned(), 1e3));
        for (largest, unit, symbol, scale) in [
            (0.25, "m", "mm", 1e-3),
            (1000.0, "m/s⁴", "m/s⁴", 1.0),
            (9_999.0, "rad/s³", "rad/s³", 1.0),
            (50_000.0, "rad/s³", "×10³ rad/s³", 1e3),
            (1e7, "m/s⁴", "×10⁶ m/s⁴", 1e6),
            (1e16, "m/s⁴", "×10¹⁵ m/s⁴", 1e15),
        ] {
            assert_eq!(unit_at(largest, unit, true), (symbol.to_owned(), scale));
        }
    }
}
