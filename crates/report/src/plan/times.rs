//! Times of a plan in one unit and with one number of decimals.
use servobench_metrics::Quantity;

/// To the nanosecond: times of a plan are typed in elsewhere.
const DECIMALS_OF_A_SECOND: i32 = 9;

/// Format of times.
#[derive(Debug)]
pub(super) struct Times {
    unit: String,
    /// Size of the unit in seconds.
    scale: f64,
    decimals: usize,
}

impl Times {
    /// Format in the unit that suits the `longest` time (s), with the decimals that `times` (s) need.
    pub(super) fn new(longest: f64, times: impl IntoIterator<Item = f64>) -> Self {
        let (unit, scale) = Quantity::axis_unit(longest, "s");
        let exponent: i32 = format!("{scale:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
        let most = usize::try_from(DECIMALS_OF_A_SECOND + exponent).unwrap_or(0);
        let needed = |time: f64| {
            let text = format!("{:.most$}", time / scale);
            text.split_once('.').map_or(0, |(_, decimals)| decimals.trim_end_matches('0').len())
        };
        let decimals = times.into_iter().map(needed).max().unwrap_or(0);
        Self { unit, scale, decimals }
    }

    pub(super) fn show(&self, time: f64) -> String {
        let Self { unit, scale, decimals } = self;
        format!("{:.decimals$} {unit}", time / scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_of_the_longest_and_the_decimals_of_the_finest() {
        for (times, shown) in [
            (&[1.35, 0.05, 0.0][..], &["1.35 s", "0.05 s", "0.00 s"][..]),
            (&[0.058_085_583_1, 0.002, 0.000_285_714_2], &["58.085583 ms", "2.000000 ms", "0.285714 ms"]),
            (&[400e-6, 25e-6], &["400 µs", "25 µs"]),
            (&[12.0], &["12 s"]),
            (&[0.0], &["0 s"]),
        ] {
            let written = Times::new(times[0], times.iter().copied());
            assert_eq!(times.iter().map(|time| written.show(*time)).collect::<Vec<_>>(), shown);
        }
    }
}
