//! Mapping from values to pixels, linear or logarithmic, with round numbers along it.
use super::metric::Measure;
use crate::drawing::ticks;
use servobench_metrics::{round_above, round_below};

/// Values that span more decades than this are on a logarithmic scale.
const DECADES: f64 = 1.5;
/// Margin beyond the outermost values, as a fraction of the whole.
const ROOM: f64 = 0.04;
/// Values that differ by a smaller fraction of themselves are the same.
const SAME: f64 = 1e-9;

/// A scale from values to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
    /// Pixel of the lowest value.
    pub(super) from: f64,
    /// Pixel of the highest value.
    pub(super) to: f64,
}

/// A round value: its pixel and its label.
pub(super) type Tick = (f64, String);

/// The smallest and the largest of the finite `values`.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|value| value.is_finite()).fold(None, |range, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((value.min(low), value.max(high)))
    })
}

/// True if values in this range are easier to read on a logarithmic scale.
pub(super) fn spans_decades((low, high): (f64, f64)) -> bool {
    low > 0.0 && high.log10() - low.log10() > DECADES
}

/// True if `numbers` were chosen at about equal ratios: the ratios are more uniform than the differences.
pub(super) fn are_spaced_by_ratio(numbers: &[f64]) -> bool {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else { return false };
    if sorted.len() < 3 || *first <= 0.0 || last / first < 4.0 {
        return false;
    }
    let most_over_least = |steps: Vec<f64>| range(steps).map_or(1.0, |(least, most)| most / least);
    let distances = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let ratios = sorted.windows(2).map(|pair| pair[1].ln() - pair[0].ln()).collect();
    most_over_least(ratios) < most_over_least(distances)
}

impl Scale {
    /// A scale of the values from `low` to `high` with a margin; a scale of shares goes from none to all.
    pub(super) fn with_room((low, high): (f64, f64), is_log: bool, from: f64, to: f64) -> Self {
        let tight = Self::tight((low, high), is_log, from, to);
        let room = ROOM * (to - from);
        let (low, high) = (tight.value_at(from - room), tight.value_at(to + room));
        if low.is_finite() && high.is_finite() && low < high && (low > 0.0 || !tight.is_log) {
            Self { low, high, ..tight }
        } else {
            tight
        }
    }

    /// A scale with the ends `low` and `high`; around a single value from half to twice it (logarithmic), or 5 % to either side.
    pub(super) fn tight((low, high): (f64, f64), is_log: bool, from: f64, to: f64) -> Self {
        let largest = low.abs().max(high.abs());
        // Half of the smallest numbers is 0, which has no logarithm.
        let is_log = is_log && low > 4.0 * f64::MIN_POSITIVE;
        let is_single = high / 2.0 - low / 2.0 <= SAME * largest;
        let (low, high) = match (is_single, is_log) {
            (false, _) => (low, high),
            (true, true) => (low / 2.0, high * 2.0),
            // For the smallest numbers the margin would be zero.
            (true, false) if largest > f64::MIN_POSITIVE => (low - 0.05 * largest, high + 0.05 * largest),
            (true, false) => (-1.0, 1.0),
        };
        Self { low: low.max(-f64::MAX), high: high.min(f64::MAX), is_log, from, to }
    }

    /// Place of `value` along the scale: 0 at the low end, 1 at the high one.
    pub(super) fn part(&self, value: f64) -> f64 {
        if self.is_log {
            let (low, high) = (self.low.log10(), self.high.log10());
            return (value.log10() - low) / (high - low);
        }
        // Relative to the largest, so that no difference overflows.
        let largest = self.low.abs().max(self.high.abs());
        let (low, high) = (self.low / largest, self.high / largest);
        (value / largest - low) / (high - low)
    }

    /// Pixel of `value`.
    pub(super) fn at(&self, value: f64) -> f64 {
        self.from + self.part(value) * (self.to - self.from)
    }

    fn value_at(&self, pixel: f64) -> f64 {
        let part = (pixel - self.from) / (self.to - self.from);
        if self.is_log {
            let (low, high) = (self.low.log10(), self.high.log10());
            return 10_f64.powf(low + part * (high - low));
        }
        self.low * (1.0 - part) + self.high * part
    }

    /// The unit at the scale, and about `wanted` round values.
    pub(super) fn ticks(&self, measure: &Measure, wanted: f64) -> (String, Vec<Tick>) {
        if self.is_log {
            return (measure.unit_of_log(), self.powers(measure, wanted));
        }
        let (unit, scale) = measure.axis_unit(self.low.abs().max(self.high.abs()));
        let (low, high) = (self.low / scale, self.high / scale);
        let span = high - low;
        if !(span > 0.0 && span.is_finite()) {
            return (unit, Vec::new());
        }
        let few = ticks(low, high, round_above(span / wanted));
        let ticks = if few.len() > 1 { few } else { ticks(low, high, round_below(span / wanted)) };
        (unit, ticks.into_iter().map(|(value, label)| (self.at(value * scale), label)).collect())
    }

