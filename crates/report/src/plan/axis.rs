//! From values to pixels, and the unit at an axis.
use servobench_metrics::Quantity;

/// A linear scale from values to pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Pixel of `low`.
    pub(super) from: f64,
    /// Pixel of `high`.
    pub(super) to: f64,
}

impl Axis {
    pub(super) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }
}

/// Numbers at an axis from here on are written with a power of ten at its unit.
const LONG: f64 = 1e4;

/// The unit of an axis up to `largest`, with a power of ten where no prefix makes its numbers short, and how much of the plain
/// unit it is: `×10⁶ m/s⁴` and 1e6. Only a unit of the SI takes a prefix.
pub(super) fn unit_at(largest: f64, unit: &str, takes_prefix: bool) -> (String, f64) {
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
