//! Turning points of a signal, and the swings from one to the next.
//!
//! A turning point is confirmed once the signal has come back from it by more than a hysteresis. Later values of a signal do
//! not change the turning points before: a longer recording has those of a shorter one, and more.

/// Share of the largest value before below which differences of values are rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// From one turning point to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Swing {
    /// Row at which it ends.
    pub(super) end: usize,
    /// Difference between the two, a magnitude.
    pub(super) size: f64,
}

/// Finds turning points, value by value.
#[derive(Debug, Clone)]
pub(super) struct TurningPoints {
    low: (usize, f64),
    high: (usize, f64),
    /// True if the signal rises to the next turning point, once there was one.
    rises: Option<bool>,
}

impl TurningPoints {
    /// A search that starts from the value of `row`.
    pub(super) const fn new(row: usize, value: f64) -> Self {
        Self { low: (row, value), high: (row, value), rises: None }
    }

    /// Takes the value of `row`; returns the turning point that it confirms, row and value.
    pub(super) fn next(&mut self, row: usize, value: f64, hysteresis: f64) -> Option<(usize, f64)> {
        if value > self.high.1 {
            self.high = (row, value);
        }
        if value < self.low.1 {
            self.low = (row, value);
        }
        let (falls, climbs) = (self.high.1 - value > hysteresis, value - self.low.1 > hysteresis);
        let (turned, rises) = match self.rises {
            Some(true) | None if falls => (self.high, false),
            Some(false) | None if climbs => (self.low, true),
            _ => return None,
        };
        // The first one may be the beginning of the signal, which is not a turning point.
        let is_first = self.rises.replace(rises).is_none();
        (self.low, self.high) = ((row, value), (row, value));
        (!is_first).then_some(turned)
    }
}

/// The swings of `values`, of which the first is that of row `from`: each is larger than `floor`, than `share` of the largest one
/// before and than roundings.
pub(super) fn swings(values: &[f64], from: usize, floor: f64, share: f64) -> Vec<Swing> {
    let Some(first) = values.first() else { return Vec::new() };
    let mut points = TurningPoints::new(from, *first);
    let (mut last, mut largest, mut reach): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
    let mut all = Vec::new();
    for (row, value) in values.iter().enumerate() {
        if !value.is_finite() {
            break;
        }
        reach = reach.max(value.abs());
        let hysteresis = floor.max(share * largest).max(ROUNDING * reach);
        let Some((end, value)) = points.next(from + row, *value, hysteresis) else { continue };
        if let Some(before) = last.replace(value) {
            let size = (value - before).abs();
            largest = largest.max(size);
            all.push(Swing { end, size });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    /// Oracle: a sine of amplitude 1 turns at the odd quarters of its periods, and swings by 2.
    #[test]
    fn a_sine_swings_by_twice_its_amplitude() {
        let values: Vec<f64> = (0..1000).map(|k| (TAU * 5.0 * f64::from(k) / 1000.0).sin()).collect();
        let found = swings(&values, 0, 0.1, 0.0);
        assert_eq!(found.len(), 9, "from one of ten turning points to the next");
        for (swing, k) in found.iter().zip(1..) {
            assert_eq!(swing.end, 50 + 100 * k);
            assert!((swing.size - 2.0).abs() < 1e-3);
        }
        assert_eq!(swings(&values, 0, 2.1, 0.0), []);
    }

    /// A longer signal has the swings of a shorter one, and more.
    #[test]
    fn what_comes_later_does_not_change_what_was() {
        let value =
            |k: usize| (0.37 * k as f64).sin() * (1.0 + (0.011 * k as f64).cos()) + (1.9 * k as f64).sin() / 9.0;
        let values: Vec<f64> = (0..3000).map(value).collect();
        let all = swings(&values, 7, 1e-3, 0.1);
        for length in [0, 1, 10, 100, 999, 2000] {
            let found = swings(&values[..length], 7, 1e-3, 0.1);
            assert!(all.starts_with(&found), "{length}");
        }
        assert!(all.len() > 200);
    }

    #[test]
    fn drift_and_ripple_are_no_swings() {
        let drift: Vec<f64> = (0..1000).map(|k| f64::from(k) / 100.0).collect();
        assert_eq!(swings(&drift, 0, 1e-9, 0.0), []);
        let ripple: Vec<f64> = drift.iter().enumerate().map(|(k, x)| (TAU * x).sin() + 0.05 * (k % 2) as f64).collect();
        let found = swings(&ripple, 0, 1e-9, 0.125);
        let large = found.iter().filter(|swing| swing.size > 1.0).count();
        // Before the first swing there is no size to which the ripple could be compared: a quarter of a period, 25 rows.
        assert!(found.len() <= large + 25, "{} of {}", large, found.len());
        assert!(swings(&[0.0, 1.0, f64::NAN, 0.0, 1.0, 0.0], 0, 0.1, 0.0).is_empty());
    }
}