    /// Powers of ten, only some if there are many, with fractions of them if there are few.
    fn powers(&self, measure: &Measure, wanted: f64) -> Vec<Tick> {
        let power = |exponent: f64| format!("1e{exponent:.0}").parse::<f64>().unwrap_or(1.0);
        let (low, high) = (self.low.log10(), self.high.log10());
        let (first, last) = ((low - SAME).ceil(), (high + SAME).floor());
        let count = last - first + 1.0;
        let (every, parts): (f64, &[f64]) = match count {
            count if count <= wanted / 3.0 => (1.0, &[1.0, 2.0, 5.0]),
            count if count <= wanted / 2.0 => (1.0, &[1.0, 3.0]),
            count => ((count / wanted).ceil().max(1.0), &[1.0]),
        };
        let mut ticks = Vec::new();
        // One below: parts of that power may be visible.
        let mut exponent = if every > 1.0 { (first / every).ceil() * every } else { first - 1.0 };
        while exponent <= last && ticks.len() < 60 {
            ticks.extend(parts.iter().map(|part| part * power(exponent)).filter(|value| {
                let place = value.log10();
                (low - SAME..=high + SAME).contains(&place)
            }));
            exponent += every;
        }
        ticks.into_iter().map(|value| (self.at(value), measure.round_text(value))).collect()
    }
}

/// Those of `ticks`, in order, whose labels of `size` pixels do not overlap along a line.
pub(super) fn apart(ticks: &[Tick], size: f64) -> Vec<Tick> {
    let mut end = f64::NEG_INFINITY;
    let mut kept = Vec::new();
    for (at, label) in ticks {
        let half = crate::drawing::text_width(label, size) / 2.0;
        if at - half >= end {
            end = at + half + 8.0;
            kept.push((*at, label.clone()));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_sweep::Column;

    fn measure(unit: &str) -> Measure {
        Measure::of(&Column { name: "x".into(), unit: unit.into(), values: Vec::new() })
    }

    fn labels(range: (f64, f64), is_log: bool, unit: &str) -> (String, Vec<String>) {
        let scale = Scale::with_room(range, is_log, 0.0, 100.0);
        let (unit, ticks) = scale.ticks(&measure(unit), 5.0);
        assert!(ticks.iter().all(|(at, _)| (-0.01..=100.01).contains(at)), "{ticks:?}");
        (unit, ticks.into_iter().map(|(_, label)| label).collect())
    }

    #[test]
    fn numbers_along_a_scale_are_round() {
        let of =
            |unit: &str, all: &[&str]| (unit.to_owned(), all.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>());
        assert_eq!(labels((1.2, 1.9), false, "s"), of("s", &["1.2", "1.4", "1.6", "1.8"]));
        assert_eq!(labels((1e-7, 1e-3), true, "m"), of("", &["100 nm", "1 µm", "10 µm", "100 µm", "1 mm"]));
        assert_eq!(labels((2e-6, 9e-6), true, "m"), of("", &["2 µm", "5 µm"]));
        assert_eq!(labels((-1e308, 1e308), false, "m"), of("×10³⁰⁶ m", &["-100", "-50", "0", "50", "100"]));
        let (_, many) = labels((1e-300, 1e300), true, "m");
        assert!(many.len() >= 3 && many.len() <= 7, "{many:?}");
    }

    /// A single value, zero, the smallest numbers: the scale is valid in any case.
    #[test]
    fn a_value_is_in_sight_whatever_it_is() {
        for range in
            [(0.0, 0.0), (5.0, 5.0), (-3.0, -3.0), (5e-324, 5e-324), (f64::MAX, f64::MAX), (-f64::MAX, f64::MAX)]
        {
            for is_log in [false, true] {
                let scale = Scale::with_room(range, is_log, 10.0, 20.0);
                for value in [range.0, range.1] {
                    assert!(
                        (9.999..=20.001).contains(&scale.at(value)),
                        "{range:?} {is_log}: {scale:?} {}",
                        scale.at(value)
                    );
                }
                for (at, label) in scale.ticks(&measure("m"), 5.0).1 {
                    assert!(at.is_finite() && label.chars().count() < 24, "{range:?} {is_log}: {label}");
                }
            }
        }
    }

    #[test]
    fn ratios_are_seen_in_the_values() {
        assert!(are_spaced_by_ratio(&[1.0, 10.0, 100.0]) && are_spaced_by_ratio(&[20.0, 50.0, 100.0, 200.0]));
        assert!(!are_spaced_by_ratio(&[1.0, 2.0, 3.0, 4.0]) && !are_spaced_by_ratio(&[0.0, 1.0, 10.0]));
        assert!(!are_spaced_by_ratio(&[]) && !are_spaced_by_ratio(&[1.0, 100.0]));
        assert!(spans_decades((1.0, 40.0)) && !spans_decades((1.0, 30.0)) && !spans_decades((0.0, 1.0)));
    }
}
