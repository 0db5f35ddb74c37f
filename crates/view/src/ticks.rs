//! Range of a value axis that contains numbered ticks.
//!
//! Rerun labels the multiples of one power of ten, and those only where the labels are far enough apart. An axis that ends where its curves
//! end may therefore have a single label, 0, and no scale.

/// Distance of two labels for good legibility (points).
const CLEAR: f64 = 26.0;
/// Distance below which Rerun leaves labels out (points).
const LEAST: f64 = 21.0;
/// Largest factor by which a range is widened for labels at a clear distance, where the smaller distance needs less.
const WORTH: f64 = 1.3;
/// Margin below (share of the range).
const BELOW: f64 = 0.03;
/// Margin above (share of the range): a label at the highest tick ends under the title.
const ABOVE: f64 = 0.055;
/// Largest rounding error of a tick (ticks).
const ROUNDING: f64 = 1e-9;

/// The smallest range around `low` to `high` in which, in a plot of `height` points, at least two ticks have a label.
pub(crate) fn range_with_labels(low: f64, high: f64, height: f64) -> (f64, f64) {
    let (low, high) = if high > low { (low, high) } else { (low - 1.0, low + 1.0) };
    let span = high - low;
    let fits = |distance: f64| height / distance / (1.0 + BELOW + ABOVE);
    let (clear_low, clear_high) = widened(low, high, tick(span / fits(CLEAR)));
    let (dense_low, dense_high) = widened(low, high, tick(span / fits(LEAST)));
    let is_worth_it = clear_high - clear_low <= WORTH * (dense_high - dense_low);
    let (low, high) = if is_worth_it { (clear_low, clear_high) } else { (dense_low, dense_high) };
    (low - BELOW * (high - low), high + ABOVE * (high - low))
}

/// The smallest power of ten that is at least `distance`.
fn tick(distance: f64) -> f64 {
    10_f64.powf(distance.log10().ceil())
}

/// The smallest range around `low` to `high` with two multiples of `tick`.
fn widened(low: f64, high: f64, tick: f64) -> (f64, f64) {
    let (first, last) = ((low / tick - ROUNDING).ceil(), (high / tick + ROUNDING).floor());
    if last - first >= 1.0 {
        return (low, high);
    }
    // One tick or none inside: two neighbours.
    let with = |from: f64| (low.min(from * tick), high.max((from + 1.0) * tick));
    let ranges = [first - 1.0, last - 1.0, first].map(with);
    let smallest = ranges.into_iter().min_by(|one, two| (one.1 - one.0).total_cmp(&(two.1 - two.0)));
    smallest.unwrap_or((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_axis_goes_to_a_tick_when_it_has_no_other() {
        for (low, high, height, from, to) in [
            (-5.0, 7.4, 160.0, -5.0, 10.0),
            (0.0, 408.0, 160.0, 0.0, 408.0),
            (-350.0, 408.0, 220.0, -350.0, 408.0),
            // Seven faint labels rather than two clear ones in a plot that is half empty.
            (-350.0, 350.0, 160.0, -350.0, 350.0),
            (-400.0, 408.0, 160.0, -400.0, 1000.0),
            (0.0, 9.0, 160.0, 0.0, 10.0),
            (-9.0, 0.0, 160.0, -10.0, 0.0),
            (0.0, 0.0, 160.0, -1.0, 1.0),
            (-826e-6, 826e-6, 160.0, -1e-3, 826e-6),
        ] {
            let (bottom, top) = (from - 0.03 * (to - from), to + 0.055 * (to - from));
            let (low, high) = range_with_labels(low, high, height);
            assert!((low - bottom).abs() < 1e-9 * (to - from), "{low} instead of {bottom}");
            assert!((high - top).abs() < 1e-9 * (to - from), "{high} instead of {top}");
        }
    }

    proptest! {
        /// Oracle: every power of ten, as Rerun tries them.
        #[test]
        fn two_labels_stand_apart(middle in -1e3..1e3, exponent in -6..6_i32, digit in 1.0..10.0, height in 60.0..300.0) {
            let half = digit * 10_f64.powi(exponent);
            let (low, high) = range_with_labels(middle - half, middle + half, height);
            prop_assert!(low <= middle - half && middle + half <= high);
            let labelled = (-12..12).any(|k| {
                let tick = 10_f64.powi(k);
                let ticks = (high / tick).floor() - (low / tick).ceil() + 1.0;
                ticks >= 2.0 && tick / (high - low) * height > LEAST - 1e-6
            });
            prop_assert!(labelled, "{} to {}: {} to {}", middle - half, middle + half, low, high);
            // At worst half of a curve around zero and a tick of ten distances of 21 points, with the room around it: of a
            // plot of 150 points (0.5 + 10·21·1.085/150)·1.085 = 2.19.
            let room = 1.0 + BELOW + ABOVE;
            let worst = (0.5 + 10.0 * LEAST * room / height) * room;
            prop_assert!(high - low <= 1.01 * worst * 2.0 * half, "wasted: {} to {}", low, high);
        }
    }
}
